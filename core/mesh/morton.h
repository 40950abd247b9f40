#ifndef CLEAVE_CORE_MESH_MORTON_H_
#define CLEAVE_CORE_MESH_MORTON_H_

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// The Morton (Z-order) curve through a cube over the points' bounding box, 2^21 steps a side.
class MortonCurve {
 public:
  // Precondition: coordinates are finite.
  explicit MortonCurve(const std::vector<Vec3>& points) {
    low_.fill(std::numeric_limits<double>::infinity());
    Vec3 high;
    high.fill(-std::numeric_limits<double>::infinity());
    for (const Vec3& point : points) {
      for (size_t axis = 0; axis < 3; ++axis) {
        low_[axis] = std::min(low_[axis], point[axis]);
        high[axis] = std::max(high[axis], point[axis]);
      }
    }
    side_ = std::max({high[0] - low_[0], high[1] - low_[1], high[2] - low_[2],
                      std::numeric_limits<double>::min()});
  }

  // The place on the curve of a point within the box.
  uint64_t CodeOf(const Vec3& point) const {
    uint64_t code = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double step = (point[axis] - low_[axis]) / side_ * 0x1FFFFF;
      code |= Spread(static_cast<uint64_t>(std::clamp(step, 0.0, double{0x1FFFFF}))) << axis;
    }
    return code;
  }

  // The low 21 bits of `x`, two zero bits between each.
  static uint64_t Spread(uint64_t x) {
    x &= 0x1FFFFF;
    x = (x | x << 32) & 0x1F00000000FFFFu;
    x = (x | x << 16) & 0x1F0000FF0000FFu;
    x = (x | x << 8) & 0x100F00F00F00F00Fu;
    x = (x | x << 4) & 0x10C30C30C30C30C3u;
    x = (x | x << 2) & 0x1249249249249249u;
    return x;
  }

  // The reverse of Spread: every third bit of `x`.
  static uint64_t Compact(uint64_t x) {
    x &= 0x1249249249249249u;
    x = (x | x >> 2) & 0x10C30C30C30C30C3u;
    x = (x | x >> 4) & 0x100F00F00F00F00Fu;
    x = (x | x >> 8) & 0x1F0000FF0000FFu;
    x = (x | x >> 16) & 0x1F00000000FFFFu;
    return (x | x >> 32) & 0x1FFFFF;
  }

 private:
  Vec3 low_;
  double side_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_MORTON_H_
