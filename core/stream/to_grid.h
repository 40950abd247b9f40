#ifndef CLEAVE_CORE_STREAM_TO_GRID_H_
#define CLEAVE_CORE_STREAM_TO_GRID_H_

#include <cstddef>
#include <cstring>
#include <span>

#include "core/base/double4.h"
#include "core/base/vec3.h"

namespace cleave {

// Positions of nodes in grid units, not rounded.
class ToGrid {
 public:
  ToGrid(std::span<const Vec3> positions, const Vec3& origin, double inverse_unit)
      : positions_(positions),
        corner_{origin[0], origin[1], origin[2], 0},
        scale_{inverse_unit, inverse_unit, inverse_unit, 0} {}

  Double4 operator()(size_t node) const {
    const Vec3& x = positions_[node];
    Double4 position;  // the fourth lane is of the next node, and scaled to zero
    if (node + 1 == positions_.size()) {
      position = Double4{x[0], x[1], x[2], 0};
    } else {
      std::memcpy(&position, &x, sizeof(position));
    }
    return (position - corner_) * scale_;
  }

 private:
  std::span<const Vec3> positions_;
  Double4 corner_;
  Double4 scale_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_TO_GRID_H_
