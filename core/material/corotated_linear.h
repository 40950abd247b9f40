#ifndef CLEAVE_CORE_MATERIAL_COROTATED_LINEAR_H_
#define CLEAVE_CORE_MATERIAL_COROTATED_LINEAR_H_

#include "core/base/matrix3.h"
#include "core/material/isotropic_stiffness.h"
#include "core/material/moduli.h"

namespace cleave {

// Hooke's law in the frame that turns with the body:
//
//   psi = mu sum (s_i - 1)^2 + lambda/2 (sum s_i - 3)^2
//
// with singular values s, the smallest negative in an inverted tet. Finite everywhere; the stress
// kinks where s_i + s_j = 0, deep in inversion. Source: method note, section 5.
struct CorotatedLinear {
  template <typename T>
  static SignedSvd<T> KinematicsOf(const Matrix3<T>& g) {
    return ComputeSvd(g);
  }
  template <typename T>
  static SignedSvd<T> KinematicsOf(const SignedSvd<T>& svd) {
    return svd;
  }

  // J/m^3.
  template <typename T>
  static T Energy(const Matrix3<T>&, const SignedSvd<T>& svd, const LameConstants<T>& lame) {
    const T* d = svd.strain;
    const T trace = d[0] + d[1] + d[2];
    return lame.mu * (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) + 0.5 * lame.lambda * trace * trace;
  }

  // First Piola-Kirchhoff stress, Pa.
  template <typename T>
  static Matrix3<T> Stress(const Matrix3<T>&, const SignedSvd<T>& svd,
                           const LameConstants<T>& lame) {
    const T* d = svd.strain;
    const T pressure = lame.lambda * (d[0] + d[1] + d[2]);
    const T principal[3] = {pressure + 2.0 * lame.mu * d[0], pressure + 2.0 * lame.mu * d[1],
                            pressure + 2.0 * lame.mu * d[2]};
    return FromPrincipal(svd, principal);
  }

  // Second derivative at the singular values, not projected.
  template <typename T>
  static StiffnessSpectrum<T> Spectrum(const SignedSvd<T>& svd, const LameConstants<T>& lame) {
    StiffnessSpectrum<T> spectrum;
    const T pressure = lame.lambda * (svd.strain[0] + svd.strain[1] + svd.strain[2]);
    const T cap = SkewStiffnessCap(lame);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      spectrum.axial[k][k] = lame.lambda + 2.0 * lame.mu;
      spectrum.axial[i][j] = spectrum.axial[j][i] = lame.lambda;
      spectrum.symmetric[k] = 2.0 * lame.mu;
      spectrum.skew[k] = 2.0 * lame.mu + BoundedQuotient(2.0 * (pressure - 2.0 * lame.mu),
                                                         svd.s[i] + svd.s[j], cap);
    }
    return spectrum;
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_COROTATED_LINEAR_H_
