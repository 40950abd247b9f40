#include "core/mesh/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/mesh/coincident_nodes.h"
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
    if (tet[static_cast<size_t>(a)] == tet[static_cast<size_t>(b)]) {
      AddError(faults, "tets", id, [&] {
        return absl::StrCat("names node ", tet[static_cast<size_t>(a)], " twice (", Nodes(tet),
                            ")");
      });
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
  const auto [shortest, longest] = EdgeRange(corners);
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

// One tet's use of a face, filed under the face's smallest node.
struct FaceUse {
  int32_t middle;
  int32_t largest;
  int32_t tet;
  int32_t opposite;  // the tet's node off the face
  bool even;         // whether the tet's outward order of the face is an even permutation of sorted
  bool oriented;     // whether that order means anything: the tet has positive volume

  bool SameFace(const FaceUse& other) const {
    return middle == other.middle && largest == other.largest;
  }
  bool operator<(const FaceUse& other) const {
    if (middle != other.middle) return middle < other.middle;
    if (largest != other.largest) return largest < other.largest;
    return tet < other.tet;
  }
};

std::string FaceName(int32_t smallest, const FaceUse& use) {
  return absl::StrCat("(", smallest, ", ", use.middle, ", ", use.largest, ")");
}

// Judges the uses of one face.
void CheckFace(int32_t smallest, const FaceUse* begin, const FaceUse* end, Faults& faults) {
  // Equal tets meet in four faces; they are told at that of their three smallest nodes.
  bool duplicate = false;
  for (const FaceUse* use = begin + 1; use < end; ++use) {
    for (const FaceUse* earlier = begin; earlier < use && earlier < begin + 8; ++earlier) {
      if (use->opposite != earlier->opposite) continue;
      duplicate = true;
      if (use->opposite > use->largest) {
        AddError(faults, "tets", use->tet,
                 [&] { return absl::StrCat("has the same nodes as tets[", earlier->tet, "]"); });
      }
      break;
    }
  }
  if (duplicate) return;
  if (end - begin > 2) {
    AddError(faults, "tets", begin[2].tet, [&] {
      return absl::StrCat("its face ", FaceName(smallest, begin[2]), " is shared by ", end - begin,
                          " tets (", begin[0].tet, ", ", begin[1].tet, ", ", begin[2].tet,
                          end - begin > 3 ? ", ..." : "", "); at most two can meet in a face");
    });
  } else if (end - begin == 2 && begin[0].even == begin[1].even && begin[0].oriented &&
             begin[1].oriented) {
    AddError(faults, "tets", begin[1].tet, [&] {
      return absl::StrCat("overlaps tets[", begin[0].tet, "]: both lie on the same side of face ",
                          FaceName(smallest, begin[0]));
    });
  }
}

// What may be read of a tet.
enum class Soundness : uint8_t { kNothing, kIds, kOrientation };

void CheckFaces(const TetMesh& mesh, const std::vector<Soundness>& soundness, Faults& faults) {
  const auto nodes = static_cast<size_t>(mesh.node_count());
  const auto smallest_of = [](const Tet& tet, const std::array<int, 3>& face) {
    return std::min({tet[static_cast<size_t>(face[0])], tet[static_cast<size_t>(face[1])],
                     tet[static_cast<size_t>(face[2])]});
  };
  // Filing by smallest node first leaves only short runs to sort.
  std::vector<int32_t> offsets(nodes + 1, 0);
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    if (soundness[tet] == Soundness::kNothing) continue;
    for (const auto& face : kTetFaces)
      ++offsets[static_cast<size_t>(smallest_of(mesh.tets[tet], face)) + 1];
  }
  for (size_t node = 0; node < nodes; ++node) offsets[node + 1] += offsets[node];
  std::vector<FaceUse> uses(static_cast<size_t>(offsets[nodes]));
  std::vector<int32_t> next(offsets.begin(), offsets.end() - 1);
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    if (soundness[tet] == Soundness::kNothing) continue;
    for (size_t k = 0; k < 4; ++k) {
      std::array<int32_t, 3> face;
      for (size_t i = 0; i < 3; ++i) face[i] = mesh.tets[tet][static_cast<size_t>(kTetFaces[k][i])];
      bool even = true;
      const auto order = [&](size_t i, size_t j) {
        if (face[i] > face[j]) {
          std::swap(face[i], face[j]);
          even = !even;
        }
      };
      order(0, 1);
      order(1, 2);
      order(0, 1);
      uses[static_cast<size_t>(next[static_cast<size_t>(face[0])]++)] = {
          face[1],           face[2], static_cast<int32_t>(tet),
          mesh.tets[tet][k], even,    soundness[tet] == Soundness::kOrientation};
    }
  }
  for (size_t node = 0; node < nodes; ++node) {
    FaceUse* const begin = uses.data() + offsets[node];
    FaceUse* const end = uses.data() + offsets[node + 1];
    std::sort(begin, end);
    for (FaceUse* face = begin; face < end;) {
      FaceUse* after = face + 1;
      while (after < end && after->SameFace(*face)) ++after;
      CheckFace(static_cast<int32_t>(node), face, after, faults);
      face = after;
    }
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

Faults CheckAndOrientMesh(TetMesh& mesh) {
  Faults faults;
  if (mesh.tets.empty()) faults.Error("tets", "there are none; at least one is needed");
  if (mesh.tet_count() > limits::kMaxTets) {
    faults.Error("tets", absl::StrCat(mesh.tet_count(), " are more than ", limits::kMaxTets));
  }
  if (mesh.node_count() > limits::kMaxNodes) {
    faults.Error("rest_positions",
                 absl::StrCat(mesh.node_count(), " nodes are more than ", limits::kMaxNodes));
  }
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
  CheckFaces(mesh, soundness, faults);
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
