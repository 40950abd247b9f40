#include "core/stream/continuation_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace cleave {
namespace {

Double4 Residual(const DetailSample& sample, const Continuation& by) {
  const Double4 guess = Splat(by.last) * sample.last + Splat(by.before) * sample.before +
                        Splat(by.rest) * sample.rest;
  return (sample.wanted - guess * (1.0 / kContinuationOne)) * (1.0 / kUnitsPerStep);
}

// About log2(1 + |2 r|) bits for each residual r in steps: linear between powers of two, which is
// what the bit pattern of a double is.
double Cost(std::span<const DetailSample> samples, const Continuation& by) {
  constexpr int64_t kPatternOfOne = int64_t{1023} << 52;
  constexpr int kSpare = 12;  // bits, so that a sum does not overflow
  Int64x4 bits{};
  for (const DetailSample& sample : samples) {
    const Double4 size = 1.0 + Abs(2 * Residual(sample, by));
    bits += (reinterpret_cast<Int64x4>(size) - kPatternOfOne) >> kSpare;
  }
  return 0x1p-40 * static_cast<double>(bits[0] + bits[1] + bits[2] + bits[3]);
}

int32_t Rounded(double value) {
  return static_cast<int32_t>(std::floor(
      std::clamp(value * kContinuationOne, -1.0 * kMaxContinuation, 1.0 * kMaxContinuation) + 0.5));
}

// Least squares in which a sample counts less the farther `by` misses it.
Continuation Refine(std::span<const DetailSample> samples, const Continuation& by) {
  std::array<std::array<Double4, 4>, 3> sums{};
  for (const DetailSample& sample : samples) {
    const Double4 miss = Residual(sample, by);
    const Double4 weight = 1 / (1 + miss * miss);
    const std::array<Double4, 4> row = {sample.last, sample.before, sample.rest, sample.wanted};
    for (size_t i = 0; i < 3; ++i) {
      for (size_t j = i; j < 4; ++j) sums[i][j] += weight * row[i] * row[j];
    }
  }
  std::array<std::array<double, 4>, 3> normal{};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = i; j < 4; ++j) normal[i][j] = Sum(sums[i][j]);
    for (size_t j = 0; j < i; ++j) normal[i][j] = normal[j][i];
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
