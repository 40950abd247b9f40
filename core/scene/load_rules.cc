#include "core/scene/load_rules.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "core/mesh/boundary_faces.h"
#include "core/scene/limits.h"

namespace cleave {
namespace {

using NodesOf = std::map<std::string, std::vector<int32_t>>;

struct LoadKindRules {
  std::string field;
  Faults& faults;
  Checker& check;

  void Vector(absl::string_view name, const Vec3& vector, double most) const {
    for (size_t axis = 0; axis < 3; ++axis)
      check.Within(absl::StrCat(field, name, "[", axis, "]"), vector[axis], -most, most);
  }
  void operator()(std::monostate) const {
    faults.Error(field, "names no kind; one of force, traction, pressure is required");
  }
  void operator()(const PointForce& force) const {
    Vector(".force.total", force.total, limits::kMaxForce);
  }
  void operator()(const SurfaceTraction& traction) const {
    Vector(".traction.traction", traction.traction, limits::kMaxPressure);
  }
  void operator()(const SurfacePressure& pressure) const {
    check.Within(field + ".pressure.pressure", pressure.pressure, -limits::kMaxPressure,
                 limits::kMaxPressure);
  }
};

void CheckRelease(const std::string& field, const Release& release, bool can_break,
                  const std::set<std::string>& names, Faults& faults, Checker& check) {
  const bool on_event = release.first_fracture || release.broken_share || release.pieces ||
                        !release.separated_node_sets.empty();
  if (!release.time && !on_event)
    faults.Error(field, "names no time and no event; at least one is required");
  if (on_event && !can_break)
    faults.Warning(field, "waits for fracture, but no material has a tensile strength");
  if (release.time && !std::isfinite(*release.time))
    faults.Error(field + ".time", absl::StrCat(*release.time, " is not a finite number"));
  if (release.broken_share) check.Above(field + ".broken_share", *release.broken_share, 0, 1);
  if (release.pieces) check.Count(field + ".pieces", *release.pieces, 2, limits::kMaxNodes);
  const std::string list = field + ".separated_node_sets";
  const std::vector<std::string>& sets = release.separated_node_sets;
  if (!check.List(list, sets.size())) return;
  if (sets.size() == 1) faults.Error(list, "holds one set; two or more can be separated");
  for (size_t k = 0; k < sets.size(); ++k) {
    CheckSetName(At(list, k), sets[k], names, faults);
    if (std::find(sets.begin(), sets.begin() + static_cast<std::ptrdiff_t>(k), sets[k]) !=
        sets.begin() + static_cast<std::ptrdiff_t>(k))
      faults.Error(At(list, k), absl::StrCat("\"", sets[k], "\" is named twice"));
  }
}

void CheckSeparable(const std::string& field, const Release& release, int64_t node_count,
                    const NodesOf& nodes_of, Faults& faults) {
  if (release.separated_node_sets.empty()) return;
  std::vector<int32_t> owner(static_cast<size_t>(node_count), -1);
  for (size_t k = 0; k < release.separated_node_sets.size(); ++k) {
    const auto found = nodes_of.find(release.separated_node_sets[k]);
    if (found == nodes_of.end()) continue;
    for (const int32_t node : found->second) {
      int32_t& set = owner[static_cast<size_t>(node)];
      if (set >= 0) {
        faults.Error(At(field + ".separated_node_sets", k),
                     absl::StrCat("node ", node, " is in \"",
                                  release.separated_node_sets[static_cast<size_t>(set)],
                                  "\" too; sets that share a node are never separated"));
        break;
      }
      set = static_cast<int32_t>(k);
    }
  }
}

}  // namespace

void CheckLoads(const Scene& scene, const std::set<std::string>& names, Faults& faults,
                Checker& check) {
  const bool can_break = CanBreak(scene);
  for (size_t i = 0; i < scene.motions.size() && i < limits::kMaxListItems; ++i) {
    if (!scene.motions[i].release) continue;
    CheckRelease(At("motions", i, "release"), *scene.motions[i].release, can_break, names, faults,
                 check);
  }
  if (!check.List("loads", scene.loads.size())) return;
  for (size_t i = 0; i < scene.loads.size(); ++i) {
    const Load& load = scene.loads[i];
    CheckSetName(At("loads", i, "node_set"), load.node_set, names, faults);
    std::visit(LoadKindRules{At("loads", i), faults, check}, load.kind);
    const std::string keyframes = At("loads", i, "keyframes");
    if (check.List(keyframes, load.keyframes.size(), limits::kMaxKeyframes)) {
      for (size_t k = 0; k < load.keyframes.size(); ++k) {
        const LoadKeyframe& keyframe = load.keyframes[k];
        if (!std::isfinite(keyframe.time)) {
          faults.Error(At(keyframes, k, "time"),
                       absl::StrCat(keyframe.time, " is not a finite number"));
        } else if (k > 0 && !(keyframe.time > load.keyframes[k - 1].time)) {
          faults.Error(At(keyframes, k, "time"),
                       absl::StrCat(keyframe.time, " s is not after the previous, ",
                                    load.keyframes[k - 1].time, " s"));
        }
        check.Within(At(keyframes, k, "intensity"), keyframe.intensity, -limits::kMaxIntensity,
                     limits::kMaxIntensity);
      }
    }
    if (load.release)
      CheckRelease(At("loads", i, "release"), *load.release, can_break, names, faults, check);
  }
}

void CheckLoadedNodes(const Scene& scene, const TetMesh& mesh, const NodesOf& nodes_of,
                      Faults& faults) {
  for (size_t i = 0; i < scene.motions.size(); ++i) {
    if (!scene.motions[i].release) continue;
    CheckSeparable(At("motions", i, "release"), *scene.motions[i].release, mesh.node_count(),
                   nodes_of, faults);
  }
  for (size_t i = 0; i < scene.loads.size(); ++i) {
    const Load& load = scene.loads[i];
    if (load.release)
      CheckSeparable(At("loads", i, "release"), *load.release, mesh.node_count(), nodes_of, faults);
    const auto found = nodes_of.find(load.node_set);
    // An empty set is reported where it is made.
    if (found == nodes_of.end() || found->second.empty()) continue;
    if (std::holds_alternative<PointForce>(load.kind)) continue;
    if (FindBoundaryFaces(mesh, found->second).empty()) {
      faults.Error(At("loads", i, "node_set"),
                   absl::StrCat("\"", load.node_set,
                                "\" holds all three nodes of no face of the mesh's boundary"));
    }
  }
}

}  // namespace cleave
