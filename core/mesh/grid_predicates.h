#ifndef CLEAVE_CORE_MESH_GRID_PREDICATES_H_
#define CLEAVE_CORE_MESH_GRID_PREDICATES_H_

#include <cstdint>

namespace cleave {

// A point of an integer grid, coordinates in [0, 2^23), with a small weight in [0, 256). Held as
// doubles, which represent them exactly.
struct GridPoint {
  double x, y, z;
  double weight;
};

// The sign of the volume of the tet (a, b, c, d), exactly.
int Orientation(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d);

// 1 when p lies within the circumscribed sphere of the tet (a, b, c, d) of positive volume, -1
// outside, 0 on it; exactly. With weights: the sign of p's power with respect to the orthogonal
// sphere.
int InSphere(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d,
             const GridPoint& p);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_GRID_PREDICATES_H_
