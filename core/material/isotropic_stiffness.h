#ifndef CLEAVE_CORE_MATERIAL_ISOTROPIC_STIFFNESS_H_
#define CLEAVE_CORE_MATERIAL_ISOTROPIC_STIFFNESS_H_

#include "core/base/lanes.h"
#include "core/base/matrix3.h"
#include "core/material/moduli.h"

namespace cleave {

// T is a batch, Double4 or Float8, in all of this file.

// F = U diag(s) V^T, U and V rotations, s in falling order of size, only the smallest negative
// where F turns the tet inside out.
template <typename T>
struct SignedSvd {
  Matrix3<T> u;
  T s[3];
  T strain[3];  // s - 1, with the digits that small strains lose in s
  Matrix3<T> v;
};

// Of F = I + G, from G. Precondition: finite entries. Singular values below 1e-8 of the largest
// (in float 3e-4) have few correct digits; U and V are orthogonal to rounding for every F, the zero
// matrix included.
template <typename T>
SignedSvd<T> ComputeSvd(const Matrix3<T>& displacement_gradient);

// U diag(values) V^T.
template <typename T>
Matrix3<T> FromPrincipal(const SignedSvd<T>& svd, const T values[3]);

// The second derivative of an isotropic energy in the frame of the singular values: how the stress
// in that frame, Pa, follows a change of the deformation gradient in that frame.
template <typename T>
struct StiffnessSpectrum {
  T axial[3][3];  // d2 psi / ds_i ds_j, symmetric
  // For the pairs of axes (1,2), (2,0), (0,1), by the axis left out: the eigenvalues of the
  // symmetric and of the skew off-diagonal change.
  T symmetric[3];
  T skew[3];
};

// In laws of singular values the stress kinks where s_i + s_j = 0, and the skew eigenvalue, a
// quotient by that sum, has no bound. This one keeps it finite, Pa. Source: method note, section 5.
template <typename T>
T SkewStiffnessCap(const LameConstants<T>& lame) {
  return 1000.0 * (lame.lambda + lame.mu);
}

// dividend / divisor within [-cap, cap]. Preconditions: divisor >= 0, finite dividend, cap > 0.
template <typename T>
T BoundedQuotient(T dividend, T divisor, T cap) {
  const auto steep = !(Abs(dividend) < cap * divisor);
  const T bound = dividend < 0 ? -cap : cap;
  return steep ? bound : dividend / (steep ? Splat<T>(1) : divisor);
}

// Replaces negative eigenvalues by 0: the nearest positive semidefinite second derivative.
// Source: method note, section 5.
template <typename T>
void ProjectToSemidefinite(StiffnessSpectrum<T>& spectrum);

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_ISOTROPIC_STIFFNESS_H_
