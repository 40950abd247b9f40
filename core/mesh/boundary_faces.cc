#include "core/mesh/boundary_faces.h"

#include <algorithm>

#include "core/mesh/faces.h"

namespace cleave {

std::vector<BoundaryFace> FindBoundaryFaces(const TetMesh& mesh, std::span<const int32_t> nodes) {
  std::vector<uint8_t> chosen(static_cast<size_t>(mesh.node_count()), 0);
  for (const int32_t node : nodes) chosen[static_cast<size_t>(node)] = 1;
  // A tet with a face in the set has three nodes in it; both tets of a face do.
  const auto near = [&](int64_t tet) {
    int inside = 0;
    for (const int32_t node : mesh.tets[static_cast<size_t>(tet)])
      inside += chosen[static_cast<size_t>(node)];
    return inside >= 3;
  };
  struct Place {
    int32_t tet;
    int8_t local;
  };
  std::vector<Place> places;
  ForEachFace(mesh, near, [&](std::span<const FaceUse> uses) {
    if (uses.size() > 1) return;
    for (const int32_t node : uses[0].nodes) {
      if (chosen[static_cast<size_t>(node)] == 0) return;
    }
    places.push_back({uses[0].tet, uses[0].local});
  });
  std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) {
    return a.tet != b.tet ? a.tet < b.tet : a.local < b.local;
  });
  std::vector<BoundaryFace> faces;
  faces.reserve(places.size());
  for (const Place& place : places) {
    BoundaryFace& face = faces.emplace_back();
    face.tet = place.tet;
    for (size_t i = 0; i < 3; ++i) {
      const int corner = kTetFaces[static_cast<size_t>(place.local)][i];
      face.nodes[i] = mesh.tets[static_cast<size_t>(place.tet)][static_cast<size_t>(corner)];
    }
  }
  return faces;
}

}  // namespace cleave
