#include "core/surface/render_hubs.h"

#include <algorithm>
#include <cstddef>
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
  FindInside(mesh, faces, divided);
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
// nodes it has a triangle. As it is closed, so is what its triangles are of faces.
void RenderHubs::FindInside(const TetMesh& mesh, const Faces& faces, const DividedMesh& divided) {
  std::map<int64_t, int32_t> crossings;  // outward of the lower tet, by face
  for (size_t i = 0; i < divided.mesh().triangles.size(); ++i) {
    const DividedMesh::Triple nodes = divided.LabelsOf(i);
    if (nodes[0] == nodes[1] || nodes[1] == nodes[2] || nodes[2] == nodes[0]) continue;
    const int64_t face = divided.FindFace(nodes);
    if (face < 0) {
      ++open_faces_;
      continue;
    }
    DividedMesh::Triple outward{};
    for (size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<size_t>(kTetFaces[static_cast<size_t>(face % 4)][k]);
      outward[k] = mesh.tets[static_cast<size_t>(face / 4)][vertex];
    }
    crossings[face] += TurnsAs(nodes, outward) ? 1 : -1;
  }
  const auto crossing_of = [&](int64_t face) {
    const auto found = crossings.find(face);
    return found == crossings.end() ? 0 : found->second;
  };
  inside_.assign(mesh.tets.size(), 0);
  std::vector<uint8_t> known(mesh.tets.size(), 0);
  std::vector<int32_t> queue;
  for (const TetFace& side : faces.boundary) {
    const int32_t crossing = crossing_of(4 * int64_t{side.tet} + side.face);
    if (known[static_cast<size_t>(side.tet)] != 0) {
      open_faces_ += inside_[static_cast<size_t>(side.tet)] != crossing ? 1 : 0;
      continue;
    }
    known[static_cast<size_t>(side.tet)] = 1;
    inside_[static_cast<size_t>(side.tet)] = crossing;
    queue.push_back(side.tet);
    while (!queue.empty()) {
      const int32_t tet = queue.back();
      queue.pop_back();
      for (size_t face = 0; face < 4; ++face) {
        const int32_t across = faces.neighbors[static_cast<size_t>(tet)][face];
        if (across < 0) continue;
        const int64_t own = 4 * int64_t{tet} + static_cast<int64_t>(face);
        // Of the lower tet less that of the upper one.
        const int32_t step = own < across ? -crossing_of(own) : crossing_of(across);
        const auto other = static_cast<size_t>(across / 4);
        const int32_t wanted = inside_[static_cast<size_t>(tet)] + step;
        if (known[other] != 0) {
          open_faces_ += own < across && inside_[other] != wanted ? 1 : 0;
          continue;
        }
        known[other] = 1;
        inside_[other] = wanted;
        queue.push_back(across / 4);
      }
    }
  }
}

}  // namespace cleave
