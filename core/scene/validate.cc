#include "core/scene/validate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/mesh/procedural.h"
#include "core/scene/checker.h"
#include "core/scene/collider_rules.h"
#include "core/scene/impurity_rules.h"
#include "core/scene/keyframe_rules.h"
#include "core/scene/limits.h"
#include "core/scene/load_rules.h"
#include "core/scene/material_rules.h"
#include "core/scene/render_mesh_rules.h"
#include "core/scene/selection.h"

namespace cleave {
namespace {

struct MeshSourceRules {
  Faults& faults;

  void operator()(std::monostate) const {
    faults.Error("mesh",
                 "names no source; one of file, asset, box, cylinder, tube, disc is required");
  }
  void operator()(const MeshFile& file) const {
    faults.Error("mesh.file", absl::StrCat("\"", file.path.substr(0, limits::kMaxNameBytes),
                                           "\" is a path of the client; upload the mesh and send "
                                           "mesh.asset"));
  }
  void operator()(const MeshAsset& asset) const {
    Checker(faults).Sha256("mesh.asset", asset.sha256);
  }
  void operator()(const BoxMesh& box) const { faults.Append("mesh.box.", CheckShape(box)); }
  void operator()(const CylinderMesh& cylinder) const {
    faults.Append("mesh.cylinder.", CheckShape(cylinder));
  }
  void operator()(const TubeMesh& tube) const { faults.Append("mesh.tube.", CheckShape(tube)); }
  void operator()(const DiscMesh& disc) const { faults.Append("mesh.disc.", CheckShape(disc)); }
};

struct SelectorRules {
  std::string field;
  Faults& faults;
  Checker& check;

  void operator()(std::monostate) const {
    faults.Error(field, "names no kind; one of box, sphere, plane, region, ids is required");
  }
  void operator()(const BoxSelector& box) const {
    for (size_t axis = 0; axis < 3; ++axis) {
      // Infinite bounds select a half-space, which is useful; NaN and empty boxes are not.
      if (box.min[axis] <= box.max[axis]) continue;
      faults.Error(absl::StrCat(field, ".box.min[", axis, "]"),
                   absl::StrCat(box.min[axis], " is not at most max, ", box.max[axis]));
    }
  }
  void operator()(const SphereSelector& sphere) const {
    check.Coordinates(field + ".sphere.center", sphere.center);
    check.Above(field + ".sphere.radius", sphere.radius, 0, limits::kMaxLength);
  }
  void operator()(const PlaneSelector& plane) const {
    check.Coordinates(field + ".plane.point", plane.point);
    check.Direction(field + ".plane.normal", plane.normal);
  }
  void operator()(const RegionSelector& region) const {
    check.Name(field + ".region", region.region, true);
  }
  void operator()(const IdSelector& selector) const {
    if (selector.ids.empty()) faults.Error(field + ".ids.ids", "is empty");
    check.List(field + ".ids.ids", selector.ids.size(), limits::kMaxNodes);
  }
};

void CheckNodeSets(const Scene& scene, std::set<std::string>& names, Faults& faults,
                   Checker& check) {
  if (!check.List("node_sets", scene.node_sets.size())) return;
  size_t selectors = 0;
  for (const NodeSet& set : scene.node_sets) selectors += set.select.size();
  if (!check.List("node_sets[*].select", selectors)) return;
  for (size_t i = 0; i < scene.node_sets.size(); ++i) {
    const NodeSet& set = scene.node_sets[i];
    check.Name(At("node_sets", i, "name"), set.name, true);
    if (!set.name.empty() && !names.insert(set.name).second) {
      faults.Error(At("node_sets", i, "name"), absl::StrCat("\"", set.name, "\" is taken"));
    }
    const std::string select = At("node_sets", i, "select");
    if (set.select.empty()) faults.Error(select, "is empty; the set would hold no node");
    for (size_t k = 0; k < set.select.size(); ++k) {
      std::visit(SelectorRules{At(select, k), faults, check}, set.select[k]);
    }
  }
}

void CheckMotions(const Scene& scene, const std::set<std::string>& names, Faults& faults,
                  Checker& check) {
  if (!check.List("motions", scene.motions.size())) return;
  for (size_t i = 0; i < scene.motions.size(); ++i) {
    const Motion& motion = scene.motions[i];
    const auto at = [&](absl::string_view field) { return At("motions", i, field); };
    CheckSetName(at("node_set"), motion.node_set, names, faults);
    check.Coordinates(at("rotation_center"), motion.rotation_center);
    check.Direction(at("rotation_axis"), motion.rotation_axis);
    const bool turns = CheckKeyframes(at("keyframes"), motion.keyframes, faults);
    if (turns && motion.axes != std::array<bool, 3>{true, true, true}) {
      faults.Error(at("axes"),
                   "leaves coordinates free, but the motion rotates: prescribe all three");
    }
  }
}

void CheckInitialVelocities(const Scene& scene, const std::set<std::string>& names, Faults& faults,
                            Checker& check) {
  if (!check.List("initial_velocities", scene.initial_velocities.size())) return;
  for (size_t i = 0; i < scene.initial_velocities.size(); ++i) {
    const InitialVelocity& start = scene.initial_velocities[i];
    if (!start.node_set.empty()) {
      CheckSetName(At("initial_velocities", i, "node_set"), start.node_set, names, faults);
    }
    check.Coordinates(At("initial_velocities", i, "velocity"), start.velocity);
    check.Coordinates(At("initial_velocities", i, "angular_velocity"), start.angular_velocity);
    check.Coordinates(At("initial_velocities", i, "center"), start.center);
  }
}

void CheckWeakenings(const Scene& scene, const std::set<std::string>& names, Faults& faults,
                     Checker& check) {
  if (!check.List("weakenings", scene.weakenings.size())) return;
  for (size_t i = 0; i < scene.weakenings.size(); ++i) {
    const Weakening& weakening = scene.weakenings[i];
    const SelectorRules shape{At("weakenings", i), faults, check};
    if (const auto* of_nodes = std::get_if<EdgesOfNodes>(&weakening.edges)) {
      CheckSetName(At("weakenings", i, "node_set"), of_nodes->node_set, names, faults);
    } else if (const auto* box = std::get_if<BoxSelector>(&weakening.edges)) {
      shape(*box);
    } else if (const auto* sphere = std::get_if<SphereSelector>(&weakening.edges)) {
      shape(*sphere);
    } else {
      faults.Error(At("weakenings", i), "names no edges; one of node_set, box, sphere is required");
    }
    if (!(weakening.factor >= 0)) {
      faults.Error(At("weakenings", i, "factor"),
                   absl::StrCat(weakening.factor, " is outside [0, inf]"));
    }
  }
}

void CheckSettings(const Scene& scene, Faults& faults, Checker& check) {
  check.Count("fracture.max_passes", scene.fracture.max_passes, 1, limits::kMaxPasses);
  check.Above("fracture.simultaneity", scene.fracture.simultaneity, 0, 1);
  if (scene.fracture.reformulation == Reformulation::kEdgeProjected) {
    for (size_t i = 0; i < scene.materials.size(); ++i) {
      if (!scene.materials[i].plasticity.has_value()) continue;
      faults.Error("fracture.reformulation",
                   absl::StrCat("edge-projected damage is elastic, but ",
                                At("materials", i, "plasticity"), " is set: use the uniform one"));
    }
  }

  const Timing& timing = scene.timing;
  check.Within("timing.frames_per_second", timing.frames_per_second, limits::kMinFramesPerSecond,
               limits::kMaxFramesPerSecond);
  check.Count("timing.frame_count", timing.frame_count, 1, limits::kMaxFrames);
  check.Count("timing.steps_per_frame", timing.steps_per_frame, 1, limits::kMaxStepsPerFrame);
  const double dt = 1 / (timing.frames_per_second * timing.steps_per_frame);
  if (dt > limits::kMaxStepSeconds) {
    faults.Error("timing.steps_per_frame", absl::StrCat("makes steps of ", dt, " s; at most ",
                                                        limits::kMaxStepSeconds, " s are allowed"));
  } else if (dt > limits::kCoarseStepSeconds) {
    faults.Warning("timing.steps_per_frame",
                   absl::StrCat("makes steps of ", dt, " s: motion will be strongly damped"));
  }

  if (scene.damping.has_value()) {
    check.Within("damping.mass_coefficient", scene.damping->mass_coefficient, 0,
                 limits::kMaxMassDamping);
    check.Within("damping.stiffness_coefficient", scene.damping->stiffness_coefficient, 0,
                 limits::kMaxStiffnessDamping);
  }

  const Quality& quality = scene.quality;
  check.Count("quality.newton_iterations", quality.newton_iterations, 1,
              limits::kMaxNewtonIterations);
  check.Between("quality.residual_tolerance", quality.residual_tolerance, 0, 1);
  check.Between("quality.step_tolerance", quality.step_tolerance, 0, 1);
  check.Between("quality.linear_tolerance", quality.linear_tolerance, 0, 1);
  check.Count("quality.max_step_halvings", quality.max_step_halvings, 0, limits::kMaxStepHalvings);

  const Output& output = scene.output;
  if (output.tolerance.has_value()) {
    check.Within("output.tolerance", *output.tolerance, 0, limits::kMaxLength);
  }
  check.Count("output.keyframe_interval", output.keyframe_interval, 1, limits::kMaxIntervalFrames);
  check.Count("output.checkpoint_interval", output.checkpoint_interval, 1,
              limits::kMaxIntervalFrames);
}

void CheckCoverage(const Scene& scene, const TetMesh& mesh, const RegionIndex& regions,
                   Faults& faults) {
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    for (size_t k = 0; k < scene.materials[i].regions.size(); ++k) {
      const std::string& region = scene.materials[i].regions[k];
      if (regions.Find(region).has_value()) continue;
      faults.Error(At(At("materials", i, "regions"), k),
                   absl::StrCat("\"", region, "\" is no region of the mesh"));
    }
  }
  const std::vector<int32_t> material_of = AssignMaterials(scene.materials, mesh, regions);
  std::map<int32_t, int64_t> bare;
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    if (material_of[static_cast<size_t>(tet)] < 0) ++bare[mesh.region_of(tet)];
  }
  for (const auto& [region, count] : bare) {
    faults.Error("materials",
                 absl::StrCat("region ", region, " (", count, " tets) has no material"));
  }

  double softest = INFINITY, stiffest = 0, lightest = INFINITY, heaviest = 0;
  for (const Material& material : scene.materials) {
    softest = std::min(softest, material.youngs_modulus);
    stiffest = std::max(stiffest, material.youngs_modulus);
    lightest = std::min(lightest, material.density);
    heaviest = std::max(heaviest, material.density);
  }
  constexpr double kHardRatio = 1e6;
  if (stiffest >= kHardRatio * softest) {
    faults.Warning("materials", "Young's moduli differ a million times: solves will be slow");
  }
  if (heaviest >= kHardRatio * lightest) {
    faults.Warning("materials", "densities differ a million times: solves will be slow");
  }
}

void CheckSelections(const Scene& scene, const TetMesh& mesh, const RegionIndex& regions,
                     Faults& faults) {
  std::map<std::string, std::vector<int32_t>> nodes_of;
  for (size_t i = 0; i < scene.node_sets.size(); ++i) {
    const NodeSet& set = scene.node_sets[i];
    for (size_t k = 0; k < set.select.size(); ++k) {
      const std::string field = At(At("node_sets", i, "select"), k);
      if (const auto* region = std::get_if<RegionSelector>(&set.select[k])) {
        if (!regions.Find(region->region).has_value()) {
          faults.Error(field + ".region",
                       absl::StrCat("\"", region->region, "\" is no region of the mesh"));
        }
      } else if (const auto* chosen = std::get_if<IdSelector>(&set.select[k])) {
        for (size_t n = 0; n < chosen->ids.size(); ++n) {
          if (chosen->ids[n] >= 0 && chosen->ids[n] < mesh.node_count()) continue;
          faults.Error(At(field + ".ids.ids", n), absl::StrCat(chosen->ids[n], " is outside [0, ",
                                                               mesh.node_count() - 1, "]"));
        }
      }
    }
    std::vector<int32_t> nodes = SelectNodes(set, mesh, regions);
    if (nodes.empty()) {
      faults.Error(At("node_sets", i),
                   absl::StrCat("\"", set.name, "\" holds no node of the mesh"));
    }
    nodes_of.emplace(set.name, std::move(nodes));
  }

  // Two motions may share a node only where they prescribe different axes of it.
  std::vector<std::array<int32_t, 3>> mover(static_cast<size_t>(mesh.node_count()), {-1, -1, -1});
  std::set<std::pair<int32_t, int32_t>> reported;
  for (size_t i = 0; i < scene.motions.size(); ++i) {
    const auto found = nodes_of.find(scene.motions[i].node_set);
    if (found == nodes_of.end()) continue;
    for (const int32_t node : found->second) {
      for (size_t axis = 0; axis < 3; ++axis) {
        if (!scene.motions[i].axes[axis]) continue;
        int32_t& owner = mover[static_cast<size_t>(node)][axis];
        if (owner >= 0 && reported.insert({owner, static_cast<int32_t>(i)}).second) {
          faults.Error(At("motions", i, "node_set"),
                       absl::StrCat("node ", node, " is already moved along ",
                                    std::string(1, "xyz"[axis]), " by motions[", owner, "]"));
        }
        owner = static_cast<int32_t>(i);
      }
    }
  }
  CheckLoadedNodes(scene, mesh, nodes_of, faults);
}

}  // namespace

Faults ValidateScene(const Scene& scene) {
  Faults faults;
  Checker check(faults);
  check.Name("name", scene.name, false);
  std::visit(MeshSourceRules{faults}, scene.mesh.source);
  check.Above("mesh.unit_scale", scene.mesh.unit_scale, 0, limits::kMaxUnitScale);
  CheckMaterials(scene, faults, check);
  std::set<std::string> names;
  CheckNodeSets(scene, names, faults, check);
  CheckMotions(scene, names, faults, check);
  CheckLoads(scene, names, faults, check);
  CheckInitialVelocities(scene, names, faults, check);
  if (scene.gravity.has_value()) check.Coordinates("gravity", *scene.gravity);
  CheckWeakenings(scene, names, faults, check);
  if (scene.impurities.has_value()) CheckImpurities(*scene.impurities, names, faults);
  CheckColliders(scene, faults);
  CheckContact(scene, faults);
  CheckSleep(scene, faults);
  if (scene.render_mesh.has_value()) CheckRenderMeshSource(*scene.render_mesh, faults);
  CheckSettings(scene, faults, check);
  return faults;
}

Faults ValidateSceneWithMesh(const Scene& scene, const TetMesh& mesh) {
  Faults faults;
  const RegionIndex regions(mesh);
  CheckCoverage(scene, mesh, regions, faults);
  CheckSelections(scene, mesh, regions, faults);
  CheckFibreArrays(scene, mesh, faults);
  if (scene.impurities.has_value()) CheckImpuritiesOfMesh(scene, mesh, faults);
  return faults;
}

}  // namespace cleave
