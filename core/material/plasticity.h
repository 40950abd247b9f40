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
// q = sqrt(3/2) |dev t|, the radial return from q > Y = yield_stress + hardening * strain shrinks e
// to r e:
//
//   q(exp(m + r e)) = Y(strain + sqrt(2/3) (1 - r) |e|),   r <- r + (1 - r) exp(-flow_rate dt)
//
// Volume stays, and rotations change nothing. Source: method note, section 6. Bodies flow by the
// minimum of incremental_potential.h, which starts from there.

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

  // Pa, at an equivalent plastic strain.
  T Yield(T strain) const { return yield_stress + hardening * strain; }
  // J/m^3, that slow flow by `more` from there takes.
  T Work(T strain, T more) const { return (Yield(strain) + 0.5 * hardening * more) * more; }
};

// ln s of four tets.
struct LogStrain {
  Double4 mean;
  Double4 deviator[3];
  Double4 equivalent;  // sqrt(2/3) |e|
};

// A law in four tets at the principal stretches 1 + strain, in any order.
template <typename Law>
class PrincipalState {
 public:
  PrincipalState(const Double4 strain[3], const LameConstants<Double4>& lame)
      : svd_(DiagonalSvd(strain)), g_(DiagonalGradient(strain)), kinematics_(KinematicsOf(*this)) {
    const Matrix3<Double4> stress = Law::Stress(g_, kinematics_, lame);
    for (int i = 0; i < 3; ++i) stress_[i] = stress(i, i);
  }

  Double4 Energy(const LameConstants<Double4>& lame) const {  // J/m^3
    return Law::Energy(g_, kinematics_, lame);
  }
  Double4 stretch(int i) const { return svd_.s[i]; }
  Double4 Kirchhoff(int i) const { return svd_.s[i] * stress_[i]; }  // Pa
  Double4 VonMises() const {                                         // Pa
    const Double4 a = Kirchhoff(0) - Kirchhoff(1), b = Kirchhoff(1) - Kirchhoff(2),
                  c = Kirchhoff(2) - Kirchhoff(0);
    return Sqrt(0.5 * (a * a + b * b + c * c));
  }
  // How Kirchhoff stresses follow logarithmic strains, Pa, symmetric.
  void LogTangent(const LameConstants<Double4>& lame, Double4 tangent[3][3]) const {
    const StiffnessSpectrum<Double4> spectrum = Law::Spectrum(svd_, lame);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) tangent[i][j] = svd_.s[i] * svd_.s[j] * spectrum.axial[i][j];
      tangent[i][i] += Kirchhoff(i);
    }
  }

 private:
  static SignedSvd<Double4> DiagonalSvd(const Double4 strain[3]) {
    SignedSvd<Double4> svd;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) svd.u(i, j) = svd.v(i, j) = Splat(i == j ? 1 : 0);
      svd.strain[i] = strain[i];
      svd.s[i] = 1.0 + strain[i];
    }
    return svd;
  }
  static Matrix3<Double4> DiagonalGradient(const Double4 strain[3]) {
    Matrix3<Double4> g;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) g(i, j) = i == j ? strain[i] : Splat(0);
    }
    return g;
  }
  // Laws of singular values take those that are there.
  static auto KinematicsOf(const PrincipalState& state) {
    if constexpr (requires { Law::KinematicsOf(state.svd_); }) {
      return Law::KinematicsOf(state.svd_);
    } else {
      return Law::KinematicsOf(state.g_);
    }
  }
  using Kinematics = decltype(Law::KinematicsOf(Matrix3<Double4>{}));

  SignedSvd<Double4> svd_;
  Matrix3<Double4> g_;
  Kinematics kinematics_;
  Double4 stress_[3];  // dpsi/ds
};

namespace plasticity_internal {

inline Double4 Expm1(Double4 v) {
  return Double4{std::expm1(v[0]), std::expm1(v[1]), std::expm1(v[2]), std::expm1(v[3])};
}
inline Double4 Log1p(Double4 v) {
  return Double4{std::log1p(v[0]), std::log1p(v[1]), std::log1p(v[2]), std::log1p(v[3])};
}

}  // namespace plasticity_internal

// The law at logarithmic principal strains.
template <typename Law>
PrincipalState<Law> StateAt(const Double4 log_strain[3], const LameConstants<Double4>& lame) {
  const Double4 strain[3] = {plasticity_internal::Expm1(log_strain[0]),
                             plasticity_internal::Expm1(log_strain[1]),
                             plasticity_internal::Expm1(log_strain[2])};
  return PrincipalState<Law>(strain, lame);
}

// Of s = 1 + strain > 0.
inline LogStrain LogStrainOf(const Double4 strain[3]) {
  LogStrain log;
  log.mean = Splat(0);
  for (int k = 0; k < 3; ++k) {
    log.deviator[k] = plasticity_internal::Log1p(strain[k]);
    log.mean += log.deviator[k] / 3.0;
  }
  Double4 squares = Splat(0);
  for (int k = 0; k < 3; ++k) {
    log.deviator[k] -= log.mean;
    squares += log.deviator[k] * log.deviator[k];
  }
  log.equivalent = Sqrt(2.0 / 3.0 * squares);
  return log;
}

// Von Mises stress of the Kirchhoff stress P F^T, from P and G = F - I, in the unit of P. Needs no
// singular values, so that elastic tets pay little. T is a batch.
template <typename T>
T VonMisesStress(const Matrix3<T>& stress, const Matrix3<T>& g) {
  T diagonal[3], off[3];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    diagonal[i] = stress(i, i);
    off[i] = stress(i, j);
    for (int k = 0; k < 3; ++k) {
      diagonal[i] += stress(i, k) * g(i, k);
      off[i] += stress(i, k) * g(j, k);
    }
  }
  const T a = diagonal[0] - diagonal[1], b = diagonal[1] - diagonal[2],
          c = diagonal[2] - diagonal[0];
  return Sqrt(0.5 * (a * a + b * b + c * c) +
              3.0 * (off[0] * off[0] + off[1] * off[1] + off[2] * off[2]));
}

// The share r of its deviator that the radial return leaves of a trial strain, to `tolerance` of
// the yield stress; `strain` is the equivalent plastic strain before it. 1 in lanes that do not
// flow. Precondition: those that do are above yield.
template <typename Law>
Double4 RadialShare(const LogStrain& log, const LameConstants<Double4>& lame,
                    const FlowRule<Double4>& rule, Double4 strain, Int64x4 flows,
                    double tolerance) {
  const Double4 yield = rule.Yield(strain);
  // How far a share r of the deviator lies above yield: falls to below 0 at r = 0.
  const auto excess_at = [&](Double4 r) {
    const Double4 at[3] = {log.mean + r * log.deviator[0], log.mean + r * log.deviator[1],
                           log.mean + r * log.deviator[2]};
    return StateAt<Law>(at, lame).VonMises() -
           (yield + rule.hardening * ((1.0 - r) * log.equivalent));
  };
  // Bisection that guesses by the secant and halves every third time; at first, the root for a law
  // of logarithmic strain, and one Newton step from there.
  constexpr int kMaxIterations = 160;
  constexpr double kNarrow = 1e-15;
  const Double4 slope = (3.0 * lame.mu + rule.hardening) * log.equivalent;
  Double4 low = Splat(0), high = flows ? Splat(1) : Splat(0);
  Double4 low_excess = Splat(0), high_excess = Splat(0);
  Double4 guess = (yield + rule.hardening * log.equivalent) / (flows ? slope : Splat(1));
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const Int64x4 open = high - low > kNarrow;
    if (!Any(open)) break;
    const Double4 half = 0.5 * (low + high);
    const Int64x4 inside = (guess > low) & (guess < high);
    const Double4 r = iteration % 3 == 2 ? half : (inside ? guess : half);
    const Double4 excess = excess_at(r);
    const Int64x4 above = open & (excess > 0), below = open & ~above;
    // Of an end that stays the value is halved, so that it does not stay for ever (Illinois).
    high_excess = above ? excess : (below ? 0.5 * high_excess : high_excess);
    low_excess = below ? excess : (above ? 0.5 * low_excess : low_excess);
    high = above ? r : high;
    low = below ? r : low;
    const Int64x4 met = open & (Abs(excess) <= tolerance * yield);
    low = met ? r : low;
    high = met ? r : high;
    const Double4 rise = high_excess - low_excess;
    const Int64x4 both = (high_excess > 0) & (low_excess < 0);
    guess = both ? low - low_excess * (high - low) / (both ? rise : Splat(1))
                 : r - excess / (flows ? slope : Splat(1));
  }
  const Double4 retained = 1.0 + plasticity_internal::Expm1(-rule.relaxation);
  return flows ? low + (1.0 - low) * retained : Splat(1);
}

// R - I, symmetric, of the flow by principal logarithmic strains in the frame V of F_e:
// F_e <- F_e R, F_p^-1 <- F_p^-1 R.
inline Matrix3<Double4> FlowChange(const Matrix3<Double4>& v, const Double4 log_flow[3]) {
  Double4 stretch[3];
  for (int k = 0; k < 3; ++k) stretch[k] = plasticity_internal::Expm1(-log_flow[k]);
  Matrix3<Double4> change;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      change(i, j) = change(j, i) = v(i, 0) * stretch[0] * v(j, 0) +
                                    v(i, 1) * stretch[1] * v(j, 1) + v(i, 2) * stretch[2] * v(j, 2);
    }
  }
  return change;
}

// F_p^-1 - I after a flow by R - I, from that before it: (I + B) R - I, scaled to determinant 1
// against the drift of rounding.
inline Matrix3<Double4> FlowedInverse(const Matrix3<Double4>& b, const Matrix3<Double4>& change) {
  Matrix3<Double4> next = b * change;
  for (int k = 0; k < 9; ++k) next(k / 3, k % 3) += b(k / 3, k % 3) + change(k / 3, k % 3);
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
