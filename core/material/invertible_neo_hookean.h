#ifndef CLEAVE_CORE_MATERIAL_INVERTIBLE_NEO_HOOKEAN_H_
#define CLEAVE_CORE_MATERIAL_INVERTIBLE_NEO_HOOKEAN_H_

#include <cmath>

#include "core/base/matrix3.h"
#include "core/material/isotropic_stiffness.h"
#include "core/material/moduli.h"

namespace cleave {

// The Neo-Hookean solid with a logarithmic barrier against crushing, made finite through inversion:
//
//   psi = mu/2 sum (s_i^2 - 1) - mu sum l(s_i) + lambda/2 (sum l(s_i))^2
//
// where l is ln down to the stretch a = 0.1 and below it the parabola that meets ln with equal
// value, slope and curvature. (Extending l and not clamping s keeps the stress the derivative of
// the energy, which the line search relies on.) The stress kinks where s_i + s_j = 0, deep in
// inversion. Source: method note, section 5.
struct InvertibleNeoHookean {
  static constexpr double kSmallestLogStretch = 0.1;  // a

  struct Kinematics {
    SignedSvd svd;
    Double4 log[3];     // l(s_i)
    Double4 excess[3];  // (s_i - 1) - l(s_i), with its digits at small strains
    Double4 slope[3];   // dl/ds
    Double4 volume;     // sum of l
  };

  static Kinematics KinematicsOf(const Matrix3<Double4>& g) {
    Kinematics kinematics;
    kinematics.svd = ComputeSvd(g);
    SetLogs(kinematics);
    return kinematics;
  }

  // J/m^3.
  static Double4 Energy(const Matrix3<Double4>&, const Kinematics& kinematics,
                        const LameConstants<Double4>& lame) {
    Double4 shear = Splat(0);
    for (int k = 0; k < 3; ++k) {
      const Double4 d = kinematics.svd.strain[k];
      shear += kinematics.excess[k] + 0.5 * d * d;
    }
    return lame.mu * shear + 0.5 * lame.lambda * kinematics.volume * kinematics.volume;
  }

  // First Piola-Kirchhoff stress, Pa.
  static Matrix3<Double4> Stress(const Matrix3<Double4>&, const Kinematics& kinematics,
                                 const LameConstants<Double4>& lame) {
    Double4 principal[3];
    for (int k = 0; k < 3; ++k) {
      const Double4 d = kinematics.svd.strain[k];
      const Double4 s = kinematics.svd.s[k];
      // s - dl/ds; above a it is s - 1/s.
      const Double4 shear =
          s >= kSmallestLogStretch ? d * (s + 1.0) * kinematics.slope[k] : s - kinematics.slope[k];
      principal[k] = lame.mu * shear + lame.lambda * kinematics.volume * kinematics.slope[k];
    }
    return FromPrincipal(kinematics.svd, principal);
  }

  // Second derivative at the singular values, not projected.
  static StiffnessSpectrum Spectrum(const SignedSvd& svd, const LameConstants<Double4>& lame) {
    Kinematics kinematics;
    kinematics.svd = svd;
    SetLogs(kinematics);
    StiffnessSpectrum spectrum;
    const Double4* s = svd.s;
    const Double4* slope = kinematics.slope;
    const Double4 a = Splat(kSmallestLogStretch);
    const Double4 bend = 1.0 / (a * a);
    const Double4 c = lame.lambda * kinematics.volume - lame.mu;
    const Double4 cap = bend * SkewStiffnessCap(lame);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const Double4 above = Max(s[k], a);
      spectrum.axial[k][k] = lame.mu - c / (above * above) + lame.lambda * slope[k] * slope[k];
      spectrum.axial[i][j] = spectrum.axial[j][i] = lame.lambda * slope[i] * slope[j];
      // The slope of l between s_i and s_j falls by 1/(s s') above a and by 1/a^2 below it.
      const Double4 above_i = Max(s[i], a), above_j = Max(s[j], a);
      const Double4 gap = s[i] - s[j];
      const Double4 whole = s[i] >= a ? Splat(1) : Splat(0);
      const Double4 share = gap == 0 ? whole : (above_i - above_j) / (gap == 0 ? Splat(1) : gap);
      const Double4 fall = share / (above_i * above_j) + (1.0 - share) * bend;
      spectrum.symmetric[k] = lame.mu - c * fall;
      spectrum.skew[k] = lame.mu + BoundedQuotient(c * (slope[i] + slope[j]), s[i] + s[j], cap);
    }
    return spectrum;
  }

 private:
  static void SetLogs(Kinematics& kinematics) {
    constexpr double a = kSmallestLogStretch;
    const double log_a = std::log(a);
    for (int k = 0; k < 3; ++k) {
      const Double4 d = kinematics.svd.strain[k];
      const Double4 s = kinematics.svd.s[k];
      const Double4 below = (s - a) / a;
      const Int64x4 small = s < a;
      const Double4 logged = small ? Splat(0) : d;
      Double4 log;
      for (int lane = 0; lane < kLanes; ++lane) log[lane] = std::log1p(logged[lane]);
      kinematics.log[k] = small ? log_a + below - 0.5 * below * below : log;
      // Near rest d - ln(1 + d) would cancel; its series to d^8 has 16 digits there.
      const Double4 series =
          d * d *
          (1.0 / 2 -
           d * (1.0 / 3 - d * (1.0 / 4 - d * (1.0 / 5 - d * (1.0 / 6 - d * (1.0 / 7 - d / 8))))));
      kinematics.excess[k] = Abs(d) < 0.005 ? series : d - kinematics.log[k];
      kinematics.slope[k] = small ? (1.0 - below) / a : 1.0 / s;
    }
    kinematics.volume = kinematics.log[0] + kinematics.log[1] + kinematics.log[2];
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_INVERTIBLE_NEO_HOOKEAN_H_
