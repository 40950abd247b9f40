#ifndef CLEAVE_CORE_MATERIAL_ISOTROPIC_STIFFNESS_H_
#define CLEAVE_CORE_MATERIAL_ISOTROPIC_STIFFNESS_H_

#include "core/base/double4.h"
#include "core/base/matrix3.h"
#include "core/material/moduli.h"

namespace cleave {

// F = U diag(s) V^T of four tets, U and V rotations, s in falling order of size, only the smallest
// negative where F turns the tet inside out.
struct SignedSvd {
  Matrix3<Double4> u;
  Double4 s[3];
  Double4 strain[3];  // s - 1, with the digits that small strains lose in s
  Matrix3<Double4> v;
};

// Of F = I + G, from G. Precondition: finite entries. Singular values below 1e-8 of the largest
// have few correct digits; U and V are orthogonal to rounding for every F, the zero matrix
// included.
SignedSvd ComputeSvd(const Matrix3<Double4>& displacement_gradient);

// U diag(values) V^T.
Matrix3<Double4> FromPrincipal(const SignedSvd& svd, const Double4 values[3]);

// The second derivative of an isotropic energy in the frame of the singular values: how the stress
// in that frame, Pa, follows a change of the deformation gradient in that frame.
struct StiffnessSpectrum {
  Double4 axial[3][3];  // d2 psi / ds_i ds_j, symmetric
  // For the pairs of axes (1,2), (2,0), (0,1), by the axis left out: the eigenvalues of the
  // symmetric and of the skew off-diagonal change.
  Double4 symmetric[3];
  Double4 skew[3];
};

// In laws of singular values the stress kinks where s_i + s_j = 0, and the skew eigenvalue, a
// quotient by that sum, has no bound. This one keeps it finite, Pa. Source: method note, section 5.
inline Double4 SkewStiffnessCap(const LameConstants<Double4>& lame) {
  return 1e3 * (lame.lambda + lame.mu);
}

// dividend / divisor within [-cap, cap]. Preconditions: divisor >= 0, finite dividend, cap > 0.
inline Double4 BoundedQuotient(Double4 dividend, Double4 divisor, Double4 cap) {
  const Int64x4 steep = !(Abs(dividend) < cap * divisor);
  const Double4 bound = dividend < 0 ? -cap : cap;
  return steep ? bound : dividend / (steep ? Splat(1) : divisor);
}

// Replaces negative eigenvalues by 0: the nearest positive semidefinite second derivative.
// Source: method note, section 5.
void ProjectToSemidefinite(StiffnessSpectrum& spectrum);

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_ISOTROPIC_STIFFNESS_H_
