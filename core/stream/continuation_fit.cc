#include "core/stream/continuation_fit.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace cleave {
namespace {

// About log2(1 + |r|) bits for a residual of so many steps: linear between powers of two.
double Bits(double residual) {
  const auto pattern = std::bit_cast<uint64_t>(1.0 + std::abs(residual));
  return static_cast<double>(pattern) * 0x1p-52 - 1023.0;
}

double Residual(const DetailSample& sample, size_t axis, const Continuation& by) {
  const auto& details = sample.details;
  const double guess = static_cast<double>(by.last) * details.last[axis] +
                       static_cast<double>(by.before) * details.before[axis] +
                       static_cast<double>(by.rest) * details.rest[axis];
  return (sample.wanted[axis] - guess / kContinuationOne) / kUnitsPerStep;
}

double Cost(std::span<const DetailSample> samples, const Continuation& by) {
  double bits = 0;
  for (const DetailSample& sample : samples) {
    for (size_t axis = 0; axis < 3; ++axis) bits += Bits(2 * Residual(sample, axis, by));
  }
  return bits;
}

int32_t Rounded(double value) {
  return static_cast<int32_t>(std::floor(
      std::clamp(value * kContinuationOne, -1.0 * kMaxContinuation, 1.0 * kMaxContinuation) + 0.5));
}

// Least squares in which a sample counts less the farther `by` misses it.
Continuation Refine(std::span<const DetailSample> samples, const Continuation& by) {
  std::array<std::array<double, 4>, 3> normal{};
  for (const DetailSample& sample : samples) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const double miss = Residual(sample, axis, by);
      const double weight = 1 / (1 + miss * miss);
      const std::array<double, 4> row = {static_cast<double>(sample.details.last[axis]),
                                         static_cast<double>(sample.details.before[axis]),
                                         static_cast<double>(sample.details.rest[axis]),
                                         sample.wanted[axis]};
      for (size_t i = 0; i < 3; ++i) {
        for (size_t j = 0; j < 4; ++j) normal[i][j] += weight * row[i] * row[j];
      }
    }
  }
  const double damping =
      1 + 1e-6 * std::max({normal[0][0], normal[1][1], normal[2][2]});  // where details are alike
  const std::array<int32_t, 3> guess = {by.last, by.before, by.rest};
  for (size_t i = 0; i < 3; ++i) {
    normal[i][i] += damping;
    normal[i][3] += damping * guess[i] / kContinuationOne;
  }
  for (size_t i = 0; i < 3; ++i) {
    for (size_t row = i + 1; row < 3; ++row) {
      const double factor = normal[row][i] / normal[i][i];
      for (size_t j = i; j < 4; ++j) normal[row][j] -= factor * normal[i][j];
    }
  }
  std::array<double, 3> solution{};
  for (size_t i = 3; i-- > 0;) {
    double value = normal[i][3];
    for (size_t j = i + 1; j < 3; ++j) value -= normal[i][j] * solution[j];
    solution[i] = value / normal[i][i];
    if (!std::isfinite(solution[i])) return by;
  }
  return {Rounded(solution[0]), Rounded(solution[1]), Rounded(solution[2])};
}

}  // namespace

Continuation FitContinuation(std::span<const DetailSample> samples) {
  constexpr double kListedBits = 48;  // that a continuation costs beyond one with a name
  Continuation best = kNamedContinuations[0];
  if (samples.empty()) return best;
  double least = Cost(samples, best);
  for (const Continuation& by : kNamedContinuations) {
    const double cost = Cost(samples, by);
    if (cost < least) {
      least = cost;
      best = by;
    }
  }
  Continuation refined = best;
  for (int round = 0; round < 2; ++round) {
    refined = Refine(samples, refined);
    const double cost = Cost(samples, refined);
    if (cost + kListedBits < least) {
      least = cost + kListedBits;
      best = refined;
    }
  }
  return best;
}

}  // namespace cleave
