#ifndef CLEAVE_CORE_MESH_DELAUNAY_H_
#define CLEAVE_CORE_MESH_DELAUNAY_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// Tets of positive volume that fill the convex hull of the points, none with another point inside
// its circumscribed sphere. Points equal on a grid of 2^23 steps along the longest side are taken
// once. Fewer than four points, or all on a plane, give no tets. Coordinates must be finite.
//
// Incremental insertion after Bowyer (1981) and Watson (1981) in a biased randomised order (Amenta,
// Choi and Rote 2003), with a vertex at infinity so that hull and inside are one case. Predicates
// are exact on the grid: a filtered double evaluation, then 128-bit integers. Cospherical points
// are told apart by tiny weights, as in a regular triangulation, so no flat tet is ever made.
std::vector<std::array<int32_t, 4>> DelaunayTets(const std::vector<Vec3>& points);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_DELAUNAY_H_
