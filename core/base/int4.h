#ifndef CLEAVE_CORE_BASE_INT4_H_
#define CLEAVE_CORE_BASE_INT4_H_

#include <cstdint>
#include <cstring>

#include "core/base/double4.h"

namespace cleave {

// Four integers that one instruction works on, as Double4.
typedef int32_t Int32x4 __attribute__((vector_size(16)));

inline Double4 Widen(Int32x4 narrow) {
#ifdef __AVX__
  return reinterpret_cast<Double4>(_mm256_cvtepi32_pd(reinterpret_cast<__m128i>(narrow)));
#else
  return __builtin_convertvector(narrow, Double4);
#endif
}
// Of whole numbers that fit.
inline Int32x4 ToInts(Double4 wide) {
#ifdef __AVX__
  return reinterpret_cast<Int32x4>(_mm256_cvttpd_epi32(reinterpret_cast<__m256d>(wide)));
#else
  return __builtin_convertvector(wide, Int32x4);
#endif
}
inline Double4 Floor(Double4 v) {
#ifdef __AVX__
  return reinterpret_cast<Double4>(_mm256_floor_pd(reinterpret_cast<__m256d>(v)));
#else
  return Double4{__builtin_floor(v[0]), __builtin_floor(v[1]), __builtin_floor(v[2]),
                 __builtin_floor(v[3])};
#endif
}
// Bit k is set if lane k is negative.
inline unsigned SignBits(Int32x4 v) {
#ifdef __AVX__
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(v)));
#else
  unsigned bits = 0;
  for (int lane = 0; lane < 4; ++lane) bits |= static_cast<unsigned>(v[lane] < 0) << lane;
  return bits;
#endif
}
// Four integers from anywhere in memory.
inline Int32x4 LoadInts(const int32_t* source) {
  Int32x4 ints;
  std::memcpy(&ints, source, sizeof(ints));
  return ints;
}
inline Double4 Min(Double4 a, Double4 b) { return a < b ? a : b; }

// Each lane times `factor`, without overflow.
inline Int64x4 WideProduct(Int32x4 v, int32_t factor) {
#ifdef __AVX2__
  return reinterpret_cast<Int64x4>(_mm256_mul_epi32(
      _mm256_cvtepi32_epi64(reinterpret_cast<__m128i>(v)), _mm256_set1_epi32(factor)));
#else
  return __builtin_convertvector(v, Int64x4) * factor;
#endif
}
// Lanes below 2^62 in magnitude by 2^kBits, rounded down.
template <int kBits>
Int64x4 ShiftRight(Int64x4 v) {
  typedef uint64_t Uint64x4 __attribute__((vector_size(32)));
  constexpr int64_t kOffset = int64_t{1} << 62;  // as no processor before AVX-512 shifts signs in
  return reinterpret_cast<Int64x4>(reinterpret_cast<Uint64x4>(v + kOffset) >> kBits) -
         (kOffset >> kBits);
}
// Of lanes below 2^51 in magnitude.
inline Double4 ToDoubles(Int64x4 v) {
  // The last bit of a double between 2^52 and 2^53 is worth 1.
  constexpr int64_t kPatternOfOffset = 0x4338000000000000;
  return reinterpret_cast<Double4>(v + kPatternOfOffset) - 0x1.8p52;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_INT4_H_
