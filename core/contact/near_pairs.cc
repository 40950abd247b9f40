#include "core/contact/near_pairs.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace cleave {
namespace {

// Beyond it cells have no neighbours that a double tells apart.
constexpr double kFurthestCell = 1e15;

}  // namespace

size_t NearPairs::Bucket(const Cell& cell) const {
  const uint64_t hash = static_cast<uint64_t>(cell[0]) * 73856093u ^
                        static_cast<uint64_t>(cell[1]) * 19349663u ^
                        static_cast<uint64_t>(cell[2]) * 83492791u;
  return static_cast<size_t>(hash & (begin_.size() - 2));
}

const std::vector<std::pair<int32_t, int32_t>>& NearPairs::Find(
    const std::vector<Eigen::Vector3d>& points, const std::vector<int32_t>& groups, double reach) {
  pairs_.clear();
  const size_t count = points.size();
  cells_.resize(count);
  begin_.assign(std::bit_ceil(std::max<size_t>(count, 1)) + 1, 0);
  const auto takes_part = [&](size_t i) {
    return groups[i] >= 0 && (points[i].cwiseAbs().array() < kFurthestCell * reach).all();
  };
  for (size_t i = 0; i < count; ++i) {
    if (!takes_part(i)) continue;
    for (int axis = 0; axis < 3; ++axis)
      cells_[i][axis] = static_cast<int64_t>(std::floor(points[i][axis] / reach));
    ++begin_[Bucket(cells_[i]) + 1];
  }
  for (size_t bucket = 1; bucket < begin_.size(); ++bucket) begin_[bucket] += begin_[bucket - 1];
  items_.resize(static_cast<size_t>(begin_.back()));
  std::vector<int32_t> next(begin_.begin(), begin_.end() - 1);
  for (size_t i = 0; i < count; ++i) {
    if (!takes_part(i)) continue;
    items_[static_cast<size_t>(next[Bucket(cells_[i])]++)] = static_cast<int32_t>(i);
  }
  const double squared_reach = reach * reach;
  for (size_t i = 0; i < count; ++i) {
    if (!takes_part(i)) continue;
    const size_t first = pairs_.size();
    for (int k = 0; k < 27; ++k) {
      const Cell cell = cells_[i] + Cell(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      const size_t bucket = Bucket(cell);
      for (int32_t item = begin_[bucket]; item < begin_[bucket + 1]; ++item) {
        const auto j = static_cast<size_t>(items_[static_cast<size_t>(item)]);
        if (j <= i || groups[j] == groups[i] || cells_[j] != cell) continue;
        if ((points[i] - points[j]).squaredNorm() > squared_reach) continue;
        pairs_.push_back({static_cast<int32_t>(i), static_cast<int32_t>(j)});
      }
    }
    std::sort(pairs_.begin() + static_cast<std::ptrdiff_t>(first), pairs_.end());
  }
  return pairs_;
}

int64_t NearPairs::bytes() const {
  return static_cast<int64_t>(cells_.capacity() * sizeof(Cell) +
                              (begin_.capacity() + items_.capacity()) * sizeof(int32_t) +
                              pairs_.capacity() * sizeof(pairs_[0]));
}

}  // namespace cleave
