#ifndef CLEAVE_CORE_CONTACT_NEAR_PAIRS_H_
#define CLEAVE_CORE_CONTACT_NEAR_PAIRS_H_

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

namespace cleave {

// Finds points of different groups near each other, by a grid of cells. Keeps its memory from call
// to call. Not thread-safe.
class NearPairs {
 public:
  // Pairs of points (i, j), i < j, of different groups, at most `reach` (m) apart; ascending.
  // `points` and `groups` have a record each; points of a negative group take no part.
  // Preconditions: reach is positive and finite. Points that are not finite are near none.
  const std::vector<std::pair<int32_t, int32_t>>& Find(const std::vector<Eigen::Vector3d>& points,
                                                       const std::vector<int32_t>& groups,
                                                       double reach);
  // What the last Find found.
  const std::vector<std::pair<int32_t, int32_t>>& found() const { return pairs_; }

  int64_t bytes() const;

 private:
  using Cell = Eigen::Matrix<int64_t, 3, 1>;

  size_t Bucket(const Cell& cell) const;

  std::vector<Cell> cells_;     // of every point
  std::vector<int32_t> begin_;  // of every bucket in items_, buckets + 1
  std::vector<int32_t> items_;  // points by bucket
  std::vector<std::pair<int32_t, int32_t>> pairs_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_CONTACT_NEAR_PAIRS_H_
