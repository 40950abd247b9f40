#include "core/surface/render_hubs.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <iterator>

namespace cleave {
namespace {

using Pair = DividedMesh::Pair;
using Triple = DividedMesh::Triple;

Pair Sorted(int32_t a, int32_t b) { return {std::min(a, b), std::max(a, b)}; }

Triple Sorted(Triple nodes) {
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

// Whether three distinct numbers turn as three others, the same ones, do.
bool TurnsAs(const Triple& a, const Triple& b) {
  const auto at = std::find(b.begin(), b.end(), a[0]) - b.begin();
  return b[static_cast<size_t>((at + 1) % 3)] == a[1];
}

void Add(const Vec3& place, RenderHubs::Hub& hub) {
  for (size_t axis = 0; axis < 3; ++axis) hub.sum[axis] += place[axis];
  ++hub.count;
}

}  // namespace

RenderHubs::RenderHubs(const TetMesh& mesh, const Faces& faces, const DividedMesh& divided) {
  FindHubs(divided);
  FindGaps(mesh, faces, divided);
}

const RenderHubs::Hub* RenderHubs::Find(int32_t a, int32_t b) const {
  const auto found = pairs_.find(Sorted(a, b));
  return found == pairs_.end() ? nullptr : &found->second;
}

const RenderHubs::Hub* RenderHubs::Find(Triple nodes) const {
  const auto found = triples_.find(Sorted(nodes));
  return found == triples_.end() ? nullptr : &found->second;
}

int64_t RenderHubs::IndexOf(int32_t a, int32_t b) const {
  return std::distance(pairs_.begin(), pairs_.find(Sorted(a, b)));
}

int64_t RenderHubs::IndexOf(Triple nodes) const {
  return std::distance(triples_.begin(), triples_.find(Sorted(nodes)));
}

void RenderHubs::FindHubs(const DividedMesh& divided) {
  std::vector<Vec3> cuts(divided.edges().size());
  for (size_t edge = 0; edge < cuts.size(); ++edge) {
    const auto [from, to] = divided.edges()[edge];
    const int32_t a = divided.label(static_cast<size_t>(from));
    const int32_t b = divided.label(static_cast<size_t>(to));
    if (a == b) continue;
    cuts[edge] = divided.CutAt(edge);
    Add(cuts[edge], pairs_[Sorted(a, b)]);
  }
  for (size_t i = 0; i < divided.mesh().triangles.size(); ++i) {
    const Triple nodes = Sorted(divided.LabelsOf(i));
    if (nodes[0] == nodes[1] || nodes[1] == nodes[2]) continue;
    Hub middle;
    for (const int32_t edge : divided.triangle_edges(i))
      Add(cuts[static_cast<size_t>(edge)], middle);
    Add(middle.place(), triples_[nodes]);
  }
}

// The render mesh goes round some tets: those from which one cannot leave through faces at whose
// nodes it has a triangle.
void RenderHubs::FindInside(const Faces& faces, const Crossings& crossings) {
  const auto crossing_of = [&](int64_t face) {
    const auto found = crossings.find(face);
    return found == crossings.end() ? 0 : found->second;
  };
  inside_.assign(faces.neighbors.size(), 0);
  std::vector<uint8_t> known(faces.neighbors.size(), 0);
  for (const TetFace& start : faces.boundary) {
    if (known[static_cast<size_t>(start.tet)] != 0) continue;
    std::vector<int32_t> part{start.tet};
    std::map<int32_t, int64_t> votes;  // for what the first tet counts, by boundary faces
    known[static_cast<size_t>(start.tet)] = 1;
    for (size_t at = 0; at < part.size(); ++at) {
      const auto tet = static_cast<size_t>(part[at]);
      for (size_t face = 0; face < 4; ++face) {
        const auto own = static_cast<int64_t>(4 * tet + face);
        const int32_t across = faces.neighbors[tet][face];
        if (across < 0) {
          ++votes[crossing_of(own) - inside_[tet]];
          continue;
        }
        const auto other = static_cast<size_t>(across / 4);
        if (known[other] != 0) continue;
        known[other] = 1;
        // Of the lower tet less that of the upper one.
        inside_[other] = inside_[tet] + (own < across ? -crossing_of(own) : crossing_of(across));
        part.push_back(across / 4);
      }
    }
    // Where the render mesh bridges a crease of the body, it has no triangle at faces in it.
    const auto most =
        std::max_element(votes.begin(), votes.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    for (const int32_t tet : part) inside_[static_cast<size_t>(tet)] += most->first;
  }
}

void RenderHubs::FindGaps(const TetMesh& mesh, const Faces& faces, const DividedMesh& divided) {
  const auto nodes_of = [&](int64_t face) {
    Triple outward{};
    for (size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<size_t>(kTetFaces[static_cast<size_t>(face % 4)][k]);
      outward[k] = mesh.tets[static_cast<size_t>(face / 4)][vertex];
    }
    return outward;
  };
  Crossings crossings;
  std::map<Triple, int32_t> loose;  // as the ascending nodes turn
  for (size_t i = 0; i < divided.mesh().triangles.size(); ++i) {
    const Triple nodes = divided.LabelsOf(i);
    if (nodes[0] == nodes[1] || nodes[1] == nodes[2] || nodes[2] == nodes[0]) continue;
    const int64_t face = divided.FindFace(nodes);
    int32_t& crossed = face < 0 ? loose[Sorted(nodes)] : crossings[face];
    crossed += TurnsAs(nodes, face < 0 ? Sorted(nodes) : nodes_of(face)) ? 1 : -1;
  }
  FindInside(faces, crossings);
  const auto add = [&](const Triple& nodes, int32_t turns, int64_t face) {
    if (turns == 0) return;
    const Triple turned{nodes[0], nodes[turns > 0 ? 1 : 2], nodes[turns > 0 ? 2 : 1]};
    gaps_.push_back({turned, std::abs(turns), face, 0});
  };
  for (const auto& [nodes, crossed] : loose) add(nodes, crossed, -1);
  for (size_t tet = 0; tet < inside_.size(); ++tet) {
    for (size_t face = 0; face < 4; ++face) {
      const auto own = static_cast<int64_t>(4 * tet + face);
      const int32_t across = faces.neighbors[tet][face];
      if (across >= 0 && across < own) continue;
      const auto found = crossings.find(own);
      const int32_t crossed = found == crossings.end() ? 0 : found->second;
      const int32_t beyond = across < 0 ? 0 : inside_[static_cast<size_t>(across / 4)];
      add(nodes_of(own), crossed - (inside_[tet] - beyond), own);
    }
  }
  GroupGaps();
}

void RenderHubs::GroupGaps() {
  std::vector<int32_t> root(gaps_.size());
  for (size_t i = 0; i < root.size(); ++i) root[i] = static_cast<int32_t>(i);
  const auto find = [&](int32_t gap) {
    while (root[static_cast<size_t>(gap)] != gap) gap = root[static_cast<size_t>(gap)];
    return gap;
  };
  std::map<Pair, int32_t> first;
  for (size_t i = 0; i < gaps_.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const Pair pair = Sorted(gaps_[i].nodes[k], gaps_[i].nodes[(k + 1) % 3]);
      const auto own = static_cast<int32_t>(i);
      const auto [low, high] =
          std::minmax({find(own), find(first.try_emplace(pair, own).first->second)});
      root[static_cast<size_t>(high)] = low;
    }
  }
  std::map<int32_t, int32_t> groups;
  for (size_t i = 0; i < gaps_.size(); ++i) {
    const auto next = static_cast<int32_t>(groups.size());
    gaps_[i].group = groups.try_emplace(find(static_cast<int32_t>(i)), next).first->second;
  }
  std::stable_sort(gaps_.begin(), gaps_.end(),
                   [](const Gap& a, const Gap& b) { return a.group < b.group; });
}

}  // namespace cleave
