#ifndef CLEAVE_CORE_MATERIAL_PLASTICITY_H_
#define CLEAVE_CORE_MATERIAL_PLASTICITY_H_

#include <cmath>

#include "core/base/double4.h"
#include "core/base/matrix3.h"
#include "core/material/isotropic_stiffness.h"
#include "core/material/moduli.h"

// Plastic flow of isotropic solids: F = F_e F_p with det F_p = 1, the elastic law in F_e, the yield
// surface of von Mises in Kirchhoff stress, isotropic hardening and a viscous delay. With
// F_e = U diag(s) V^T, ln s = m + e (mean and deviator), principal stresses t_i = s_i dpsi/ds_i and
// q = sqrt(3/2) |dev t|, the return from q > Y = yield_stress + hardening * strain shrinks e to r
// e:
//
//   q(exp(m + r e)) = Y(strain + sqrt(2/3) (1 - r) |e|),   r <- r + (1 - r) exp(-flow_rate dt)
//
// Volume stays, and rotations change nothing. Source: method note, section 6.

namespace cleave {

// Singular values of F_e below this are crushed, not flowing.
inline constexpr double kLeastFlowingStretch = 0.05;
// No tet flows to where the singular values of F_p are further apart.
inline constexpr double kLargestPlasticRatio = 100;
// Overstress, relative to the yield stress, that is put down to rounding.
inline constexpr double kYieldRounding = 1e-10;

// How four tets yield; T is double or Double4.
template <typename T>
struct FlowRule {
  T yield_stress;  // Pa, > 0
  T hardening;     // Pa per equivalent plastic strain, >= 0
  T relaxation;    // flow_rate dt: a share exp(-relaxation) of the overstress outlives the step
};

// What four tets do; in lanes that do not flow all is 0.
struct PlasticReturn {
  Matrix3<Double4> change;  // R - I, symmetric: F_e <- F_e R, F_p^-1 <- F_p^-1 R
  Double4 strain;           // by which the equivalent plastic strain grows
};

namespace plasticity_internal {

// q of principal Kirchhoff stresses, Pa.
inline Double4 VonMises(const Double4 t[3]) {
  const Double4 a = t[0] - t[1], b = t[1] - t[2], c = t[2] - t[0];
  return Sqrt(0.5 * (a * a + b * b + c * c));
}

inline Double4 Expm1(Double4 v) {
  return Double4{std::expm1(v[0]), std::expm1(v[1]), std::expm1(v[2]), std::expm1(v[3])};
}
inline Double4 Log1p(Double4 v) {
  return Double4{std::log1p(v[0]), std::log1p(v[1]), std::log1p(v[2]), std::log1p(v[3])};
}

// q at logarithmic principal strains, Pa.
template <typename Law>
Double4 VonMisesAt(const Double4 log_stretch[3], const LameConstants<Double4>& lame) {
  Matrix3<Double4> g;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) g(i, j) = Splat(0);
    g(i, i) = Expm1(log_stretch[i]);
  }
  const Matrix3<Double4> stress = Law::Stress(g, Law::KinematicsOf(g), lame);
  Double4 t[3];
  for (int i = 0; i < 3; ++i) t[i] = stress(i, i) * (1.0 + g(i, i));
  return VonMises(t);
}

}  // namespace plasticity_internal

// Von Mises stress of the Kirchhoff stress P F^T, Pa, from P and G = F - I. Needs no singular
// values, so that elastic tets pay little.
inline Double4 VonMisesStress(const Matrix3<Double4>& stress, const Matrix3<Double4>& g) {
  Double4 diagonal[3], off[3];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    diagonal[i] = off[i] = Splat(0);
    for (int k = 0; k < 3; ++k) {
      diagonal[i] += stress(i, k) * g(i, k);
      off[i] += stress(i, k) * g(j, k);
    }
    diagonal[i] += stress(i, i);
    off[i] += stress(i, j);
  }
  const Double4 q = plasticity_internal::VonMises(diagonal);
  return Sqrt(q * q + 3.0 * (off[0] * off[0] + off[1] * off[1] + off[2] * off[2]));
}

// The return of four tets whose elastic deformation is I + G and whose equivalent plastic strain is
// `strain`. Tets that are below yield, inverted or crushed below kLeastFlowingStretch keep what
// they have, as do those that are not finite.
template <typename Law>
PlasticReturn ReturnToYield(const Matrix3<Double4>& g, const LameConstants<Double4>& lame,
                            const FlowRule<Double4>& rule, Double4 strain) {
  using plasticity_internal::VonMisesAt;
  PlasticReturn result;
  result.strain = Splat(0);
  for (int k = 0; k < 9; ++k) result.change(k / 3, k % 3) = Splat(0);
  const Double4 yield = rule.yield_stress + rule.hardening * strain;
  Int64x4 flows = VonMisesStress(Law::Stress(g, Law::KinematicsOf(g), lame), g) >
                  (1.0 + kYieldRounding) * yield;
  if (!Any(flows)) return result;
  const auto svd = ComputeSvd(g);
  flows = flows & (svd.s[2] >= kLeastFlowingStretch);
  if (!Any(flows)) return result;

  Double4 e[3], m = Splat(0), norm = Splat(0);
  for (int k = 0; k < 3; ++k) {
    e[k] = plasticity_internal::Log1p(flows ? svd.strain[k] : Splat(0));
    m += e[k] / 3.0;
  }
  for (int k = 0; k < 3; ++k) {
    e[k] -= m;
    norm += e[k] * e[k];
  }
  norm = Sqrt(2.0 / 3.0 * norm);
  // How far a share r of the deviator lies above yield: falls to below 0 at r = 0.
  const auto excess_at = [&](Double4 r) {
    const Double4 log_stretch[3] = {m + r * e[0], m + r * e[1], m + r * e[2]};
    return VonMisesAt<Law>(log_stretch, lame) - (yield + rule.hardening * ((1.0 - r) * norm));
  };
  // Bisection that guesses by the secant and halves every third time.
  constexpr int kMaxIterations = 160;
  constexpr double kNarrow = 1e-15;
  Double4 low = Splat(0), high = flows ? Splat(1) : Splat(0);
  Double4 low_excess = -(yield + rule.hardening * norm), high_excess = excess_at(Splat(1));
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Int64x4 open = high - low > kNarrow;
    if (!Any(open)) break;
    const Double4 slope = high_excess - low_excess;
    const Double4 half = 0.5 * (low + high);
    const Double4 secant = low - low_excess * (high - low) / (slope > 0 ? slope : Splat(1));
    const Int64x4 inside = (secant > low) & (secant < high) & (slope > 0);
    const Double4 r = iteration % 3 == 2 ? half : (inside ? secant : half);
    const Double4 excess = excess_at(r);
    const Int64x4 above = open & (excess > 0), below = open & ~above;
    // Of an end that stays the value is halved, so that it does not stay for ever (Illinois).
    high_excess = above ? excess : (below ? 0.5 * high_excess : high_excess);
    low_excess = below ? excess : (above ? 0.5 * low_excess : low_excess);
    high = above ? r : high;
    low = below ? r : low;
    // As near as rounding shows.
    const Int64x4 met = below & (excess > -1e-2 * kYieldRounding * yield);
    high = met ? low : high;
  }
  const Double4 retained = 1.0 + plasticity_internal::Expm1(-rule.relaxation);
  const Double4 r = low + (1.0 - low) * retained;
  Double4 stretch[3];  // exp((r - 1) e) - 1
  for (int k = 0; k < 3; ++k) stretch[k] = plasticity_internal::Expm1((r - 1.0) * e[k]);
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const Double4 entry = svd.v(i, 0) * stretch[0] * svd.v(j, 0) +
                            svd.v(i, 1) * stretch[1] * svd.v(j, 1) +
                            svd.v(i, 2) * stretch[2] * svd.v(j, 2);
      result.change(i, j) = result.change(j, i) = flows ? entry : Splat(0);
    }
  }
  result.strain = flows ? (1.0 - r) * norm : Splat(0);
  return result;
}

// F_p^-1 - I after a return, from that before it: (I + B) R - I, scaled to determinant 1 against
// the drift of rounding.
inline Matrix3<Double4> FlowedInverse(const Matrix3<Double4>& b, const PlasticReturn& flow) {
  Matrix3<Double4> next = b * flow.change;
  for (int k = 0; k < 9; ++k) next(k / 3, k % 3) += b(k / 3, k % 3) + flow.change(k / 3, k % 3);
  const Matrix3<Double4> cofactor = Cofactor(next);
  const Double4 growth = Trace(next) + Trace(cofactor) +
                         (next(0, 0) * cofactor(0, 0) + next(0, 1) * cofactor(0, 1) +
                          next(0, 2) * cofactor(0, 2));  // det - 1
  const Double4 shrink = plasticity_internal::Expm1(plasticity_internal::Log1p(growth) / -3.0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) next(i, j) += shrink * next(i, j);
    next(i, i) += shrink;
  }
  return next;
}

// Whether the singular values of F_p, from B = F_p^-1 - I, lie within kLargestPlasticRatio of each
// other and are finite.
inline Int64x4 IsWithinPlasticRatio(const Matrix3<Double4>& b) {
  const auto svd = ComputeSvd(b);
  return svd.s[0] <= kLargestPlasticRatio * svd.s[2];
}

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_PLASTICITY_H_
