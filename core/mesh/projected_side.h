#ifndef CLEAVE_CORE_MESH_PROJECTED_SIDE_H_
#define CLEAVE_CORE_MESH_PROJECTED_SIDE_H_

#include "core/base/vec3.h"

namespace cleave {

// Seen along `direction`, on which side of the line from a to b the point c lies: the sign of
// det(b - a, direction, c - a), exactly for any finite doubles whose products neither overflow nor
// underflow. 0: on the line, or a and b look like one point. Source: Shewchuk, "Adaptive Precision
// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.
int ProjectedSide(const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c);

// Whether the segment from `first` to `second` crosses the curtain that the segment from `start` to
// `end` draws along `direction`, without end to both sides. The curtain's two borders belong to it.
// A point of the curtain counts as one on its side of sign +1: what only touches it from there, or
// lies in it, does not cross; what touches it from the other side does. So a curtain through nodes
// crosses the edges on one side of them and not those on both.
bool CrossesCurtain(const Vec3& direction, const Vec3& start, const Vec3& end, const Vec3& first,
                    const Vec3& second);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_PROJECTED_SIDE_H_
