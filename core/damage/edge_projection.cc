#include "core/damage/edge_projection.h"

#include <Eigen/LU>
#include <cmath>

namespace cleave {

Vector6 ToMandel(const Eigen::Matrix3d& symmetric) {
  const double root = std::sqrt(2.0);
  Vector6 vector;
  vector << symmetric(0, 0), symmetric(1, 1), symmetric(2, 2), root * symmetric(1, 2),
      root * symmetric(0, 2), root * symmetric(0, 1);
  return vector;
}

Matrix6 EdgeModuli(const TetCorners& corners, const Matrix6& moduli) {
  Eigen::Matrix3d edges;  // from the first corner
  for (int k = 0; k < 3; ++k) edges.col(k) = corners[static_cast<size_t>(k + 1)] - corners[0];
  Eigen::Matrix<double, 3, 4> gradients;
  gradients.rightCols<3>() = edges.inverse().transpose();
  gradients.col(0) = -gradients.rightCols<3>().rowwise().sum();
  Matrix6 strains;  // of a unit q of each edge
  for (int k = 0; k < 6; ++k) {
    const auto& ends = kTetEdges[static_cast<size_t>(k)];
    const Eigen::Matrix3d product = gradients.col(ends[0]) * gradients.col(ends[1]).transpose();
    strains.col(k) = ToMandel(-0.5 * (product + product.transpose()));
  }
  return strains.transpose() * moduli * strains;
}

Matrix6 CondenseBrokenEdges(Matrix6 edge_moduli, EdgeMask broken) {
  // A pivot that rounding has left of a zero: nothing depends on that edge any more.
  constexpr double kZeroPivot = 1e-13;
  const Vector6 diagonal = edge_moduli.diagonal();
  for (int k = 0; k < 6; ++k) {
    if ((broken >> k & 1) == 0) continue;
    const double pivot = edge_moduli(k, k);
    const Vector6 column = edge_moduli.col(k);
    if (pivot > kZeroPivot * diagonal[k]) edge_moduli -= column * column.transpose() / pivot;
    edge_moduli.col(k).setZero();
    edge_moduli.row(k).setZero();
  }
  return edge_moduli;
}

}  // namespace cleave
