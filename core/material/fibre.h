#ifndef CLEAVE_CORE_MATERIAL_FIBRE_H_
#define CLEAVE_CORE_MATERIAL_FIBRE_H_

#include "core/base/lanes.h"
#include "core/base/matrix3.h"
#include "core/material/isotropic_stiffness.h"

namespace cleave {

// Fibres of unit rest direction a that resist changes of their length, through inversion. With
// v = F a, r = |v| and sign = -1 where inversion has turned the fibre over, else 1:
//
//   psi = m/2 (r - sign)^2,   P = m (1 - sign/r) v a^T
//
// Along the fibre the solid's Young's modulus grows by m. At the change of sign the energy jumps,
// so callers keep the sign while they compare energies. Source: Kim, de Goes and Iben, Anisotropic
// Elasticity for Inversion-Safety and Element Rehabilitation (2019), as in the method note,
// section 5.
template <typename T>
struct FibreStretch {
  T direction[3];  // v / r
  T length;        // r
  T excess;        // r - sign
};

// From a, G a with G = F - I, and the sign; T is a batch, Double4 or Float8. The direction of a
// fibre of no length (r < 1e-8, in float 4e-6) is left to SetCollapsedDirection.
template <typename T>
FibreStretch<T> StretchFibre(const T a[3], const T ga[3], T sign) {
  FibreStretch<T> fibre;
  T v[3];
  for (int i = 0; i < 3; ++i) v[i] = a[i] + ga[i];
  fibre.length = Sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  const T divisor = Max(fibre.length, Splat<T>(Lanes<T>::kTiny));
  for (int i = 0; i < 3; ++i) fibre.direction[i] = v[i] / divisor;
  // r^2 - 1 from G, so that small strains keep their digits.
  const T growth = 2.0 * (a[0] * ga[0] + a[1] * ga[1] + a[2] * ga[2]) +
                   (ga[0] * ga[0] + ga[1] * ga[1] + ga[2] * ga[2]);
  fibre.excess = sign > 0 ? growth / (fibre.length + 1.0) : fibre.length + 1.0;
  return fibre;
}

template <typename T>
auto IsCollapsed(const FibreStretch<T>& fibre) {
  return fibre.length < Splat<T>(Lanes<T>::kCount == 4 ? 1e-8 : 4e-6);
}

// Gives collapsed fibres the direction in which the solid around them has turned.
template <typename T>
void SetCollapsedDirection(const SignedSvd<T>& svd, const T a[3], FibreStretch<T>& fibre) {
  const auto collapsed = IsCollapsed(fibre);
  T principal[3];
  for (int k = 0; k < 3; ++k)
    principal[k] = svd.v(0, k) * a[0] + svd.v(1, k) * a[1] + svd.v(2, k) * a[2];
  for (int i = 0; i < 3; ++i) {
    const T turned =
        svd.u(i, 0) * principal[0] + svd.u(i, 1) * principal[1] + svd.u(i, 2) * principal[2];
    fibre.direction[i] = collapsed ? turned : fibre.direction[i];
  }
}

// -1 where a^T S a < 0, S being the stretch of the polar decomposition, else 1. Only inverted
// tets can have -1.
template <typename T>
T FibreSign(const SignedSvd<T>& svd, const T a[3]) {
  T invariant = Splat<T>(0);
  for (int k = 0; k < 3; ++k) {
    const T principal = svd.v(0, k) * a[0] + svd.v(1, k) * a[1] + svd.v(2, k) * a[2];
    invariant += svd.s[k] * principal * principal;
  }
  return invariant < 0 ? Splat<T>(-1) : Splat<T>(1);
}

// The second derivative of psi / m is (direction direction^T + across (I - direction direction^T))
// in v, times a a^T. This is `across`, bounded where a turned-over fibre has no length.
template <typename T>
T FibreStiffnessAcross(const FibreStretch<T>& fibre) {
  return BoundedQuotient(fibre.excess, fibre.length, Splat<T>(1000));
}

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_FIBRE_H_
