#include "tests/scenes/branch.h"

#include <numbers>
#include <utility>

#include "core/base/status.h"
#include "tests/metrics/crack_surface.h"
#include "tests/scenes/scene_parts.h"
#include "tests/scenes/shapes.h"

namespace cleave {
namespace {

constexpr BranchShape kShape;

void AddTipMotion(const std::vector<Keyframe>& bend, double grip, Demonstration& made) {
  made.pull_motion = AddMotion(made.scene, "tip", {true, true, true}, bend);
  made.pull_direction = {1, 0, 0};
  Motion& motion = made.scene.motions.back();
  motion.rotation_center = {0, 0, kShape.length - grip};
  motion.rotation_axis = {0, 1, 0};
}

void Tear(double grip, Demonstration& made) {
  constexpr double kSeconds = 0.5;
  auto bend = PullBy({0.35, 0, 0.02}, kSeconds);
  bend.back().rotation = 0.9;
  AddTipMotion(bend, grip, made);
  SetPace(made.scene, kSeconds, 50);
  made.frames_after_separation = 6;
}

// The tip is bent ever faster, so that what is torn off leaves without a jerk, and let go.
void TearOff(double grip, Demonstration& made) {
  constexpr double kBendSeconds = 2;
  constexpr int kSteps = 10;
  std::vector<Keyframe> bend;
  for (int step = 0; step <= kSteps; ++step) {
    const double time = static_cast<double>(step) / kSteps;
    const double share = time * time;
    bend.push_back({time * kBendSeconds, Vec3{0.35 * share, 0, 0}, 0.9 * share});
  }
  AddTipMotion(bend, grip, made);
  Release torn_off;
  torn_off.separated_node_sets = {"foot", "tip"};
  made.scene.motions.back().release = torn_off;
  // It is off within 1.5 s and lies half a second later.
  constexpr int64_t kFrames = 110;
  SetPace(made.scene, 2.2, kFrames);
  // A step of a whole frame would dampen what breaks the wood as it lands.
  made.scene.timing.steps_per_frame = 4;
  made.frames_after_separation = kFrames;
}

// Wood takes up water in patches: where it differs only from node to node, wood breaks into crumbs
// of single nodes, the smaller the finer the mesh.
void Soak(Impurities& water) {
  water.potency = 1;
  water.noise = 0.5;
  ImpurityLayer patches;
  patches.name = "patches";
  patches.source = NoiseField{.correlation_length = 0.015};
  patches.potency = 1;
  patches.blend = Blend::kAdd;
  water.layers.push_back(patches);
}

// A fall from its own height is to this what one from a tree is to the wood that is torn.
void Soften(Material& wood) {
  wood.youngs_modulus = 1e5;
  wood.tensile_strength = 5e3;
  for (FibreFamily& family : wood.fibres) family.stiffness = 6e6;
}

// Sawn into above its foot, it tears there whatever its weakest place is, and nearly all of it
// falls.
void SawInto(double grip, Scene& scene) {
  constexpr double kDistance = 0.01;  // m from the grip
  constexpr double kWidth = 0.04;     // m
  constexpr double kStrength = 0.3;   // times that of the wood
  const double low = grip + kDistance;
  scene.weakenings.push_back({BoxSelector{{-1, -1, low}, {1, 1, low + kWidth}}, kStrength});
}

// What has been torn off falls across the edge of a stone.
void LetFall(Scene& scene) {
  scene.gravity = {0, 0, -9.81};
  Collider stone;
  stone.name = "stone";
  stone.shape = BoxShape{{0.35, 0, 0}, {0.1, 0.4, 0.1}, {0, 1, 0}, std::numbers::pi / 4};
  stone.friction = 0.4;
  Collider ground;
  ground.name = "ground";
  ground.shape = PlaneShape{};
  ground.friction = 0.4;
  scene.colliders = {stone, ground};
  Contact contact;
  contact.friction = 0.4;
  scene.contact = contact;
}

}  // namespace

absl::StatusOr<Demonstration> MakeBranch(const Setting& setting) {
  const bool falls = setting.variant.ends_with("-fall");
  const double cell_size = (falls ? 0.018 : 0.0115) * setting.coarseness;
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh,
                          Branch(kShape, {setting.layout, cell_size, 0.2, setting.seed}));
  return MakeBranchOf(std::move(mesh), cell_size, setting);
}

Demonstration MakeBranchOf(TetMesh mesh, double cell_size, const Setting& setting, double grip) {
  const bool damp = setting.variant.starts_with("damp");
  const bool falls = setting.variant.ends_with("-fall");
  Demonstration made;
  made.mesh = std::move(mesh);
  made.cell_size = cell_size;
  made.fibres.assign(made.mesh.tets.size(), Vec3{0, 0, 1});
  made.rest_length = kShape.length - 2 * grip;

  Scene& scene = made.scene;
  scene.name = damp ? "damp branch" : "dry branch";
  scene.seed = setting.seed;
  Material material;
  material.name = "wood";
  material.youngs_modulus = 2e6;
  material.poisson_ratio = 0.3;
  material.density = 600;
  material.tensile_strength = 1e5;
  if (!setting.variant.ends_with("-iso")) {
    FibreFamily family;
    family.stiffness = 4e7;
    family.direction = ConstantDirection{{0, 0, 1}};
    family.strength_ratio = 3;
    material.fibres.push_back(family);
  }
  if (falls) Soften(material);
  scene.materials.push_back(material);
  Impurities water;
  water.noise = 0.05;
  if (damp) Soak(water);
  scene.impurities = water;

  made.grip = NodesWhere(made.mesh, [grip](const Vec3& x) { return x[2] < grip; });
  made.pulled =
      NodesWhere(made.mesh, [grip](const Vec3& x) { return x[2] > kShape.length - grip; });
  AddNodeSet(scene, "foot", made.grip);
  AddNodeSet(scene, "tip", made.pulled);
  AddMotion(scene, "foot");
  if (falls) {
    SawInto(grip, scene);
    TearOff(grip, made);
    LetFall(scene);
  } else {
    Tear(grip, made);
  }
  return made;
}

Metrics MeasureBranch(const Demonstration& demonstration, const Incidence& incidence,
                      const Run& run) {
  Metrics metrics;
  const auto crack = CrackOfPieces(demonstration.mesh, incidence, run.frames.back().broken_edges);
  double area = 0, extent = 0;
  for (const auto& fracture : CrackParts(crack, 1.5 * demonstration.cell_size)) {
    area += CrackArea(fracture);
    extent += CrackArea(fracture) * ExtentAlong(fracture, {0, 0, 1}, 0.02).length();
  }
  const double diameter = kShape.foot_radius + kShape.tip_radius;
  metrics["splinter_length"] = area > 0 ? extent / area / diameter : 0;
  return metrics;
}

std::vector<Criterion> BranchCriteria() {
  return {
      {"Damp, it gives way at less; dry, it splinters",
       {"dry", "damp"},
       {{"peak force, damp over dry", Ratio(Of("damp", "peak_force"), Of("dry", "peak_force")),
         Relation::kAtMost, 0.8},
        {"length of dry splinters, diameters", Of("dry", "splinter_length"), Relation::kAtLeast,
         0.5},
        {"length of splinters, dry beyond damp, diameters",
         Difference(Of("dry", "splinter_length"), Of("damp", "splinter_length")), Relation::kAbove,
         0}}},
      {"Without fibres it does not splinter",
       {"dry-iso"},
       {{"length of splinters, diameters", Of("dry-iso", "splinter_length"), Relation::kAtLeast,
         0.5}},
       true},
      {"Damp, what falls breaks into more pieces",
       {"dry-fall", "damp-fall"},
       {{"pieces, damp over dry", Ratio(Of("damp-fall", "pieces"), Of("dry-fall", "pieces")),
         Relation::kAtLeast, 1.5}}},
      // Crumbs count: none of them has the share of the body that makes a piece.
      {"Damp, what falls crumbles",
       {"dry-fall", "damp-fall"},
       {{"pieces and crumbs, damp over dry",
         [](const Trial& trial) {
           const auto fragments = [&trial](const std::string& variant) {
             return trial.Get(variant, "pieces") + trial.Get(variant, "dust");
           };
           return fragments("damp-fall") / fragments("dry-fall");
         },
         Relation::kAtLeast, 1.5},
        {"share of the body in crumbs, damp beyond dry",
         Difference(Of("damp-fall", "dust_share"), Of("dry-fall", "dust_share")),
         Relation::kAtLeast, 0.05}}},
  };
}

}  // namespace cleave
