#include "core/damage/edge_projection.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace cleave {
namespace {

// Of a tet of steel with fibres.
Matrix6 SomeModuli() {
  Matrix6 moduli = Matrix6::Identity() * 2e11;
  moduli.topLeftCorner<3, 3>().array() += 1.2e11;
  const Vector6 along = ToMandel(Eigen::Vector3d(0.6, 0, 0.8) * Eigen::RowVector3d(0.6, 0, 0.8));
  moduli += 5e11 * along * along.transpose();
  return EdgeModuli({Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0.1, 0),
                     Eigen::Vector3d(0.2, 0.9, 0.1), Eigen::Vector3d(0.1, 0.2, 1.1)},
                    moduli);
}

double Lowest(const Matrix6& matrix) {
  return Eigen::SelfAdjointEigenSolver<Matrix6>(matrix).eigenvalues()[0];
}

TEST(CondenseBrokenEdges, IsTheSchurComplementForEveryMask) {
  const Matrix6 moduli = SomeModuli();
  for (int mask = 0; mask < kEdgeMasks; ++mask) {
    std::vector<int> unbroken, broken;
    for (int k = 0; k < 6; ++k) ((mask >> k & 1) != 0 ? broken : unbroken).push_back(k);
    Matrix6 expected = Matrix6::Zero();
    if (broken.empty()) {
      expected = moduli;
    } else {
      const Eigen::MatrixXd ub = moduli(unbroken, broken);
      const Eigen::MatrixXd bb = moduli(broken, broken);
      expected(unbroken, unbroken) =
          Eigen::MatrixXd(moduli(unbroken, unbroken)) - ub * bb.inverse() * ub.transpose();
    }
    const Matrix6 condensed = CondenseBrokenEdges(moduli, static_cast<EdgeMask>(mask));
    EXPECT_LE((condensed - expected).norm(), 1e-12 * moduli.norm()) << mask;
    for (const int k : broken) {
      EXPECT_EQ(condensed.row(k).norm(), 0);
      EXPECT_EQ(condensed.col(k).norm(), 0);
    }
    EXPECT_GE(Lowest(condensed), -1e-14 * moduli.norm());
    EXPECT_GE(Lowest(moduli - condensed), -1e-14 * moduli.norm());
  }
}

TEST(CondenseBrokenEdges, OneBreakAfterTheOtherIsBothAtOnce) {
  const Matrix6 moduli = SomeModuli();
  const Matrix6 twice = CondenseBrokenEdges(CondenseBrokenEdges(moduli, 0b010000), 0b010010);
  EXPECT_LE((twice - CondenseBrokenEdges(moduli, 0b010010)).norm(), 1e-13 * moduli.norm());
}

}  // namespace
}  // namespace cleave
