#include "tests/scenes/branch.h"

#include "core/base/status.h"
#include "tests/metrics/crack_surface.h"
#include "tests/scenes/scene_parts.h"
#include "tests/scenes/shapes.h"

namespace cleave {
namespace {

constexpr BranchShape kShape;
constexpr double kGrip = 0.06;  // m at each end

}  // namespace

absl::StatusOr<Demonstration> MakeBranch(const Setting& setting) {
  const bool damp = setting.variant.starts_with("damp");
  Demonstration made;
  made.cell_size = 0.0115 * setting.coarseness;
  CLEAVE_ASSIGN_OR_RETURN(made.mesh,
                          Branch(kShape, {setting.layout, made.cell_size, 0.2, setting.seed}));
  made.fibres.assign(made.mesh.tets.size(), Vec3{0, 0, 1});
  made.rest_length = kShape.length - 2 * kGrip;

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
  scene.materials.push_back(material);
  Impurities water;
  water.noise = 0.05;
  if (damp) {
    water.potency = 1;
    water.noise = 0.5;
  }
  scene.impurities = water;

  made.grip = NodesWhere(made.mesh, [](const Vec3& x) { return x[2] < kGrip; });
  made.pulled = NodesWhere(made.mesh, [](const Vec3& x) { return x[2] > kShape.length - kGrip; });
  AddNodeSet(scene, "foot", made.grip);
  AddNodeSet(scene, "tip", made.pulled);
  AddMotion(scene, "foot");
  const double seconds = 0.5;
  auto bend = PullBy({0.35, 0, 0.02}, seconds);
  bend.back().rotation = 0.9;
  made.pull_motion = AddMotion(scene, "tip", {true, true, true}, bend);
  scene.motions.back().rotation_center = {0, 0, kShape.length - kGrip};
  scene.motions.back().rotation_axis = {0, 1, 0};
  made.pull_direction = {1, 0, 0};
  SetPace(scene, seconds, 50);
  made.frames_after_separation = 6;
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
      {"Without fibres the crack goes straight across",
       {"dry", "dry-iso"},
       {{"length of splinters, over that with fibres",
         Ratio(Of("dry-iso", "splinter_length"), Of("dry", "splinter_length")), Relation::kAtLeast,
         0.7}},
       true},
      {.text = "Damp, it crumbles into more pieces",
       .variants = {"dry", "damp"},
       .conditions = {{"pieces, damp over dry", Ratio(Of("damp", "pieces"), Of("dry", "pieces")),
                       Relation::kAtLeast, 1.5}},
       .share = kHalf,
       .full_size = true},
  };
}

}  // namespace cleave
