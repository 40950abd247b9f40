#include <algorithm>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/scene/checker.h"
#include "core/scene/limits.h"
#include "proto/convert/impurity_layer.h"
#include "proto/convert/scene.h"

namespace cleave {
namespace {

using Numbers = google::protobuf::RepeatedField<double>;

// Converts one message after another, remembering what was wrong.
class Converter {
 public:
  explicit Converter(Faults& faults) : faults_(faults) {}

  Vec3 Vector(const std::string& field, const Numbers& numbers, const Vec3& if_empty) {
    if (numbers.empty()) return if_empty;
    if (numbers.size() != 3) {
      faults_.Error(field, absl::StrCat("has ", numbers.size(), " numbers; three are required"));
      return if_empty;
    }
    return {numbers[0], numbers[1], numbers[2]};
  }

  Vec3 RequiredVector(const std::string& field, const Numbers& numbers, const Vec3& stand_in) {
    if (numbers.empty()) {
      faults_.Error(field, "is missing; three numbers are required");
    }
    return Vector(field, numbers, stand_in);
  }

  MeshResolution Resolution(const std::string& field, const v1::MeshResolution& message) {
    MeshResolution resolution;
    switch (message.layout()) {
      case v1::MESH_LAYOUT_UNSPECIFIED:
      case v1::MESH_LAYOUT_UNSTRUCTURED:
        resolution.layout = MeshLayout::kUnstructured;
        break;
      case v1::MESH_LAYOUT_JITTERED_LATTICE:
        resolution.layout = MeshLayout::kJitteredLattice;
        break;
      default:
        faults_.Error(field + ".layout",
                      absl::StrCat(static_cast<int>(message.layout()), " is not a MeshLayout"));
    }
    resolution.cell_size = message.cell_size();
    if (message.has_jitter()) resolution.jitter = message.jitter();
    if (message.has_seed()) resolution.seed = message.seed();
    return resolution;
  }

  MeshSource Mesh(const v1::MeshSource& message) {
    MeshSource mesh;
    if (message.has_unit_scale()) mesh.unit_scale = message.unit_scale();
    switch (message.source_case()) {
      case v1::MeshSource::kFile:
        mesh.source = MeshFile{message.file()};
        break;
      case v1::MeshSource::kAsset:
        mesh.source = MeshAsset{message.asset()};
        break;
      case v1::MeshSource::kBox: {
        BoxMesh box;
        box.origin = Vector("mesh.box.origin", message.box().origin(), box.origin);
        box.size = RequiredVector("mesh.box.size", message.box().size(), {1, 1, 1});
        box.resolution = Resolution("mesh.box.resolution", message.box().resolution());
        mesh.source = box;
        break;
      }
      case v1::MeshSource::kCylinder: {
        CylinderMesh cylinder;
        cylinder.origin = Vector("mesh.cylinder.origin", message.cylinder().origin(), {0, 0, 0});
        cylinder.radius = message.cylinder().radius();
        cylinder.height = message.cylinder().height();
        cylinder.resolution =
            Resolution("mesh.cylinder.resolution", message.cylinder().resolution());
        mesh.source = cylinder;
        break;
      }
      case v1::MeshSource::kTube: {
        TubeMesh tube;
        tube.origin = Vector("mesh.tube.origin", message.tube().origin(), {0, 0, 0});
        tube.outer_radius = message.tube().outer_radius();
        tube.inner_radius = message.tube().inner_radius();
        tube.height = message.tube().height();
        tube.resolution = Resolution("mesh.tube.resolution", message.tube().resolution());
        mesh.source = tube;
        break;
      }
      case v1::MeshSource::kDisc: {
        DiscMesh disc;
        disc.origin = Vector("mesh.disc.origin", message.disc().origin(), {0, 0, 0});
        disc.radius = message.disc().radius();
        disc.thickness = message.disc().thickness();
        disc.resolution = Resolution("mesh.disc.resolution", message.disc().resolution());
        mesh.source = disc;
        break;
      }
      case v1::MeshSource::SOURCE_NOT_SET:
        break;
    }
    return mesh;
  }

  ElasticLaw Law(const std::string& field, v1::ElasticLaw law) {
    switch (law) {
      case v1::ELASTIC_LAW_UNSPECIFIED:
      case v1::ELASTIC_LAW_STABLE_NEO_HOOKEAN:
        return ElasticLaw::kStableNeoHookean;
      case v1::ELASTIC_LAW_INVERTIBLE_NEO_HOOKEAN:
        return ElasticLaw::kInvertibleNeoHookean;
      case v1::ELASTIC_LAW_COROTATED_LINEAR:
        return ElasticLaw::kCorotatedLinear;
      case v1::ELASTIC_LAW_ST_VENANT_KIRCHHOFF:
        return ElasticLaw::kStVenantKirchhoff;
      default:
        faults_.Error(field, absl::StrCat(static_cast<int>(law), " is not an ElasticLaw"));
        return ElasticLaw::kStableNeoHookean;
    }
  }

  // Triples of numbers.
  std::vector<Vec3> Vectors(const std::string& field, const Numbers& numbers) {
    if (numbers.size() % 3 != 0) {
      faults_.Error(
          field, absl::StrCat("has ", numbers.size(), " numbers; a multiple of three is required"));
    }
    std::vector<Vec3> vectors(static_cast<size_t>(numbers.size() / 3));
    for (size_t k = 0; k < 3 * vectors.size(); ++k)
      vectors[k / 3][k % 3] = numbers[static_cast<int>(k)];
    return vectors;
  }

  FibreDirection Direction(const std::string& field, const v1::FibreFamily& message) {
    switch (message.direction_case()) {
      case v1::FibreFamily::kConstant:
        return ConstantDirection{
            RequiredVector(field + ".constant.vector", message.constant().vector(), {1, 0, 0})};
      case v1::FibreFamily::kCylindrical: {
        const v1::CylindricalDirection& from = message.cylindrical();
        CylindricalDirection cylindrical;
        const std::string frame = field + ".cylindrical.";
        cylindrical.center = Vector(frame + "center", from.center(), cylindrical.center);
        cylindrical.axis = Vector(frame + "axis", from.axis(), cylindrical.axis);
        cylindrical.mixture = Vector(frame + "mixture", from.mixture(), cylindrical.mixture);
        return cylindrical;
      }
      case v1::FibreFamily::kPerTet:
        return TetDirections{Vectors(field + ".per_tet.vectors", message.per_tet().vectors())};
      case v1::FibreFamily::kCurves: {
        CurveDirections directions;
        for (int i = 0; i < message.curves().curves_size(); ++i) {
          directions.curves.push_back(
              {Vectors(absl::StrCat(field, ".curves.curves[", i, "].points"),
                       message.curves().curves(i).points())});
        }
        return directions;
      }
      case v1::FibreFamily::DIRECTION_NOT_SET:
        break;
    }
    return std::monostate{};
  }

  Material OneMaterial(const std::string& field, v1::Material message) {
    ResolvePreset(field, message, faults_);
    Material material;
    material.name = message.name();
    material.regions.assign(message.regions().begin(), message.regions().end());
    material.law = Law(field + ".law", message.law());
    material.youngs_modulus = message.youngs_modulus();
    material.poisson_ratio = message.poisson_ratio();
    material.density = message.density();
    if (message.has_tensile_strength()) material.tensile_strength = message.tensile_strength();
    if (message.has_compressive_strength())
      material.compressive_strength = message.compressive_strength();
    for (int i = 0; i < message.fibres_size(); ++i) {
      const v1::FibreFamily& from = message.fibres(i);
      FibreFamily& family = material.fibres.emplace_back();
      family.stiffness = from.stiffness();
      family.direction = Direction(absl::StrCat(field, ".fibres[", i, "]"), from);
      if (from.has_strength_ratio()) family.strength_ratio = from.strength_ratio();
    }
    if (message.has_fatigue()) {
      const v1::Fatigue& from = message.fatigue();
      Fatigue& fatigue = material.fatigue.emplace();
      fatigue.strength_coefficient = from.strength_coefficient();
      fatigue.strength_exponent = from.strength_exponent();
      if (from.has_endurance_limit()) fatigue.endurance_limit = from.endurance_limit();
      if (from.has_degradation_exponent())
        fatigue.degradation_exponent = from.degradation_exponent();
    }
    if (message.has_plasticity()) {
      const v1::Plasticity& from = message.plasticity();
      Plasticity& plasticity = material.plasticity.emplace();
      plasticity.yield_stress = from.yield_stress();
      plasticity.hardening = from.hardening();
      if (from.has_flow_rate()) plasticity.flow_rate = from.flow_rate();
      if (from.has_failure_strain()) plasticity.failure_strain = from.failure_strain();
    }
    if (message.has_strands()) {
      material.strands =
          Strands{message.strands().residual_factor(), message.strands().stretch_limit()};
    }
    return material;
  }

  // The enum after "unspecified", which stands for its first value, where the enum has the
  // order of its message.
  template <typename Enum>
  Enum AfterUnspecified(absl::string_view field, int value, int count) {
    if (value < 0 || value > count) {
      faults_.Error(field, absl::StrCat(value, " is outside [0, ", count, "]"));
      return Enum{};
    }
    return static_cast<Enum>(std::max(value, 1) - 1);
  }

  Impurities AllImpurities(const v1::Impurities& message) {
    Impurities impurities;
    impurities.effect = AfterUnspecified<ImpurityEffect>("impurities.effect", message.effect(), 2);
    impurities.model = AfterUnspecified<ImpurityModel>("impurities.model", message.model(), 4);
    impurities.mode = AfterUnspecified<ImpurityMode>("impurities.mode", message.mode(), 2);
    impurities.potency = message.potency();
    impurities.map.assign(message.map().begin(), message.map().end());
    for (const v1::PotencyPatch& from : message.patches()) {
      PotencyPatch& patch = impurities.patches.emplace_back();
      patch.node_set = from.node_set();
      if (from.has_share()) patch.share = from.share();
    }
    impurities.noise = message.noise();
    impurities.distribution =
        AfterUnspecified<NoiseDistribution>("impurities.distribution", message.distribution(), 2);
    if (message.has_steepness()) impurities.steepness = message.steepness();
    if (message.has_pure_offset()) impurities.pure_offset = message.pure_offset();
    if (message.has_degree_weight()) impurities.degree_weight = message.degree_weight();
    for (int k = 0; k < message.layers_size(); ++k) {
      impurities.layers.push_back(
          LayerFromMessage(message.layers(k), absl::StrCat("impurities.layers[", k, "]"), faults_));
    }
    return impurities;
  }

  Weakening OneWeakening(const std::string& field, const v1::Weakening& message) {
    Weakening weakening;
    switch (message.edges_case()) {
      case v1::Weakening::kNodeSet:
        weakening.edges = EdgesOfNodes{message.node_set()};
        break;
      case v1::Weakening::kBox:
        weakening.edges =
            BoxSelector{RequiredVector(field + ".box.min", message.box().min(), {0, 0, 0}),
                        RequiredVector(field + ".box.max", message.box().max(), {0, 0, 0})};
        break;
      case v1::Weakening::kSphere:
        weakening.edges = SphereSelector{
            RequiredVector(field + ".sphere.center", message.sphere().center(), {0, 0, 0}),
            message.sphere().radius()};
        break;
      case v1::Weakening::EDGES_NOT_SET:
        break;
    }
    if (!message.has_factor()) faults_.Error(field + ".factor", "is missing");
    if (message.has_factor()) weakening.factor = message.factor();
    return weakening;
  }

  Selector OneSelector(const std::string& field, const v1::Selector& message) {
    switch (message.kind_case()) {
      case v1::Selector::kBox:
        return BoxSelector{RequiredVector(field + ".box.min", message.box().min(), {0, 0, 0}),
                           RequiredVector(field + ".box.max", message.box().max(), {0, 0, 0})};
      case v1::Selector::kSphere:
        return SphereSelector{
            RequiredVector(field + ".sphere.center", message.sphere().center(), {0, 0, 0}),
            message.sphere().radius()};
      case v1::Selector::kPlane:
        return PlaneSelector{
            RequiredVector(field + ".plane.point", message.plane().point(), {0, 0, 0}),
            RequiredVector(field + ".plane.normal", message.plane().normal(), {0, 0, 1})};
      case v1::Selector::kRegion:
        return RegionSelector{message.region()};
      case v1::Selector::kIds:
        return IdSelector{{message.ids().ids().begin(), message.ids().ids().end()}};
      case v1::Selector::KIND_NOT_SET:
        break;
    }
    return std::monostate{};
  }

  std::array<bool, 3> Axes(const std::string& field,
                           const google::protobuf::RepeatedField<int>& axes) {
    if (axes.empty()) return {true, true, true};
    std::array<bool, 3> prescribed{false, false, false};
    for (int i = 0; i < axes.size(); ++i) {
      if (axes[i] < v1::AXIS_X || axes[i] > v1::AXIS_Z) {
        faults_.Error(absl::StrCat(field, "[", i, "]"),
                      absl::StrCat(axes[i], " is not one of AXIS_X, AXIS_Y, AXIS_Z"));
        continue;
      }
      prescribed[static_cast<size_t>(axes[i] - v1::AXIS_X)] = true;
    }
    return prescribed;
  }

  Motion OneMotion(const std::string& field, const v1::Motion& message) {
    Motion motion;
    motion.node_set = message.node_set();
    motion.axes = Axes(field + ".axes", message.axes());
    motion.rotation_center =
        Vector(field + ".rotation_center", message.rotation_center(), motion.rotation_center);
    motion.rotation_axis =
        Vector(field + ".rotation_axis", message.rotation_axis(), motion.rotation_axis);
    motion.keyframes = Keyframes(field, message.keyframes());
    if (message.has_release()) motion.release = OneRelease(message.release());
    return motion;
  }

  std::vector<Keyframe> Keyframes(const std::string& field,
                                  const google::protobuf::RepeatedPtrField<v1::Keyframe>& from) {
    std::vector<Keyframe> keyframes;
    for (int i = 0; i < from.size(); ++i) {
      keyframes.push_back({from[i].time(),
                           Vector(absl::StrCat(field, ".keyframes[", i, "].translation"),
                                  from[i].translation(), {0, 0, 0}),
                           from[i].rotation()});
    }
    return keyframes;
  }

  Shape OneShape(const std::string& field, const v1::Collider& message) {
    switch (message.shape_case()) {
      case v1::Collider::kPlane:
        return PlaneShape{Vector(field + ".plane.point", message.plane().point(), {0, 0, 0}),
                          Vector(field + ".plane.normal", message.plane().normal(), {0, 0, 1})};
      case v1::Collider::kSphere:
        return SphereShape{Vector(field + ".sphere.center", message.sphere().center(), {0, 0, 0}),
                           message.sphere().radius()};
      case v1::Collider::kBox: {
        BoxShape box;
        box.center = Vector(field + ".box.center", message.box().center(), box.center);
        box.size = RequiredVector(field + ".box.size", message.box().size(), {1, 1, 1});
        box.rotation_axis =
            Vector(field + ".box.rotation_axis", message.box().rotation_axis(), box.rotation_axis);
        box.rotation = message.box().rotation();
        return box;
      }
      case v1::Collider::kSurface: {
        const v1::SurfaceShape& from = message.surface();
        SurfaceShape surface;
        surface.vertices = Vectors(field + ".surface.vertices", from.vertices());
        surface.file = from.file();
        const double unit_scale = from.has_unit_scale() ? from.unit_scale() : 1;
        Checker(faults_).Above(field + ".surface.unit_scale", unit_scale, 0, limits::kMaxUnitScale);
        for (Vec3& vertex : surface.vertices) {
          for (double& coordinate : vertex) coordinate *= unit_scale;
        }
        if (from.triangles_size() % 3 != 0) {
          faults_.Error(field + ".surface.triangles",
                        absl::StrCat("has ", from.triangles_size(),
                                     " numbers; a multiple of three is required"));
        }
        surface.triangles.resize(static_cast<size_t>(from.triangles_size() / 3));
        for (size_t k = 0; k < 3 * surface.triangles.size(); ++k)
          surface.triangles[k / 3][k % 3] = from.triangles(static_cast<int>(k));
        return surface;
      }
      case v1::Collider::SHAPE_NOT_SET:
        break;
    }
    return std::monostate{};
  }

  Collider OneCollider(const std::string& field, const v1::Collider& message) {
    Collider collider;
    collider.name = message.name();
    collider.shape = OneShape(field, message);
    collider.keyframes = Keyframes(field, message.keyframes());
    collider.rotation_center =
        Vector(field + ".rotation_center", message.rotation_center(), collider.rotation_center);
    collider.rotation_axis =
        Vector(field + ".rotation_axis", message.rotation_axis(), collider.rotation_axis);
    if (message.has_body()) {
      const v1::RigidBody& from = message.body();
      RigidBody& body = collider.body.emplace();
      if (from.has_mass()) body.mass = from.mass();
      if (from.has_density()) body.density = from.density();
      body.velocity = Vector(field + ".body.velocity", from.velocity(), body.velocity);
      body.angular_velocity =
          Vector(field + ".body.angular_velocity", from.angular_velocity(), body.angular_velocity);
    }
    collider.friction = message.friction();
    if (message.has_stiffness()) collider.stiffness = message.stiffness();
    collider.margin = message.margin();
    return collider;
  }

  Release OneRelease(const v1::Release& message) {
    Release release;
    if (message.has_time()) release.time = message.time();
    release.first_fracture = message.first_fracture();
    if (message.has_broken_share()) release.broken_share = message.broken_share();
    if (message.has_pieces()) release.pieces = message.pieces();
    release.separated_node_sets.assign(message.separated_node_sets().begin(),
                                       message.separated_node_sets().end());
    return release;
  }

  Load OneLoad(const std::string& field, const v1::Load& message) {
    Load load;
    load.node_set = message.node_set();
    switch (message.kind_case()) {
      case v1::Load::kForce:
        load.kind =
            PointForce{RequiredVector(field + ".force.total", message.force().total(), {0, 0, 0})};
        break;
      case v1::Load::kTraction:
        load.kind = SurfaceTraction{
            RequiredVector(field + ".traction.traction", message.traction().traction(), {0, 0, 0})};
        break;
      case v1::Load::kPressure:
        load.kind = SurfacePressure{message.pressure().pressure()};
        break;
      case v1::Load::KIND_NOT_SET:
        break;
    }
    for (const v1::LoadKeyframe& from : message.keyframes()) {
      LoadKeyframe& keyframe = load.keyframes.emplace_back();
      keyframe.time = from.time();
      if (from.has_intensity()) keyframe.intensity = from.intensity();
    }
    if (message.has_release()) load.release = OneRelease(message.release());
    return load;
  }

 private:
  Faults& faults_;
};

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

Material MaterialFromMessage(const v1::Material& message, const std::string& field,
                             Faults& faults) {
  return Converter(faults).OneMaterial(field, message);
}

Scene SceneFromMessage(const v1::Scene& message, Faults& faults) {
  Converter convert(faults);
  Scene scene;
  scene.name = message.name();
  scene.mesh = convert.Mesh(message.mesh());
  for (int i = 0; i < message.materials_size(); ++i) {
    scene.materials.push_back(
        convert.OneMaterial(absl::StrCat("materials[", i, "]"), message.materials(i)));
  }
  for (int i = 0; i < message.node_sets_size(); ++i) {
    NodeSet& set = scene.node_sets.emplace_back();
    set.name = message.node_sets(i).name();
    for (int k = 0; k < message.node_sets(i).select_size(); ++k) {
      set.select.push_back(convert.OneSelector(absl::StrCat("node_sets[", i, "].select[", k, "]"),
                                               message.node_sets(i).select(k)));
    }
  }
  for (int i = 0; i < message.motions_size(); ++i) {
    scene.motions.push_back(
        convert.OneMotion(absl::StrCat("motions[", i, "]"), message.motions(i)));
  }
  for (int i = 0; i < message.loads_size(); ++i)
    scene.loads.push_back(convert.OneLoad(absl::StrCat("loads[", i, "]"), message.loads(i)));
  for (int i = 0; i < message.initial_velocities_size(); ++i) {
    const v1::InitialVelocity& start = message.initial_velocities(i);
    const std::string field = absl::StrCat("initial_velocities[", i, "].");
    scene.initial_velocities.push_back(
        {start.node_set(), convert.Vector(field + "velocity", start.velocity(), {0, 0, 0}),
         convert.Vector(field + "angular_velocity", start.angular_velocity(), {0, 0, 0}),
         convert.Vector(field + "center", start.center(), {0, 0, 0})});
  }
  if (!message.gravity().empty()) {
    scene.gravity = convert.Vector("gravity", message.gravity(), {0, 0, 0});
  }
  for (int i = 0; i < message.weakenings_size(); ++i) {
    scene.weakenings.push_back(
        convert.OneWeakening(absl::StrCat("weakenings[", i, "]"), message.weakenings(i)));
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
  for (int i = 0; i < message.colliders_size(); ++i) {
    scene.colliders.push_back(
        convert.OneCollider(absl::StrCat("colliders[", i, "]"), message.colliders(i)));
  }
  scene.fracture.aggregation = convert.AfterUnspecified<StressAggregation>(
      "fracture.aggregation", message.fracture().aggregation(), 2);
  scene.fracture.reformulation = convert.AfterUnspecified<Reformulation>(
      "fracture.reformulation", message.fracture().reformulation(), 2);
  scene.quality.precision =
      convert.AfterUnspecified<Precision>("quality.precision", message.quality().precision(), 2);
  if (message.has_impurities()) scene.impurities = convert.AllImpurities(message.impurities());
  ReadSettings(message, scene, faults);
  scene.seed = message.seed();
  return scene;
}

}  // namespace cleave
