#include "core/mesh/mesh_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/mesh/coincident_nodes.h"
#include "core/mesh/faces.h"
#include "core/mesh/mesh_limits.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

using Tet = std::array<int32_t, 4>;

// Counts every error but writes the text only of those that are kept: a mesh of a million bad tets
// must not cost a million sentences.
template <typename Description>
void AddError(Faults& faults, absl::string_view array, int64_t id, const Description& description) {
  if (faults.error_count() < Faults::kMaxKept) {
    faults.Error(absl::StrCat(array, "[", id, "]"), description());
  } else {
    faults.Error(array, "");
  }
}

// A warning that many items share: how many, and the first.
struct Tally {
  int64_t count = 0;
  int64_t first = -1;
  void Add(int64_t id) {
    if (count++ == 0) first = id;
  }
};

std::string Nodes(const Tet& tet) {
  return absl::StrCat("nodes ", tet[0], ", ", tet[1], ", ", tet[2], ", ", tet[3]);
}

void CheckPositions(const TetMesh& mesh, Faults& faults) {
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    const Vec3& p = mesh.rest_positions[node];
    const bool in_range = std::abs(p[0]) <= limits::kMaxLength &&
                          std::abs(p[1]) <= limits::kMaxLength &&
                          std::abs(p[2]) <= limits::kMaxLength;
    if (in_range) continue;
    AddError(faults, "rest_positions", static_cast<int64_t>(node), [&] {
      return absl::StrCat("(", p[0], ", ", p[1], ", ", p[2], ") is not within ", limits::kMaxLength,
                          " m of the origin");
    });
  }
}

// Whether the tet's ids may be used at all.
bool CheckIds(const Tet& tet, int64_t id, int64_t node_count, Faults& faults) {
  for (size_t k = 0; k < 4; ++k) {
    if (tet[k] < 0 || tet[k] >= node_count) {
      AddError(faults, "tets", id,
               [&] { return absl::StrCat("node ", tet[k], " is outside [0, ", node_count, ")"); });
      return false;
    }
  }
  for (const auto& [a, b] : kTetEdges) {
    const int32_t node = tet[static_cast<size_t>(a)];
    if (node == tet[static_cast<size_t>(b)]) {
      AddError(faults, "tets", id,
               [&] { return absl::StrCat("names node ", node, " twice (", Nodes(tet), ")"); });
      return false;
    }
  }
  return true;
}

// Checks one tet's shape and turns it to positive volume. Returns whether it has one.
bool CheckShape(TetMesh& mesh, int64_t id, Faults& faults, Tally& swapped, Tally& slivers) {
  TetCorners corners = CornersOf(mesh, id);
  for (const Eigen::Vector3d& corner : corners) {
    if (!(corner.cwiseAbs().maxCoeff() <= limits::kMaxLength)) return false;  // told with its node
  }
  const std::array<double, 2> edges = EdgeRange(corners);
  const double shortest = edges[0], longest = edges[1];
  const double volume = SignedVolume(corners);
  Tet& tet = mesh.tets[static_cast<size_t>(id)];
  if (!(shortest >= limits::kMinEdgeLength)) {
    AddError(faults, "tets", id, [&] {
      return absl::StrCat("shortest edge ", shortest, " m is below ", limits::kMinEdgeLength,
                          " m (", Nodes(tet), ")");
    });
    return false;
  }
  if (!(std::abs(volume) >= limits::kMinTetFlatness * longest * longest * longest)) {
    AddError(faults, "tets", id, [&] {
      return absl::StrCat("is flat: volume ", volume, " m^3 with a longest edge of ", longest,
                          " m (", Nodes(tet), ")");
    });
    return false;
  }
  if (volume < 0) {
    std::swap(tet[2], tet[3]);
    swapped.Add(id);
  }
  if (Aspect(corners) > limits::kSliverAspect) slivers.Add(id);
  return true;
}

// What may be read of a tet.
enum class Soundness : uint8_t { kNothing, kIds, kOrientation };

std::string FaceName(const FaceUse& use) {
  return absl::StrCat("(", use.nodes[0], ", ", use.nodes[1], ", ", use.nodes[2], ")");
}

// Judges the uses of one face.
void CheckFace(const TetMesh& mesh, const std::vector<Soundness>& soundness,
               std::span<const FaceUse> uses, Faults& faults) {
  const auto opposite = [&](const FaceUse& use) {
    return mesh.tets[static_cast<size_t>(use.tet)][static_cast<size_t>(use.local)];
  };
  // Equal tets meet in four faces; they are told at that of their three smallest nodes. A few
  // partners are enough to look at: a face of more than two tets is an error anyhow.
  constexpr size_t kPartners = 8;
  bool duplicate = false;
  for (size_t use = 1; use < uses.size(); ++use) {
    for (size_t earlier = 0; earlier < std::min(use, kPartners); ++earlier) {
      if (opposite(uses[use]) != opposite(uses[earlier])) continue;
      duplicate = true;
      if (opposite(uses[use]) > uses[use].nodes[2]) {
        AddError(faults, "tets", uses[use].tet, [&] {
          return absl::StrCat("has the same nodes as tets[", uses[earlier].tet, "]");
        });
      }
      break;
    }
  }
  if (duplicate) return;
  const auto oriented = [&](const FaceUse& use) {
    return soundness[static_cast<size_t>(use.tet)] == Soundness::kOrientation;
  };
  if (uses.size() > 2) {
    AddError(faults, "tets", uses[2].tet, [&] {
      return absl::StrCat("its face ", FaceName(uses[2]), " is shared by ", uses.size(), " tets (",
                          uses[0].tet, ", ", uses[1].tet, ", ", uses[2].tet,
                          uses.size() > 3 ? ", ..." : "", "); at most two can meet in a face");
    });
  } else if (uses.size() == 2 && uses[0].even == uses[1].even && oriented(uses[0]) &&
             oriented(uses[1])) {
    AddError(faults, "tets", uses[1].tet, [&] {
      return absl::StrCat("overlaps tets[", uses[0].tet, "]: both lie on the same side of face ",
                          FaceName(uses[0]));
    });
  }
}

void CheckRegions(const TetMesh& mesh, Faults& faults) {
  if (!mesh.tet_regions.empty() && mesh.tet_regions.size() != mesh.tets.size()) {
    faults.Error("tet_regions", absl::StrCat("has ", mesh.tet_regions.size(), " items for ",
                                             mesh.tets.size(), " tets"));
  }
  std::vector<std::pair<int32_t, size_t>> ids;
  for (size_t i = 0; i < mesh.regions.size(); ++i) ids.push_back({mesh.regions[i].id, i});
  std::sort(ids.begin(), ids.end());
  for (size_t i = 1; i < ids.size(); ++i) {
    if (ids[i].first != ids[i - 1].first) continue;
    AddError(faults, "regions", static_cast<int64_t>(ids[i].second), [&] {
      return absl::StrCat("has the same id, ", ids[i].first, ", as regions[", ids[i - 1].second,
                          "]");
    });
  }
}

void WarnOf(const Tally& tally, absl::string_view array, absl::string_view what, Faults& faults) {
  if (tally.count == 0) return;
  faults.Warning(
      array, absl::StrCat(tally.count, " ", what, ", the first is ", array, "[", tally.first, "]"));
}

}  // namespace

Faults CheckMeshCounts(int64_t node_count, int64_t tet_count) {
  Faults faults;
  if (tet_count <= 0) faults.Error("tets", "there are none; at least one is needed");
  if (tet_count > limits::kMaxTets)
    faults.Error("tets", absl::StrCat(tet_count, " are more than ", limits::kMaxTets));
  if (node_count > limits::kMaxNodes) {
    faults.Error("rest_positions",
                 absl::StrCat(node_count, " nodes are more than ", limits::kMaxNodes));
  }
  return faults;
}

Faults CheckAndOrientMesh(TetMesh& mesh) {
  Faults faults = CheckMeshCounts(mesh.node_count(), mesh.tet_count());
  if (!faults.ok()) return faults;
  CheckPositions(mesh, faults);
  Tally swapped;
  Tally slivers;
  std::vector<Soundness> soundness(mesh.tets.size(), Soundness::kNothing);
  std::vector<bool> referenced(mesh.rest_positions.size());
  for (int64_t id = 0; id < mesh.tet_count(); ++id) {
    const auto index = static_cast<size_t>(id);
    if (!CheckIds(mesh.tets[index], id, mesh.node_count(), faults)) continue;
    for (const int32_t node : mesh.tets[index]) referenced[static_cast<size_t>(node)] = true;
    soundness[index] =
        CheckShape(mesh, id, faults, swapped, slivers) ? Soundness::kOrientation : Soundness::kIds;
  }
  ForEachFace(
      mesh, [&](int64_t tet) { return soundness[static_cast<size_t>(tet)] != Soundness::kNothing; },
      [&](std::span<const FaceUse> uses) { CheckFace(mesh, soundness, uses, faults); });
  CheckRegions(mesh, faults);

  WarnOf(swapped, "tets", "have negative orientation; their last two nodes were swapped", faults);
  WarnOf(slivers, "tets", absl::StrCat("are slivers with an aspect above ", limits::kSliverAspect),
         faults);
  Tally unreferenced;
  for (size_t node = 0; node < referenced.size(); ++node) {
    if (!referenced[node]) unreferenced.Add(static_cast<int64_t>(node));
  }
  WarnOf(unreferenced, "rest_positions", "nodes are in no tet and stay where they are", faults);
  const CoincidentNodes coincident = FindCoincidentNodes(mesh.rest_positions);
  WarnOf({coincident.count, coincident.first}, "rest_positions",
         "nodes lie on another node without being joined to it: a gap that opens freely", faults);
  return faults;
}

}  // namespace cleave
