#ifndef CLEAVE_CORE_DAMAGE_LOAD_CYCLES_H_
#define CLEAVE_CORE_DAMAGE_LOAD_CYCLES_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace cleave {

// Counts the cycles of a stress as it comes, by the rainflow rule of ASTM E1049-85, section 5.4.4:
// a range is a cycle once one as large follows it; one that begins where the history does is half a
// cycle. So ripples on a slow cycle are small cycles of their own and do not cut the slow one up.
//
// Keeps the turning points of ranges that are still open, at most kPoints; beyond that the oldest
// range counts as half a cycle, which is what the standard counts for those left open at the end. A
// stress that only rises counts nothing. History begins at rest. What is counted depends on turning
// points only, not on how many samples lie between them.
class LoadCycles {
 public:
  static constexpr size_t kPoints = 5;
  // Ranges this close are as large: sampling and the solver's residual move peaks by less.
  static constexpr double kAsLarge = 0.99;

  // Calls count(half_cycles, low, high), Pa, for the cycles that `stress` (Pa) ends.
  template <typename Count>
  void Follow(double stress, const Count& count) {
    if (size_ == 1 ||
        (stress - points_[size_ - 1]) * (points_[size_ - 1] - points_[size_ - 2]) < 0) {
      if (stress == points_[size_ - 1]) return;
      if (size_ == kPoints) CloseOldest(count);
      ++size_;
    }
    points_[size_ - 1] = stress;
    while (size_ >= 3) {
      const double open = std::abs(points_[size_ - 1] - points_[size_ - 2]);
      const double before = std::abs(points_[size_ - 2] - points_[size_ - 3]);
      if (!(open >= kAsLarge * before)) return;
      if (size_ == 3) {
        CloseOldest(count);
        return;
      }
      Report(2, points_[size_ - 3], points_[size_ - 2], count);
      points_[size_ - 3] = points_[size_ - 1];
      size_ -= 2;
    }
  }

  // Whether these bytes can be a history.
  bool IsValid() const {
    return size_ >= 1 && size_ <= kPoints &&
           std::all_of(points_.begin(), points_.end(), [](double p) { return std::isfinite(p); });
  }

 private:
  template <typename Count>
  static void Report(int half_cycles, double a, double b, const Count& count) {
    count(half_cycles, std::min(a, b), std::max(a, b));
  }
  template <typename Count>
  void CloseOldest(const Count& count) {
    Report(1, points_[0], points_[1], count);
    std::copy(points_.begin() + 1, points_.end(), points_.begin());
    --size_;
  }

  std::array<double, kPoints> points_{};  // Pa; the last is where the stress is now
  uint64_t size_ = 1;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_LOAD_CYCLES_H_
