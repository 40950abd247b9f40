#ifndef CLEAVE_CORE_BASE_LANES_H_
#define CLEAVE_CORE_BASE_LANES_H_

#include <cstdint>

#include "core/base/double4.h"

namespace cleave {

// Eight floats that one instruction works on: the same quantity of eight tets. Operators are as
// those of Double4. Constants in code for either type must be exact in float, or go through Splat.
typedef float Float8 __attribute__((vector_size(32)));
typedef int32_t Int32x8 __attribute__((vector_size(32)));

// What code that is written for batches of either precision asks of T, Double4 or Float8.
template <typename T>
struct Lanes;

template <>
struct Lanes<Double4> {
  using Scalar = double;
  using Mask = Int64x4;
  static constexpr int kCount = 4;
  static constexpr double kRounding = 0x1.0p-53;  // largest relative error of one operation
  static constexpr double kTiny = 1e-300;         // its inverse is finite
};

template <>
struct Lanes<Float8> {
  using Scalar = float;
  using Mask = Int32x8;
  static constexpr int kCount = 8;
  static constexpr double kRounding = 0x1.0p-24;
  static constexpr double kTiny = 1e-37;
};

// One value in every lane.
template <typename T>
T Splat(double value) {
  return T{} + static_cast<typename Lanes<T>::Scalar>(value);
}

inline Float8 Sqrt(Float8 v) {
#ifdef __AVX__
  return reinterpret_cast<Float8>(_mm256_sqrt_ps(reinterpret_cast<__m256>(v)));
#else
  for (int lane = 0; lane < 8; ++lane) v[lane] = __builtin_sqrtf(v[lane]);
  return v;
#endif
}

inline Float8 Max(Float8 a, Float8 b) { return a > b ? a : b; }
inline Float8 Abs(Float8 v) { return v < 0 ? -v : v; }

inline Float4 LowHalf(Float8 v) { return Float4{v[0], v[1], v[2], v[3]}; }
inline Float4 HighHalf(Float8 v) { return Float4{v[4], v[5], v[6], v[7]}; }
inline Float8 Join(Float4 low, Float4 high) {
  return Float8{low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]};
}

// Adds halves up, in double, to four lanes.
inline Double4 Fold(Double4 v) { return v; }
inline Double4 Fold(Float8 v) { return Widen(LowHalf(v)) + Widen(HighHalf(v)); }

// Transpose of double4.h, of the low halves and of the high ones.
inline void Transpose(Float8& a, Float8& b, Float8& c, Float8& d) {
  const Float8 ac_low = __builtin_shufflevector(a, c, 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 ac_high = __builtin_shufflevector(a, c, 2, 10, 3, 11, 6, 14, 7, 15);
  const Float8 bd_low = __builtin_shufflevector(b, d, 0, 8, 1, 9, 4, 12, 5, 13);
  const Float8 bd_high = __builtin_shufflevector(b, d, 2, 10, 3, 11, 6, 14, 7, 15);
  a = __builtin_shufflevector(ac_low, bd_low, 0, 8, 1, 9, 4, 12, 5, 13);
  b = __builtin_shufflevector(ac_low, bd_low, 2, 10, 3, 11, 6, 14, 7, 15);
  c = __builtin_shufflevector(ac_high, bd_high, 0, 8, 1, 9, 4, 12, 5, 13);
  d = __builtin_shufflevector(ac_high, bd_high, 2, 10, 3, 11, 6, 14, 7, 15);
}

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_LANES_H_
