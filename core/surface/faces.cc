#include "core/surface/faces.h"

#include <span>

#include "core/mesh/faces.h"

namespace cleave {

Faces BuildFaces(const TetMesh& mesh) {
  Faces faces;
  faces.neighbors.assign(mesh.tets.size(), {-1, -1, -1, -1});
  const auto set_neighbor = [&](const FaceUse& use, const FaceUse& across) {
    faces.neighbors[static_cast<size_t>(use.tet)][static_cast<size_t>(use.local)] =
        4 * across.tet + across.local;
  };
  ForEachFace(
      mesh, [](int64_t) { return true; },
      [&](std::span<const FaceUse> uses) {
        if (uses.size() < 2) return;
        set_neighbor(uses[0], uses[1]);
        set_neighbor(uses[1], uses[0]);
      });
  for (int32_t tet = 0; tet < static_cast<int32_t>(faces.neighbors.size()); ++tet) {
    for (int32_t face = 0; face < 4; ++face) {
      if (faces.neighbors[static_cast<size_t>(tet)][static_cast<size_t>(face)] < 0)
        faces.boundary.push_back({tet, face});
    }
  }
  return faces;
}

}  // namespace cleave
