#ifndef CLEAVE_CORE_PICTURE_SHOWN_SURFACE_H_
#define CLEAVE_CORE_PICTURE_SHOWN_SURFACE_H_

#include <array>
#include <cstdint>
#include <vector>

#include "absl/status/status.h"
#include "core/base/vec3.h"
#include "core/mesh/render_mesh.h"

namespace cleave {

// What there is to see in one frame: the closed surfaces of all pieces, as flat arrays that
// exporters and pictures read. Pieces share no points.
struct ShownSurface {
  int64_t frame = 0;
  double time = 0;           // s
  int64_t broken_edges = 0;  // so far

  std::vector<Vec3> points;                       // m
  std::vector<std::array<int32_t, 3>> triangles;  // point ids, counter-clockwise from outside

  // One a triangle.
  std::vector<int32_t> pieces;   // piece ids, the same in every frame for as long as a piece lives
  std::vector<uint8_t> inside;   // 1: opened by a crack; 0: the body's own surface
  std::vector<int32_t> regions;  // region of the element behind the triangle

  // One a triangle, or empty where unknown.
  std::vector<CornerUvs> uvs;  // texture coordinates; 0 inside, where rest points serve
  // The face behind, 4 * tet + face of the boundary (or the triangle of a render mesh); -1 inside.
  std::vector<int64_t> sources;

  // One a point, or empty where unknown.
  std::vector<float> strains;       // largest principal stretch minus 1
  std::vector<float> damages;       // [0, 1], share of the broken edges of the tets round it
  std::vector<float> potencies;     // alpha of impurities
  std::vector<float> impurities;    // [0, 1], 1 for the worst of the body
  std::vector<Vec3> rest_points;    // m
  std::vector<Vec3> displacements;  // m, from rest
  std::vector<Vec3> velocities;     // m/s
};

// Whether the arrays fit each other, ids are in range and every number is finite. Errors:
// InvalidArgument, naming the array and the first bad item.
absl::Status CheckShownSurface(const ShownSurface& surface);

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_SHOWN_SURFACE_H_
