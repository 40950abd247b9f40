#ifndef CLEAVE_CORE_MATERIAL_ISOTROPIC_STIFFNESS_H_
#define CLEAVE_CORE_MATERIAL_ISOTROPIC_STIFFNESS_H_

#include "core/base/double4.h"
#include "core/base/matrix3.h"

namespace cleave {

// F = U diag(s) V^T of four tets, U and V rotations, s in falling order of size, only the smallest
// negative where F turns the tet inside out.
struct SignedSvd {
  Matrix3<Double4> u;
  Double4 s[3];
  Matrix3<Double4> v;
};

// Precondition: finite entries. Singular values below 1e-8 of the largest have few correct digits;
// U and V are orthogonal to rounding for every F, the zero matrix included.
SignedSvd ComputeSvd(const Matrix3<Double4>& deformation_gradient);

// The second derivative of an isotropic energy in the frame of the singular values: how the stress
// in that frame, Pa, follows a change of the deformation gradient in that frame.
struct StiffnessSpectrum {
  Double4 axial[3][3];  // d2 psi / ds_i ds_j, symmetric
  // For the pairs of axes (1,2), (2,0), (0,1), by the axis left out: the eigenvalues of the
  // symmetric and of the skew off-diagonal change.
  Double4 symmetric[3];
  Double4 skew[3];
};

// Replaces negative eigenvalues by 0: the nearest positive semidefinite second derivative.
// Source: method note, section 5.
void ProjectToSemidefinite(StiffnessSpectrum& spectrum);

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_ISOTROPIC_STIFFNESS_H_
