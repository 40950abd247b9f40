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

  template <typename T>
  struct Kinematics {
    SignedSvd<T> svd;
    T log[3];     // l(s_i)
    T excess[3];  // (s_i - 1) - l(s_i), with its digits at small strains
    T slope[3];   // dl/ds
    T volume;     // sum of l
  };

  template <typename T>
  static Kinematics<T> KinematicsOf(const Matrix3<T>& g) {
    return KinematicsOf(ComputeSvd(g));
  }
  template <typename T>
  static Kinematics<T> KinematicsOf(const SignedSvd<T>& svd) {
    Kinematics<T> kinematics;
    kinematics.svd = svd;
    SetLogs(kinematics);
    return kinematics;
  }

  // J/m^3.
  template <typename T>
  static T Energy(const Matrix3<T>&, const Kinematics<T>& kinematics,
                  const LameConstants<T>& lame) {
    T shear = Splat<T>(0);
    for (int k = 0; k < 3; ++k) {
      const T d = kinematics.svd.strain[k];
      shear += kinematics.excess[k] + 0.5 * d * d;
    }
    return lame.mu * shear + 0.5 * lame.lambda * kinematics.volume * kinematics.volume;
  }

  // First Piola-Kirchhoff stress, Pa.
  template <typename T>
  static Matrix3<T> Stress(const Matrix3<T>&, const Kinematics<T>& kinematics,
                           const LameConstants<T>& lame) {
    T principal[3];
    for (int k = 0; k < 3; ++k) {
      const T d = kinematics.svd.strain[k];
      const T s = kinematics.svd.s[k];
      // s - dl/ds; above a it is s - 1/s.
      const T shear = s >= Splat<T>(kSmallestLogStretch) ? d * (s + 1.0) * kinematics.slope[k]
                                                         : s - kinematics.slope[k];
      principal[k] = lame.mu * shear + lame.lambda * kinematics.volume * kinematics.slope[k];
    }
    return FromPrincipal(kinematics.svd, principal);
  }

  // Second derivative at the singular values, not projected.
  template <typename T>
  static StiffnessSpectrum<T> Spectrum(const SignedSvd<T>& svd, const LameConstants<T>& lame) {
    const Kinematics<T> kinematics = KinematicsOf(svd);
    StiffnessSpectrum<T> spectrum;
    const T* s = svd.s;
    const T* slope = kinematics.slope;
    const T a = Splat<T>(kSmallestLogStretch);
    const T bend = 1.0 / (a * a);
    const T c = lame.lambda * kinematics.volume - lame.mu;
    const T cap = bend * SkewStiffnessCap(lame);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const T above = Max(s[k], a);
      spectrum.axial[k][k] = lame.mu - c / (above * above) + lame.lambda * slope[k] * slope[k];
      spectrum.axial[i][j] = spectrum.axial[j][i] = lame.lambda * slope[i] * slope[j];
      // The slope of l between s_i and s_j falls by 1/(s s') above a and by 1/a^2 below it.
      const T above_i = Max(s[i], a), above_j = Max(s[j], a);
      const T gap = s[i] - s[j];
      const T whole = s[i] >= a ? Splat<T>(1) : Splat<T>(0);
      const T share = gap == 0 ? whole : (above_i - above_j) / (gap == 0 ? Splat<T>(1) : gap);
      const T fall = share / (above_i * above_j) + (1.0 - share) * bend;
      spectrum.symmetric[k] = lame.mu - c * fall;
      spectrum.skew[k] = lame.mu + BoundedQuotient(c * (slope[i] + slope[j]), s[i] + s[j], cap);
    }
    return spectrum;
  }

 private:
  template <typename T>
  static void SetLogs(Kinematics<T>& kinematics) {
    const T a = Splat<T>(kSmallestLogStretch);
    const T log_a = Splat<T>(std::log(kSmallestLogStretch));
    // d - ln(1 + d) would cancel near rest. The next term of its series, d^9/9, is below rounding
    // up to there.
    const T near_rest = Splat<T>(Lanes<T>::kCount == 4 ? 0.005 : 0.09);
    for (int k = 0; k < 3; ++k) {
      const T d = kinematics.svd.strain[k];
      const T s = kinematics.svd.s[k];
      const T below = (s - a) / a;
      const auto small = s < a;
      const T logged = small ? Splat<T>(0) : d;
      T log;
      for (int lane = 0; lane < Lanes<T>::kCount; ++lane) log[lane] = std::log1p(logged[lane]);
      kinematics.log[k] = small ? log_a + below - 0.5 * below * below : log;
      T series = d / 8;
      for (int power = 7; power >= 2; --power) series = d * (Splat<T>(1.0 / power) - series);
      series *= d;
      kinematics.excess[k] = Abs(d) < near_rest ? series : d - kinematics.log[k];
      kinematics.slope[k] = small ? (1.0 - below) / a : 1.0 / s;
    }
    kinematics.volume = kinematics.log[0] + kinematics.log[1] + kinematics.log[2];
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_INVERTIBLE_NEO_HOOKEAN_H_
