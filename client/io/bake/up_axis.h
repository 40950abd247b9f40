#ifndef CLEAVE_CLIENT_IO_BAKE_UP_AXIS_H_
#define CLEAVE_CLIENT_IO_BAKE_UP_AXIS_H_

#include <array>
#include <cmath>

#include "core/base/vec3.h"

namespace cleave {

// The rotation that takes `up`, any length but 0, to y: a unit quaternion x, y, z, w.
inline std::array<double, 4> RotationToY(const Vec3& up) {
  const double length = std::hypot(up[0], up[1], up[2]);
  const double w = 1 + up[1] / length;
  if (w < 1e-12) return {1, 0, 0, 0};  // down: half a turn about x
  // The cross product of up and y, and 1 plus their dot product, normalised.
  const double x = -up[2] / length;
  const double z = up[0] / length;
  const double norm = std::sqrt(x * x + z * z + w * w);
  return {x / norm, 0, z / norm, w / norm};
}

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_BAKE_UP_AXIS_H_
