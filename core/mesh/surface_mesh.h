#ifndef CLEAVE_CORE_MESH_SURFACE_MESH_H_
#define CLEAVE_CORE_MESH_SURFACE_MESH_H_

#include <array>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/vec3.h"
#include "core/mesh/procedural_shapes.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// A body made of a surface, and how well it fills it.
struct SurfaceBody {
  TetMesh mesh;
  // m^3, of what the surface encloses, its holes closed from their common middle; overlapping parts
  // count twice.
  double surface_volume = 0;
  int64_t open_edges = 0;     // sides of triangles that no other triangle has the other way round
  int64_t dropped_parts = 0;  // smaller than a hundredth of the body, which the cells tore off
};

// Tets of what a triangle surface encloses by its winding number, which closes small holes and
// joins parts that overlap: cells of `resolution` cut off at the surface (tet_clip.h), sharp edges
// drawn back to where they were, then improved. Surface nodes lie on the surface or on what closes
// its holes, or a fifth of a cell beside it where tets would be flat. A surface that is turned
// inside out is turned back. Details smaller than a cell are lost. `vertices` in metres. The mesh
// passes CheckAndOrientMesh; the same input gives the same bits.
//
// Errors: InvalidArgument for a cell size or jitter out of range, ids of vertices out of range,
// coordinates that are not finite or too large, cells that make too many tets, a surface that
// encloses nothing at this cell size, and a body whose volume is less than half or more than one
// and a half of a closed surface's.
absl::StatusOr<SurfaceBody> MeshSurface(const std::vector<Vec3>& vertices,
                                        const std::vector<std::array<int32_t, 3>>& triangles,
                                        const MeshResolution& resolution);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_SURFACE_MESH_H_
