#ifndef CLEAVE_CORE_MATERIAL_STABLE_NEO_HOOKEAN_H_
#define CLEAVE_CORE_MATERIAL_STABLE_NEO_HOOKEAN_H_

#include "core/base/matrix3.h"
#include "core/material/isotropic_stiffness.h"
#include "core/material/moduli.h"

namespace cleave {

// The stable Neo-Hookean solid: a polynomial in F, smooth through flat and inverted states.
// With L = lambda + mu:
//
//   psi = mu/2 (|F|^2 - 3) - mu (J - 1) + L/2 (J - 1)^2,   P = mu F + (L (J - 1) - mu) cof F
//
// All is written in G = F - I, so that small strains keep their digits where the printed form
// would subtract large numbers. T is a number or a batch. Source: Smith, de Goes and Kim, Stable
// Neo-Hookean Flesh Simulation (2018), in the form of the method note, section 5.
struct StableNeoHookean {
  // Shared by energy and stress.
  template <typename T>
  struct Kinematics {
    Matrix3<T> cofactor;  // of G
    T trace;              // of G
    T change;             // J - 1
  };
  template <typename T>
  static Kinematics<T> KinematicsOf(const Matrix3<T>& g) {
    Kinematics<T> volume;
    volume.cofactor = Cofactor(g);
    volume.trace = Trace(g);
    const T determinant = g(0, 0) * volume.cofactor(0, 0) + g(0, 1) * volume.cofactor(0, 1) +
                          g(0, 2) * volume.cofactor(0, 2);
    volume.change = volume.trace + Trace(volume.cofactor) + determinant;
    return volume;
  }

  // J/m^3. |F|^2 - 3 is of first order in strain and cancels against J - 1. With the invariants e
  // of Green strain, J^2 = 1 + 2 e1 + 4 e2 + 8 e3, it cancels exactly, so that a body that has
  // turned keeps the digits of its energy; where J is not positive, the energy is no small
  // difference.
  template <typename T>
  static T Energy(const Matrix3<T>& g, const Kinematics<T>& volume, const LameConstants<T>& lame) {
    Matrix3<T> e;  // F^T F - I, twice Green strain
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) {
        e(i, j) = e(j, i) =
            g(i, j) + g(j, i) + (g(0, i) * g(0, j) + g(1, i) * g(1, j) + g(2, i) * g(2, j));
      }
    }
    const Matrix3<T> minors = Cofactor(e);
    const T first = 0.5 * Trace(e);
    const T higher =
        Trace(minors) + (e(0, 0) * minors(0, 0) + e(0, 1) * minors(0, 1) + e(0, 2) * minors(0, 2));
    const T& change = volume.change;
    const auto upright = change > -1;
    const T divisor = upright ? change + 2.0 : change * change + 1.0;
    const T shear = upright ? (first * change - higher) / divisor : first - change;
    return lame.mu * shear + 0.5 * (lame.lambda + lame.mu) * change * change;
  }

  // First Piola-Kirchhoff stress, Pa.
  template <typename T>
  static Matrix3<T> Stress(const Matrix3<T>& g, const Kinematics<T>& volume,
                           const LameConstants<T>& lame) {
    const T pressure = (lame.lambda + lame.mu) * volume.change;
    Matrix3<T> stress;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        T shear = g(i, j) + g(j, i) - volume.cofactor(i, j);
        T cofactor_of_f = volume.cofactor(i, j) - g(j, i);
        if (i == j) {
          shear -= volume.trace;
          cofactor_of_f += 1.0 + volume.trace;
        }
        stress(i, j) = lame.mu * shear + pressure * cofactor_of_f;
      }
    }
    return stress;
  }

  // Second derivative at the singular values, not projected.
  template <typename T>
  static StiffnessSpectrum<T> Spectrum(const SignedSvd<T>& svd, const LameConstants<T>& lame) {
    StiffnessSpectrum<T> spectrum;
    const T* s = svd.s;
    const T bulk = lame.lambda + lame.mu;
    const T c = bulk * (s[0] * s[1] * s[2] - 1.0) - lame.mu;
    for (int k = 0; k < 3; ++k) {
      const int i = (k + 1) % 3, j = (k + 2) % 3;
      const T area = s[i] * s[j];
      spectrum.axial[k][k] = lame.mu + bulk * area * area;
      spectrum.axial[i][j] = spectrum.axial[j][i] = bulk * area * s[k] * s[k] + c * s[k];
      spectrum.symmetric[k] = lame.mu - c * s[k];
      spectrum.skew[k] = lame.mu + c * s[k];
    }
    return spectrum;
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_STABLE_NEO_HOOKEAN_H_
