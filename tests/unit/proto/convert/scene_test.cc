#include "proto/convert/scene.h"

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include "core/scene/presets.h"

namespace cleave {
namespace {

using google::protobuf::TextFormat;
using google::protobuf::util::MessageDifferencer;

// Every field set, none to its default.
constexpr char kEveryField[] = R"pb(
  name: "everything"
  mesh {
    tube {
      origin: [ 1, 2, 3 ]
      outer_radius: 0.5
      inner_radius: 0.4
      height: 2
      resolution { layout: MESH_LAYOUT_JITTERED_LATTICE cell_size: 0.1 jitter: 0.3 seed: 9 }
    }
    unit_scale: 0.001
  }
  materials {
    name: "clay"
    regions: "1"
    regions: "rim"
    youngs_modulus: 2e9
    poisson_ratio: 0.2
    density: 1900
    tensile_strength: 3e6
    compressive_strength: 2e7
    fatigue {
      strength_coefficient: 5e6
      strength_exponent: -0.09
      endurance_limit: 1e6
      degradation_exponent: 2
    }
    strands { residual_factor: 0.1 stretch_limit: 1.8 }
    law: ELASTIC_LAW_COROTATED_LINEAR
    fibres {
      stiffness: 1e6
      constant { vector: [ 0, 1, 0 ] }
      strength_ratio: 2
    }
    fibres {
      stiffness: 2e6
      cylindrical {
        center: [ 1, 1, 0 ]
        axis: [ 0, 1, 0 ]
        mixture: [ 1, 2, 3 ]
      }
      strength_ratio: 1.5
    }
    fibres {
      stiffness: 3e6
      per_tet { vectors: [ 1, 0, 0, 0, 1, 0 ] }
      strength_ratio: 1.25
    }
    fibres {
      stiffness: 4e6
      curves {
        curves { points: [ 0, 0, 0, 1, 0, 0 ] }
        curves { points: [ 0, 0, 1, 0, 2, 0, 1, 1, 1 ] }
      }
      strength_ratio: 3
    }
    plasticity { yield_stress: 1e6 hardening: 2e6 flow_rate: 50 failure_strain: 0.25 }
  }
  node_sets {
    name: "grip"
    select {
      box {
        min: [ 0, 0, 0 ]
        max: [ 1, 1, 1 ]
      }
    }
    select {
      sphere {
        center: [ 1, 0, 0 ]
        radius: 2
      }
    }
    select {
      plane {
        point: [ 0, 1, 0 ]
        normal: [ 0, 0, 2 ]
      }
    }
    select { region: "rim" }
    select { ids { ids: [ 3, 5 ] } }
  }
  motions {
    node_set: "grip"
    axes: [ AXIS_X, AXIS_Z ]
    keyframes {
      time: 0.5
      translation: [ 1, 2, 3 ]
      rotation: 0.25
    }
    rotation_center: [ 4, 5, 6 ]
    rotation_axis: [ 1, 1, 0 ]
    release {
      time: 0.75
      first_fracture: true
      broken_share: 0.125
      pieces: 3
      separated_node_sets: [ "grip", "rim" ]
    }
  }
  loads {
    node_set: "grip"
    force { total: [ 1, 2, 3 ] }
    keyframes { time: 0.5 intensity: 0 }
    keyframes { time: 1 intensity: 2 }
    release { time: 4 }
  }
  loads {
    node_set: "grip"
    traction { traction: [ 0, 0, -5 ] }
  }
  loads {
    node_set: "grip"
    pressure { pressure: -7 }
  }
  initial_velocities {
    node_set: "grip"
    velocity: [ 1, 0, 0 ]
    angular_velocity: [ 0, 2, 0 ]
    center: [ 0, 0, 3 ]
  }
  gravity: [ 0, 0, -9.81 ]
  fracture {
    max_passes: 7
    simultaneity: 0.8
    stress: FRACTURE_STRESS_TOTAL
    aggregation: STRESS_AGGREGATION_MAX
    reformulation: REFORMULATION_EDGE_PROJECTED
  }
  timing { frames_per_second: 30 frame_count: 12 steps_per_frame: 3 }
  damping { mass_coefficient: 0.5 stiffness_coefficient: 0.002 }
  quality {
    newton_iterations: 4
    residual_tolerance: 1e-5
    step_tolerance: 1e-6
    linear_tolerance: 1e-2
    max_step_halvings: 2
    precision: PRECISION_FLOAT
  }
  output { tolerance: 1e-5 keyframe_interval: 5 checkpoint_interval: 4 }
  seed: 77
  contact { stiffness: 3 friction: 0.6 }
  sleep { speed: 0.002 time: 0.5 }
  render_mesh { asset: "4567" unit_scale: 0.01 }
  colliders {
    name: "floor"
    plane {
      point: [ 0, 0, -1 ]
      normal: [ 0, 1, 1 ]
    }
    friction: 0.3
    stiffness: 2
    margin: 0.01
    rotation_center: [ 1, 0, 0 ]
    rotation_axis: [ 0, 1, 0 ]
    keyframes {
      time: 1
      rotation: 2
      translation: [ 0, 0, 1 ]
    }
  }
  colliders {
    sphere {
      center: [ 0, 0, 2 ]
      radius: 0.1
    }
    body {
      density: 7850
      velocity: [ 5, 0, 0 ]
      angular_velocity: [ 0, 0, 1 ]
    }
    rotation_center: [ 1, 0, 0 ]
    rotation_axis: [ 0, 1, 0 ]
    stiffness: 3
  }
  colliders {
    box {
      center: [ 1, 2, 3 ]
      size: [ 4, 5, 6 ]
      rotation_axis: [ 1, 0, 0 ]
      rotation: 0.5
    }
    body {
      mass: 3
      velocity: [ 1, 2, 3 ]
      angular_velocity: [ 1, 0, 0 ]
    }
    rotation_center: [ 1, 0, 0 ]
    rotation_axis: [ 0, 1, 0 ]
    stiffness: 4
  }
  colliders {
    surface {
      vertices: [ 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1 ]
      triangles: [ 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3 ]
      file: "ball.obj"
    }
    rotation_center: [ 1, 0, 0 ]
    rotation_axis: [ 0, 1, 0 ]
    stiffness: 4
  }
  weakenings { node_set: "grip" factor: inf }
  weakenings {
    box {
      min: [ 0, 0, 0 ]
      max: [ 1, 2, 3 ]
    }
    factor: 0
  }
  weakenings {
    sphere {
      center: [ 1, 2, 3 ]
      radius: 4
    }
    factor: 0.5
  }
  impurities {
    effect: IMPURITY_EFFECT_UPGRADATION
    model: IMPURITY_MODEL_UNCORRELATED
    mode: IMPURITY_MODE_SAMPLED
    potency: 2
    map: [ 0, 0.5, 1 ]
    patches { node_set: "grip" share: 0.25 }
    noise: 0.5
    distribution: NOISE_DISTRIBUTION_UNIFORM
    steepness: 4
    pure_offset: 0.3
    degree_weight: 0.75
    layers {
      name: "worn"
      node_values {
        shares: [ 0, 1 ]
        file: "worn.vtu"
        array: "wear"
      }
      node_set: "grip"
      potency: 3
      weakening: inf
      blend: BLEND_ADD
      falloff: 0
      falloff_shape: FALLOFF_SHAPE_LINEAR
      seed: 7
    }
    layers {
      noise { distribution: NOISE_DISTRIBUTION_UNIFORM correlation_length: 0.25 }
      potency: 0
      blend: BLEND_MAX
      falloff_shape: FALLOFF_SHAPE_SMOOTH
    }
    layers {
      bands {
        shape: BAND_SHAPE_CYLINDERS
        center: [ 1, 2, 3 ]
        axis: [ 0, 1, 0 ]
        position: 0.5
        width: 0.125
        spacing: 0.75
      }
      weakening: 0
      blend: BLEND_REPLACE
      falloff: 0.5
      falloff_shape: FALLOFF_SHAPE_LINEAR
    }
    layers {
      pockets { count: 12 radius: 0.5 }
      blend: BLEND_MAX
      falloff_shape: FALLOFF_SHAPE_LINEAR
    }
    layers {
      strokes {
        curves { points: [ 0, 0, 0, 1, 2, 3 ] }
        curves { points: [ 4, 5, 6, 7, 8, 9 ] }
        direction: [ 0, 1, -1 ]
        depth: 0.5
        radius: 0.25
      }
      blend: BLEND_MAX
      falloff_shape: FALLOFF_SHAPE_LINEAR
    }
    layers {
      pattern {
        curves {
          points: [ 0, 1, 2, 3 ]
          half_widths: [ 4, 5 ]
        }
        image { file: "star.png" threshold: 0.25 bright: true keep_width: true tolerance: 1.5 }
        origin: [ 1, 2, 3 ]
        direction: [ 1, 0, 0 ]
        up: [ 0, 0, 1 ]
        rotation: 0.5
        scale: 2
        depth: 3
      }
      blend: BLEND_MAX
      falloff_shape: FALLOFF_SHAPE_LINEAR
    }
    layers {
      paint {
        shares: [ 0, 0.5, 1 ]
        vertices: [ 0, 0, 0, 1, 0, 0, 0, 1, 0 ]
        triangles: [ 0, 1, 2 ]
        depth: 0.5
        file: "paint.ply"
        array: "red"
        texture {
          width: 2
          height: 1
          values: "\\000\\377"
          uvs: [ 0, 0, 1, 0, 1, 1 ]
          wrap: TEXTURE_WRAP_MIRROR
          invert: true
          file: "paint.png"
          channel: TEXTURE_CHANNEL_BLUE
        }
      }
      blend: BLEND_MAX
      falloff_shape: FALLOFF_SHAPE_LINEAR
    }
  }
)pb";

TEST(Scene, KeepsEveryFieldBothWays) {
  v1::Scene message;
  ASSERT_TRUE(TextFormat::ParseFromString(kEveryField, &message));
  Faults faults;
  const Scene scene = SceneFromMessage(message, faults);
  EXPECT_TRUE(faults.ok()) << faults.ToStatus();
  std::string difference;
  MessageDifferencer differencer;
  differencer.ReportDifferencesToString(&difference);
  EXPECT_TRUE(differencer.Compare(message, MessageFromScene(scene))) << difference;
}

TEST(Scene, KeepsTheFileOfARenderMesh) {
  v1::Scene message;
  message.mutable_render_mesh()->set_file("fine.glb");
  Faults faults;
  const v1::Scene back = MessageFromScene(SceneFromMessage(message, faults));
  EXPECT_EQ(back.render_mesh().file(), "fine.glb");
  EXPECT_EQ(back.render_mesh().unit_scale(), 1);
  EXPECT_FALSE(MessageFromScene(SceneFromMessage(v1::Scene(), faults)).has_render_mesh());
}

TEST(Scene, KeepsEveryMeshSource) {
  for (const char* text : {R"pb(mesh { asset: "0123" })pb", R"pb(mesh { file: "bar.msh" })pb",
                           R"pb(mesh {
                                  box {
                                    origin: [ 0, 0, 1 ]
                                    size: [ 1, 2, 3 ]
                                    resolution { cell_size: 1 }
                                  }
                                })pb",
                           R"pb(mesh {
                                  cylinder {
                                    radius: 1
                                    height: 2
                                    resolution { cell_size: 1 }
                                  }
                                })pb",
                           R"pb(mesh {
                                  disc {
                                    radius: 1
                                    thickness: 2
                                    resolution { cell_size: 1 }
                                  }
                                })pb"}) {
    v1::Scene message;
    ASSERT_TRUE(TextFormat::ParseFromString(text, &message));
    Faults faults;
    const v1::Scene once = MessageFromScene(SceneFromMessage(message, faults));
    EXPECT_TRUE(faults.ok()) << faults.ToStatus();
    EXPECT_EQ(once.mesh().source_case(), message.mesh().source_case());
    EXPECT_TRUE(MessageDifferencer::Equals(once, MessageFromScene(SceneFromMessage(once, faults))));
  }
}

TEST(Scene, TakesFromAPresetWhatAMaterialDoesNotSay) {
  v1::Scene message;
  ASSERT_TRUE(TextFormat::ParseFromString(
      R"pb(materials { preset: "dry_wood" density: 500 }
           materials {
             name: "plank"
             preset: "dry_wood"
             poisson_ratio: 0
             law: ELASTIC_LAW_COROTATED_LINEAR
             fibres { constant { vector: [ 0, 0, 1 ] } }
             fibres {
               stiffness: 5
               constant { vector: [ 0, 1, 0 ] }
             }
           })pb",
      &message));
  Faults faults;
  const Scene scene = SceneFromMessage(message, faults);
  EXPECT_TRUE(faults.ok()) << faults.ToStatus();
  const Material wood = FindMaterialPreset("dry_wood")->material;
  const Material& beam = scene.materials[0];
  EXPECT_EQ(beam.name, "dry_wood");
  EXPECT_EQ(beam.youngs_modulus, wood.youngs_modulus);
  EXPECT_EQ(beam.density, 500);
  EXPECT_EQ(beam.tensile_strength, wood.tensile_strength);
  ASSERT_EQ(beam.fibres.size(), 1u);
  EXPECT_EQ(beam.fibres[0].stiffness, wood.fibres[0].stiffness);

  const Material& plank = scene.materials[1];
  EXPECT_EQ(plank.name, "plank");
  EXPECT_EQ(plank.poisson_ratio, 0);
  EXPECT_EQ(plank.law, ElasticLaw::kCorotatedLinear);
  ASSERT_EQ(plank.fibres.size(), 2u);
  EXPECT_EQ(plank.fibres[0].stiffness, wood.fibres[0].stiffness);
  EXPECT_EQ(plank.fibres[0].strength_ratio, wood.fibres[0].strength_ratio);
  EXPECT_EQ(std::get<ConstantDirection>(plank.fibres[0].direction).vector, (Vec3{0, 0, 1}));
  EXPECT_EQ(plank.fibres[1].stiffness, 5);

  // Resolved, the message says the same without the name of the preset.
  ResolvePresets(message, faults);
  EXPECT_TRUE(message.materials(0).preset().empty());
  EXPECT_TRUE(MessageDifferencer::Equals(MessageFromScene(scene),
                                         MessageFromScene(SceneFromMessage(message, faults))));
}

TEST(Scene, NamesThePresetsThereAreWhereOneIsNot) {
  v1::Scene message;
  message.add_materials()->set_preset("oak");
  Faults faults;
  ResolvePresets(message, faults);
  SceneFromMessage(message, faults);
  ASSERT_EQ(faults.errors().size(), 1u);
  EXPECT_EQ(faults.errors()[0].field, "materials[0].preset");
  EXPECT_THAT(faults.errors()[0].description,
              testing::HasSubstr("\"oak\" is not a preset; there are bread, cheese"));
}

TEST(Scene, TakesDefaultsForAbsentFields) {
  Faults faults;
  const Scene scene = SceneFromMessage(v1::Scene(), faults);
  EXPECT_TRUE(faults.ok());
  EXPECT_FALSE(scene.gravity.has_value());
  EXPECT_FALSE(scene.output.tolerance.has_value());
  EXPECT_EQ(scene.timing.frame_count, Timing().frame_count);
  EXPECT_EQ(scene.quality.linear_tolerance, Quality().linear_tolerance);
  EXPECT_EQ(scene.mesh.unit_scale, 1);
}

TEST(Scene, ReportsEveryVectorThatIsNotThreeNumbersAndEveryUnknownEnum) {
  v1::Scene message;
  message.add_gravity(1);
  message.mutable_mesh()->mutable_box()->mutable_resolution()->set_layout(
      static_cast<v1::MeshLayout>(42));
  message.add_node_sets()->add_select()->mutable_box()->add_min(1);
  message.add_motions()->add_axes(static_cast<v1::Axis>(9));
  message.mutable_motions(0)->add_keyframes()->add_translation(1);
  message.add_loads()->mutable_force()->add_total(1);
  message.add_loads()->mutable_traction();
  Faults faults;
  SceneFromMessage(message, faults);
  std::vector<std::string> fields;
  for (const Fault& fault : faults.errors()) fields.push_back(fault.field);
  EXPECT_THAT(fields, testing::UnorderedElementsAre(
                          "gravity", "mesh.box.size", "mesh.box.resolution.layout",
                          "node_sets[0].select[0].box.min", "node_sets[0].select[0].box.max",
                          "motions[0].axes[0]", "motions[0].keyframes[0].translation",
                          "loads[0].force.total", "loads[1].traction.traction"));
}

}  // namespace
}  // namespace cleave
