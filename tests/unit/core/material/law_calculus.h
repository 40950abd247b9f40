#ifndef CLEAVE_TESTS_UNIT_CORE_MATERIAL_LAW_CALCULUS_H_
#define CLEAVE_TESTS_UNIT_CORE_MATERIAL_LAW_CALCULUS_H_

#include <Eigen/Dense>
#include <array>
#include <random>

#include "core/base/lanes.h"
#include "core/base/matrix3.h"
#include "core/material/isotropic_stiffness.h"

namespace cleave {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

// F - I, the same in every lane.
template <typename T = Double4>
Matrix3<T> DisplacementGradientOf(const Eigen::Matrix3d& f) {
  Matrix3<T> g;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) g(i, j) = Splat<T>(f(i, j) - (i == j ? 1 : 0));
  }
  return g;
}

template <typename T>
Eigen::Matrix3d FirstLane(const Matrix3<T>& batch) {
  Eigen::Matrix3d matrix;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix(i, j) = batch(i, j)[0];
  }
  return matrix;
}

inline Eigen::Matrix3d MatrixOf(const std::array<double, 9>& rows) {
  Eigen::Matrix3d matrix;
  for (int k = 0; k < 9; ++k) matrix(k / 3, k % 3) = rows[static_cast<size_t>(k)];
  return matrix;
}

template <typename Law, typename T>
double EnergyAt(const Eigen::Matrix3d& f, const LameConstants<T>& lame) {
  const Matrix3<T> g = DisplacementGradientOf<T>(f);
  return Law::Energy(g, Law::KinematicsOf(g), lame)[0];
}

template <typename Law, typename T>
Eigen::Matrix3d StressAt(const Eigen::Matrix3d& f, const LameConstants<T>& lame) {
  const Matrix3<T> g = DisplacementGradientOf<T>(f);
  return FirstLane(Law::Stress(g, Law::KinematicsOf(g), lame));
}

// The second derivative of psi by F, both stored row by row, that a spectrum stands for.
template <typename T>
Matrix9d SecondDerivative(const SignedSvd<T>& svd, const StiffnessSpectrum<T>& spectrum) {
  const Eigen::Matrix3d u = FirstLane(svd.u), v = FirstLane(svd.v);
  Matrix9d result = Matrix9d::Zero();
  const auto direction = [&](int i, int j, double other) {
    Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
    turned(i, j) += 1;
    if (other != 0) turned(j, i) += other;
    const Eigen::Matrix3d straight = u * turned * v.transpose();
    Eigen::Matrix<double, 9, 1> entries;
    for (int k = 0; k < 9; ++k) entries(k) = straight(k / 3, k % 3);
    return entries;
  };
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      result += spectrum.axial[i][j][0] * direction(i, i, 0) * direction(j, j, 0).transpose();
    }
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const auto symmetric = direction(i, j, 1), skew = direction(i, j, -1);
    result += 0.5 * spectrum.symmetric[k][0] * symmetric * symmetric.transpose();
    result += 0.5 * spectrum.skew[k][0] * skew * skew.transpose();
  }
  return result;
}

// A random deformation gradient with these singular values.
inline Eigen::Matrix3d RandomGradient(std::mt19937& random, const Eigen::Vector3d& stretches) {
  std::normal_distribution<double> normal;
  const auto rotation = [&] {
    return Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
        .normalized()
        .toRotationMatrix();
  };
  const Eigen::Matrix3d left = rotation();
  return left * stretches.asDiagonal() * rotation().transpose();
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_MATERIAL_LAW_CALCULUS_H_
