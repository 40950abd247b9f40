#ifndef CLEAVE_CORE_MATERIAL_ST_VENANT_KIRCHHOFF_H_
#define CLEAVE_CORE_MATERIAL_ST_VENANT_KIRCHHOFF_H_

#include "core/base/matrix3.h"
#include "core/material/isotropic_stiffness.h"
#include "core/material/moduli.h"

namespace cleave {

// The St. Venant-Kirchhoff solid: Hooke's law between Green strain and second Piola-Kirchhoff
// stress. With E = (F^T F - I)/2:
//
//   psi = mu E:E + lambda/2 (tr E)^2,   P = F (2 mu E + lambda tr(E) I)
//
// A polynomial in F, so smooth everywhere, but the energy sees no sign of J and its resistance to
// crushing fades below a stretch of 1/sqrt(3). Written in G = F - I; T is a number or a batch.
// Source: method note, section 1 (C is linear in squared lengths) and the textbook form.
struct StVenantKirchhoff {
  template <typename T>
  struct Kinematics {
    Matrix3<T> strain;  // E
    T trace;            // of E
  };
  template <typename T>
  static Kinematics<T> KinematicsOf(const Matrix3<T>& g) {
    Kinematics<T> kinematics;
    Matrix3<T>& e = kinematics.strain;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        e(i, j) = e(j, i) =
            0.5 * (g(i, j) + g(j, i) + (g(0, i) * g(0, j) + g(1, i) * g(1, j) + g(2, i) * g(2, j)));
      }
    }
    kinematics.trace = Trace(e);
    return kinematics;
  }

  // J/m^3.
  template <typename T>
  static T Energy(const Matrix3<T>&, const Kinematics<T>& kinematics,
                  const LameConstants<T>& lame) {
    const Matrix3<T>& e = kinematics.strain;
    T squares = e(0, 0) * e(0, 0);
    for (int k = 1; k < 9; ++k) squares += e(k / 3, k % 3) * e(k / 3, k % 3);
    return lame.mu * squares + 0.5 * lame.lambda * kinematics.trace * kinematics.trace;
  }

  // First Piola-Kirchhoff stress, Pa.
  template <typename T>
  static Matrix3<T> Stress(const Matrix3<T>& g, const Kinematics<T>& kinematics,
                           const LameConstants<T>& lame) {
    Matrix3<T> second;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) second(i, j) = 2.0 * lame.mu * kinematics.strain(i, j);
      second(i, i) += lame.lambda * kinematics.trace;
    }
    Matrix3<T> stress = g * second;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) stress(i, j) += second(i, j);
    }
    return stress;
  }

  // Second derivative at the singular values, not projected.
  template <typename T>
  static StiffnessSpectrum<T> Spectrum(const SignedSvd<T>& svd, const LameConstants<T>& lame) {
    StiffnessSpectrum<T> spectrum;
    const T* s = svd.s;
    T green[3];
    for (int k = 0; k < 3; ++k) green[k] = 0.5 * svd.strain[k] * (s[k] + 1.0);
    const T pressure = lame.lambda * (green[0] + green[1] + green[2]);
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const T square = s[k] * s[k];
      spectrum.axial[k][k] = pressure + 2.0 * lame.mu * (green[k] + square) + lame.lambda * square;
      const T product = s[i] * s[j];
      spectrum.axial[i][j] = spectrum.axial[j][i] = lame.lambda * product;
      // (psi_i -+ psi_j) / (s_i -+ s_j), the polynomials divided out.
      const T even = pressure + lame.mu * (s[i] * s[i] + s[j] * s[j] - 1.0);
      spectrum.symmetric[k] = even + lame.mu * product;
      spectrum.skew[k] = even - lame.mu * product;
    }
    return spectrum;
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_ST_VENANT_KIRCHHOFF_H_
