#include <string>

#include "absl/strings/str_cat.h"
#include "proto/convert/field_reader.h"
#include "proto/convert/impurity_layer.h"
#include "proto/convert/scene.h"
#include "proto/convert/scene_parts.h"

namespace cleave {
namespace {

Impurities AllImpurities(const v1::Impurities& message, const FieldReader& read) {
  Impurities impurities;
  impurities.effect =
      read.AfterUnspecified<ImpurityEffect>("impurities.effect", message.effect(), 2);
  impurities.model = read.AfterUnspecified<ImpurityModel>("impurities.model", message.model(), 4);
  impurities.mode = read.AfterUnspecified<ImpurityMode>("impurities.mode", message.mode(), 2);
  impurities.potency = message.potency();
  impurities.map.assign(message.map().begin(), message.map().end());
  for (const v1::PotencyPatch& from : message.patches()) {
    PotencyPatch& patch = impurities.patches.emplace_back();
    patch.node_set = from.node_set();
    if (from.has_share()) patch.share = from.share();
  }
  impurities.noise = message.noise();
  impurities.distribution = read.AfterUnspecified<NoiseDistribution>("impurities.distribution",
                                                                     message.distribution(), 2);
  if (message.has_steepness()) impurities.steepness = message.steepness();
  if (message.has_pure_offset()) impurities.pure_offset = message.pure_offset();
  if (message.has_degree_weight()) impurities.degree_weight = message.degree_weight();
  for (int k = 0; k < message.layers_size(); ++k) {
    impurities.layers.push_back(LayerFromMessage(
        message.layers(k), absl::StrCat("impurities.layers[", k, "]"), read.faults()));
  }
  return impurities;
}

void ReadSettings(const v1::Scene& message, Scene& scene, Faults& faults) {
  const v1::Fracture& fracture = message.fracture();
  if (fracture.has_max_passes()) scene.fracture.max_passes = fracture.max_passes();
  if (fracture.has_simultaneity()) scene.fracture.simultaneity = fracture.simultaneity();

  switch (fracture.stress()) {
    case v1::FRACTURE_STRESS_UNSPECIFIED:
    case v1::FRACTURE_STRESS_MATRIX:
      scene.fracture.stress = FractureStress::kMatrix;
      break;
    case v1::FRACTURE_STRESS_TOTAL:
      scene.fracture.stress = FractureStress::kTotal;
      break;
    default:
      faults.Error("fracture.stress",
                   absl::StrCat(static_cast<int>(fracture.stress()), " is not a FractureStress"));
  }

  const v1::Timing& timing = message.timing();
  if (timing.has_frames_per_second()) scene.timing.frames_per_second = timing.frames_per_second();
  if (timing.has_frame_count()) scene.timing.frame_count = timing.frame_count();
  if (timing.has_steps_per_frame()) scene.timing.steps_per_frame = timing.steps_per_frame();

  const v1::Quality& quality = message.quality();
  if (quality.has_newton_iterations()) {
    scene.quality.newton_iterations = quality.newton_iterations();
  }
  if (quality.has_residual_tolerance()) {
    scene.quality.residual_tolerance = quality.residual_tolerance();
  }
  if (quality.has_step_tolerance()) scene.quality.step_tolerance = quality.step_tolerance();
  if (quality.has_linear_tolerance()) scene.quality.linear_tolerance = quality.linear_tolerance();
  if (quality.has_max_step_halvings()) {
    scene.quality.max_step_halvings = quality.max_step_halvings();
  }

  const v1::Output& output = message.output();
  if (output.has_tolerance()) scene.output.tolerance = output.tolerance();
  if (output.has_keyframe_interval()) {
    scene.output.keyframe_interval = output.keyframe_interval();
  }
  if (output.has_checkpoint_interval()) {
    scene.output.checkpoint_interval = output.checkpoint_interval();
  }
}

}  // namespace

Scene SceneFromMessage(const v1::Scene& message, Faults& faults) {
  const FieldReader read(faults);
  Scene scene;
  scene.name = message.name();
  scene.mesh = MeshSourceFromMessage(message.mesh(), read);
  for (int i = 0; i < message.materials_size(); ++i) {
    scene.materials.push_back(
        MaterialFromMessage(message.materials(i), absl::StrCat("materials[", i, "]"), faults));
  }
  for (int i = 0; i < message.node_sets_size(); ++i) {
    NodeSet& set = scene.node_sets.emplace_back();
    set.name = message.node_sets(i).name();
    for (int k = 0; k < message.node_sets(i).select_size(); ++k) {
      set.select.push_back(SelectorFromMessage(message.node_sets(i).select(k),
                                               absl::StrCat("node_sets[", i, "].select[", k, "]"),
                                               read));
    }
  }
  for (int i = 0; i < message.motions_size(); ++i) {
    scene.motions.push_back(
        MotionFromMessage(message.motions(i), absl::StrCat("motions[", i, "]"), read));
  }
  for (int i = 0; i < message.loads_size(); ++i)
    scene.loads.push_back(LoadFromMessage(message.loads(i), absl::StrCat("loads[", i, "]"), read));
  for (int i = 0; i < message.initial_velocities_size(); ++i) {
    const v1::InitialVelocity& start = message.initial_velocities(i);
    const std::string field = absl::StrCat("initial_velocities[", i, "].");
    scene.initial_velocities.push_back(
        {start.node_set(), read.Vector(field + "velocity", start.velocity(), {0, 0, 0}),
         read.Vector(field + "angular_velocity", start.angular_velocity(), {0, 0, 0}),
         read.Vector(field + "center", start.center(), {0, 0, 0})});
  }
  if (!message.gravity().empty()) {
    scene.gravity = read.Vector("gravity", message.gravity(), {0, 0, 0});
  }
  for (int i = 0; i < message.weakenings_size(); ++i) {
    scene.weakenings.push_back(
        WeakeningFromMessage(message.weakenings(i), absl::StrCat("weakenings[", i, "]"), read));
  }
  if (message.has_contact()) {
    Contact& contact = scene.contact.emplace();
    if (message.contact().has_stiffness()) contact.stiffness = message.contact().stiffness();
    contact.friction = message.contact().friction();
  }
  if (message.has_sleep()) {
    Sleep& sleep = scene.sleep.emplace();
    if (message.sleep().has_speed()) sleep.speed = message.sleep().speed();
    if (message.sleep().has_time()) sleep.time = message.sleep().time();
  }
  if (message.has_damping()) {
    scene.damping =
        Damping{message.damping().mass_coefficient(), message.damping().stiffness_coefficient()};
  }
  if (message.has_render_mesh())
    scene.render_mesh = RenderMeshSourceFromMessage(message.render_mesh());
  for (int i = 0; i < message.colliders_size(); ++i) {
    scene.colliders.push_back(
        ColliderFromMessage(message.colliders(i), absl::StrCat("colliders[", i, "]"), read));
  }
  scene.fracture.aggregation = read.AfterUnspecified<StressAggregation>(
      "fracture.aggregation", message.fracture().aggregation(), 2);
  scene.fracture.reformulation = read.AfterUnspecified<Reformulation>(
      "fracture.reformulation", message.fracture().reformulation(), 2);
  scene.quality.precision =
      read.AfterUnspecified<Precision>("quality.precision", message.quality().precision(), 2);
  if (message.has_impurities()) scene.impurities = AllImpurities(message.impurities(), read);
  ReadSettings(message, scene, faults);
  scene.seed = message.seed();
  return scene;
}

}  // namespace cleave
