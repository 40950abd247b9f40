// What EmbeddedMesh closes of cracks where the render mesh does not follow the body's faces.

#include <algorithm>
#include <tuple>
#include <utility>

#include "core/surface/embedded_mesh.h"

namespace cleave {

void EmbeddedMesh::BindGaps() {
  std::vector<int32_t> counts;  // of what is summed in `apexes_`
  for (const RenderHubs::Gap& gap : hubs_.gaps()) {
    const auto group = static_cast<size_t>(gap.group);
    if (group == apexes_.size()) {
      apexes_.push_back({0, 0, 0});
      counts.push_back(0);
    }
    Triple& edges = gap_edges_.emplace_back();
    for (size_t k = 0; k < 3; ++k) {
      const int32_t found = divided_.FindEdge(gap.nodes[k], gap.nodes[(k + 1) % 3]);
      edges[k] = found < 0 ? kNoEdge : found;
      rim_.push_back({gap.group, gap.nodes[k], 0});
      const Vec3& rest = mesh_.rest_positions[static_cast<size_t>(gap.nodes[k])];
      for (size_t axis = 0; axis < 3; ++axis) apexes_[group][axis] += rest[axis];
      ++counts[group];
    }
  }
  for (size_t group = 0; group < apexes_.size(); ++group) {
    for (double& coordinate : apexes_[group]) coordinate /= counts[group];
  }
  const auto key = [](const RimNode& at) { return std::pair(at.group, at.node); };
  std::sort(rim_.begin(), rim_.end(),
            [&](const RimNode& a, const RimNode& b) { return key(a) < key(b); });
  rim_.erase(std::unique(rim_.begin(), rim_.end(),
                         [&](const RimNode& a, const RimNode& b) { return key(a) == key(b); }),
             rim_.end());
}

size_t EmbeddedMesh::RimIndex(int32_t group, int32_t node) const {
  const auto found = std::lower_bound(
      rim_.begin(), rim_.end(), std::pair(group, node),
      [](const RimNode& at, const auto& wanted) { return std::pair(at.group, at.node) < wanted; });
  return static_cast<size_t>(found - rim_.begin());
}

// Two nodes whose common point is whole have the same apex, or its two sides would not meet.
void EmbeddedMesh::JoinRims() {
  for (size_t i = 0; i < rim_.size(); ++i) rim_[i].joined = static_cast<int32_t>(i);
  const auto root = [&](size_t at) {
    while (rim_[at].joined != static_cast<int32_t>(at)) at = static_cast<size_t>(rim_[at].joined);
    return at;
  };
  for (size_t i = 0; i < gap_edges_.size(); ++i) {
    const RenderHubs::Gap& gap = hubs_.gaps()[i];
    for (size_t k = 0; k < 3; ++k) {
      const int32_t a = gap.nodes[k];
      const int32_t b = gap.nodes[(k + 1) % 3];
      if (IsSplit(gap_edges_[i][k], a, b)) continue;
      const auto [low, high] =
          std::minmax({root(RimIndex(gap.group, a)), root(RimIndex(gap.group, b))});
      rim_[high].joined = static_cast<int32_t>(low);
    }
  }
  for (size_t i = 0; i < rim_.size(); ++i) rim_[i].joined = static_cast<int32_t>(root(i));
}

int32_t EmbeddedMesh::ApexPoint(int32_t group, int32_t node) {
  const int32_t first = rim_[RimIndex(group, node)].joined;
  SurfacePoint point{apexes_[static_cast<size_t>(group)], {-1, -1, -1, -1}, {}, 0, 0, true};
  for (auto at = static_cast<size_t>(first);
       at < rim_.size() && rim_[at].group == group && point.node_count < 4; ++at) {
    if (rim_[at].joined == first) point.nodes[point.node_count++] = rim_[at].node;
  }
  for (size_t k = 0; k < point.node_count; ++k) {
    point.weights[k] = 1.0 / point.node_count;
    point.owners |= static_cast<uint8_t>(1u << k);
  }
  return Put(surface_id::OfRenderApex(static_cast<size_t>(first)), point);
}

int64_t EmbeddedMesh::CapGaps() {
  if (gap_edges_.empty()) return 0;
  JoinRims();
  Begin(cap_slots_);
  for (size_t i = 0; i < gap_edges_.size(); ++i) {
    const RenderHubs::Gap& gap = hubs_.gaps()[i];
    const Parting parting = PartingOf(gap.nodes, gap_edges_[i], gap.face);
    for (size_t k = 0; k < 3; ++k) {
      if (!parting.open[k]) continue;
      const size_t next = (k + 1) % 3;
      for (const auto& [side, across] : {std::pair(k, next), std::pair(next, k)}) {
        const int32_t node = gap.nodes[side];
        int32_t from = TriplePoint(gap.nodes, gap.face, parting, side);
        int32_t to = PairPoint(gap_edges_[i][k], node, gap.nodes[across]);
        if (side != k) std::swap(from, to);
        const int32_t apex = ApexPoint(gap.group, node);
        const int32_t tet =
            gap.face < 0 ? incidence_.node_tets[node].front() : static_cast<int32_t>(gap.face / 4);
        for (int32_t turn = 0; turn < gap.turns; ++turn) {
          AddTriangle(surface_id::OfRenderCap(i, k, side, static_cast<size_t>(turn)), from, to,
                      apex, static_cast<size_t>(tet), node, -1);
        }
      }
    }
  }
  return static_cast<int64_t>(used_);
}

}  // namespace cleave
