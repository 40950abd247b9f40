#include "core/mesh/coincident_nodes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>

namespace cleave {
namespace {

using Cell = std::array<int64_t, 3>;

uint64_t HashOf(const Cell& cell) {
  uint64_t hash = 0;
  for (const int64_t index : cell) {
    hash = (hash ^ static_cast<uint64_t>(index)) * 0x9E3779B97F4A7C15u;
    hash ^= hash >> 29;
  }
  return hash;
}

bool Finite(const Vec3& p) {
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

// Nodes filed by grid cell, in an open-addressed table of their hashes. Only nodes that lie on no
// earlier one are filed, so a cell a few tolerances wide holds a bounded number.
class Grid {
 public:
  Grid(const std::vector<Vec3>& positions, double tolerance)
      : positions_(positions),
        tolerance_(tolerance),
        slots_(std::bit_ceil(2 * positions.size() + 2), -1) {}

  // Whether an earlier node lies within the tolerance; files the node if none does.
  bool FindOrFile(int32_t node) {
    const Vec3& p = positions_[static_cast<size_t>(node)];
    const Cell low = CellOf({p[0] - tolerance_, p[1] - tolerance_, p[2] - tolerance_});
    const Cell high = CellOf({p[0] + tolerance_, p[1] + tolerance_, p[2] + tolerance_});
    for (int64_t x = low[0]; x <= high[0]; ++x) {
      for (int64_t y = low[1]; y <= high[1]; ++y) {
        for (int64_t z = low[2]; z <= high[2]; ++z) {
          if (Find(p, {x, y, z})) return true;
        }
      }
    }
    size_t slot = HashOf(CellOf(p)) & (slots_.size() - 1);
    while (slots_[slot] >= 0) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = node;
    return false;
  }

 private:
  Cell CellOf(const Vec3& p) const {
    const double width = 4 * tolerance_;
    return {static_cast<int64_t>(std::floor(p[0] / width)),
            static_cast<int64_t>(std::floor(p[1] / width)),
            static_cast<int64_t>(std::floor(p[2] / width))};
  }
  bool Find(const Vec3& p, const Cell& cell) const {
    for (size_t slot = HashOf(cell) & (slots_.size() - 1); slots_[slot] >= 0;
         slot = (slot + 1) & (slots_.size() - 1)) {
      const Vec3& q = positions_[static_cast<size_t>(slots_[slot])];
      if (std::abs(p[0] - q[0]) <= tolerance_ && std::abs(p[1] - q[1]) <= tolerance_ &&
          std::abs(p[2] - q[2]) <= tolerance_) {
        return true;
      }
    }
    return false;
  }

  const std::vector<Vec3>& positions_;
  const double tolerance_;
  std::vector<int32_t> slots_;
};

}  // namespace

CoincidentNodes FindCoincidentNodes(const std::vector<Vec3>& positions) {
  CoincidentNodes found;
  Vec3 low;
  Vec3 high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Vec3& p : positions) {
    if (!Finite(p)) continue;
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  if (!(low[0] <= high[0])) return found;
  const double side = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  double reach = 0;  // the largest coordinate, which bounds what a difference can resolve
  for (size_t axis = 0; axis < 3; ++axis)
    reach = std::max({reach, std::abs(low[axis]), std::abs(high[axis])});
  // Cells are numbered from the origin: wide enough that their numbers fit and that a tolerance
  // does not vanish beside the coordinate.
  const double tolerance = std::max({1e-9 * side, 1e-15 * reach, 1e-300});
  if (!std::isfinite(tolerance)) return found;

  Grid grid(positions, tolerance);
  for (size_t node = 0; node < positions.size(); ++node) {
    if (!Finite(positions[node]) || !grid.FindOrFile(static_cast<int32_t>(node))) continue;
    if (found.count++ == 0) found.first = static_cast<int64_t>(node);
  }
  return found;
}

}  // namespace cleave
