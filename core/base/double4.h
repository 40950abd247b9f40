#ifndef CLEAVE_CORE_BASE_DOUBLE4_H_
#define CLEAVE_CORE_BASE_DOUBLE4_H_

#include <cstdint>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

namespace cleave {

// Four doubles that one instruction works on: the same quantity of four tets, or the three
// coordinates of a node and a lane that holds 0. The arithmetic operators and [] are the
// compiler's. A comparison gives an Int64x4 of all ones or zeros, which `mask ? a : b` takes.
typedef double Double4 __attribute__((vector_size(32)));
typedef int64_t Int64x4 __attribute__((vector_size(32)));
typedef float Float4 __attribute__((vector_size(16)));

inline Double4 Splat(double value) { return Double4{value, value, value, value}; }

inline Double4 Sqrt(Double4 v) {
#ifdef __AVX__
  return reinterpret_cast<Double4>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(v)));
#else
  return Double4{__builtin_sqrt(v[0]), __builtin_sqrt(v[1]), __builtin_sqrt(v[2]),
                 __builtin_sqrt(v[3])};
#endif
}

inline Double4 Max(Double4 a, Double4 b) { return a > b ? a : b; }
inline Double4 Abs(Double4 v) { return v < 0 ? -v : v; }
inline double Sum(Double4 v) { return (v[0] + v[1]) + (v[2] + v[3]); }
inline double Dot(Double4 a, Double4 b) { return Sum(a * b); }
inline Double4 Cross(Double4 a, Double4 b) {
  return Double4{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0],
                 0};
}
// Of what a comparison gave, which compilers have different names for.
template <typename Mask>
requires(sizeof(Mask) == sizeof(Int64x4)) bool Any(Mask mask) {
#ifdef __AVX__
  const auto bits = reinterpret_cast<__m256i>(mask);
  return _mm256_testz_si256(bits, bits) == 0;
#else
  const auto bits = reinterpret_cast<Int64x4>(mask);
  return (bits[0] | bits[1] | bits[2] | bits[3]) != 0;
#endif
}

// Four floats from anywhere in memory.
inline Float4 LoadFloat4(const float* source) {
  Float4 narrow;
  std::memcpy(&narrow, source, sizeof(narrow));
  return narrow;
}

// The compiler's own conversions go through two halves.
inline Double4 Widen(Float4 narrow) {
#ifdef __AVX__
  return reinterpret_cast<Double4>(_mm256_cvtps_pd(reinterpret_cast<__m128>(narrow)));
#else
  return __builtin_convertvector(narrow, Double4);
#endif
}
inline Float4 Narrow(Double4 wide) {
#ifdef __AVX__
  return reinterpret_cast<Float4>(_mm256_cvtpd_ps(reinterpret_cast<__m256d>(wide)));
#else
  return __builtin_convertvector(wide, Float4);
#endif
}
inline Double4 LoadFloats(const float* source) { return Widen(LoadFloat4(source)); }

// One lane in all four.
template <int kLane>
Double4 SplatLane(Double4 v) {
  return __builtin_shufflevector(v, v, kLane, kLane, kLane, kLane);
}

template <int kLane>
Float4 SplatLane(Float4 v) {
  return __builtin_shufflevector(v, v, kLane, kLane, kLane, kLane);
}

// a * b + c, rounded once where the processor can: the same bits for every run of a build.
inline Double4 MultiplyAdd(Double4 a, Double4 b, Double4 c) {
#ifdef __FMA__
  return reinterpret_cast<Double4>(_mm256_fmadd_pd(
      reinterpret_cast<__m256d>(a), reinterpret_cast<__m256d>(b), reinterpret_cast<__m256d>(c)));
#else
  return a * b + c;
#endif
}
inline Float4 MultiplyAdd(Float4 a, Float4 b, Float4 c) {
#ifdef __FMA__
  return reinterpret_cast<Float4>(_mm_fmadd_ps(
      reinterpret_cast<__m128>(a), reinterpret_cast<__m128>(b), reinterpret_cast<__m128>(c)));
#else
  return a * b + c;
#endif
}

// The square of sixteen numbers whose rows are given, turned about its diagonal: what was lane k of
// row l becomes lane l of row k.
inline void Transpose(Double4& a, Double4& b, Double4& c, Double4& d) {
  const Double4 ac_low = __builtin_shufflevector(a, c, 0, 4, 1, 5);
  const Double4 ac_high = __builtin_shufflevector(a, c, 2, 6, 3, 7);
  const Double4 bd_low = __builtin_shufflevector(b, d, 0, 4, 1, 5);
  const Double4 bd_high = __builtin_shufflevector(b, d, 2, 6, 3, 7);
  a = __builtin_shufflevector(ac_low, bd_low, 0, 4, 1, 5);
  b = __builtin_shufflevector(ac_low, bd_low, 2, 6, 3, 7);
  c = __builtin_shufflevector(ac_high, bd_high, 0, 4, 1, 5);
  d = __builtin_shufflevector(ac_high, bd_high, 2, 6, 3, 7);
}

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_DOUBLE4_H_
