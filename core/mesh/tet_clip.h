#ifndef CLEAVE_CORE_MESH_TET_CLIP_H_
#define CLEAVE_CORE_MESH_TET_CLIP_H_

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/mesh/tet_mesh.h"

namespace cleave {

// Tets cut off at a surface.
struct ClippedTets {
  TetMesh mesh;
  std::vector<uint8_t> on_surface;  // a node each
};

// The part of a tet mesh that is inside: tets that the surface crosses are cut where it crosses
// their edges, and nodes near it are moved onto it first, so that few slivers come out. A part that
// is thinner than an edge and holds no node is lost. `inside` must be safe to ask from any thread.
// The same input gives the same bits. Preconditions: positive volumes, no face of more than two
// tets. Source: Labelle and Shewchuk, "Isosurface stuffing", 2007.
ClippedTets ClipTets(const TetMesh& mesh,
                     const std::function<bool(const Eigen::Vector3d&)>& inside);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_TET_CLIP_H_
