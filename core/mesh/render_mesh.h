#ifndef CLEAVE_CORE_MESH_RENDER_MESH_H_
#define CLEAVE_CORE_MESH_RENDER_MESH_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// Texture coordinates of a triangle's corners.
using CornerUvs = std::array<std::array<float, 2>, 3>;

// A fine triangle mesh that stands for a body's surface in pictures.
struct RenderMesh {
  std::vector<Vec3> points;                       // m, where the body rests
  std::vector<std::array<int32_t, 3>> triangles;  // point ids, counter-clockwise from outside
  std::vector<CornerUvs> uvs;                     // a triangle each, or empty: it has none
};

// Edges of a mesh that have no counterpart, or too many: 0 for a closed oriented surface.
int64_t CountOpenEdges(const std::vector<std::array<int32_t, 3>>& triangles);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_RENDER_MESH_H_
