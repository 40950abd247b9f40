#ifndef CLEAVE_CORE_DAMAGE_EDGE_PROJECTION_H_
#define CLEAVE_CORE_DAMAGE_EDGE_PROJECTION_H_

#include <Eigen/Core>

#include "core/damage/edge_mask.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

// A symmetric 3x3 matrix as a vector: xx, yy, zz, sqrt2 yz, sqrt2 xz, sqrt2 xy, so that a : b is
// the product of the vectors (Mandel's notation).
Vector6 ToMandel(const Eigen::Matrix3d& symmetric);

// The second derivative, Pa/m^4, of a tet's energy density by q_k = (d_k^2 - L_k^2) / 2, d_k the
// current and L_k the rest length of edge kTetEdges[k], when energy is quadratic in Green strain.
// `moduli` (Pa) is the second derivative by Green strain in Mandel's notation. Green strain is
// sum_k q_k B_k with B_k = -sym(grad N_i grad N_j^T). Precondition: `corners` (m) span a positive
// rest volume. Source: method note, sections 1 and 3.
Matrix6 EdgeModuli(const TetCorners& corners, const Matrix6& moduli);

// What is left of `edge_moduli` when the broken edges take whatever length costs least:
// A_uu - A_ub A_bb^-1 A_bu for the unbroken edges u, and zeros for the broken ones b. Precondition:
// symmetric and positive semidefinite; so is the result, and it never exceeds the argument. Source:
// method note, section 3.
Matrix6 CondenseBrokenEdges(Matrix6 edge_moduli, EdgeMask broken);

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_EDGE_PROJECTION_H_
