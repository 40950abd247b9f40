#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "core/mesh/incidence.h"
#include "core/solver/pcg.h"
#include "core/solver/stiffness_matrix.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

class LinearSolver : public ::testing::Test {
 protected:
  LinearSolver() : matrix_(incidence_.edges, mesh_.node_count()) {
    // Random symmetric positive blocks.
    EdgeBlocks& blocks = matrix_.Clear();
    std::srand(1);
    for (int64_t edge = 0; edge < incidence_.edge_count(); ++edge) {
      const Eigen::Matrix3f random = Eigen::Matrix3f::Random();
      Eigen::Map<Eigen::Matrix3f>(blocks.data() + 9 * edge) = random * random.transpose();
    }
    inertia_.assign(static_cast<size_t>(mesh_.node_count()), 0.1);
    matrix_.Finish(inertia_);
  }

  Eigen::MatrixXd Dense() const {
    const auto size = static_cast<int>(3 * mesh_.node_count());
    Eigen::MatrixXd dense(size, size);
    NodalVector x(static_cast<size_t>(mesh_.node_count()), Splat(0)), product = x;
    for (int column = 0; column < size; ++column) {
      x[static_cast<size_t>(column / 3)][column % 3] = 1;
      matrix_.Multiply(x, 1, 0, mesh_.node_count(), product);
      for (int row = 0; row < size; ++row)
        dense(row, column) = product[static_cast<size_t>(row / 3)][row % 3];
      x[static_cast<size_t>(column / 3)][column % 3] = 0;
    }
    return dense;
  }

  const TetMesh mesh_ = KuhnBox({3, 2, 2}, {3, 2, 2});
  const Incidence incidence_ = BuildIncidence(mesh_);
  StiffnessMatrix matrix_;
  std::vector<double> inertia_;
  const NodalVector positions_ = [&] {
    NodalVector positions;
    for (const Vec3& position : mesh_.rest_positions) positions.push_back(ToDouble4(position));
    return positions;
  }();
};

TEST_F(LinearSolver, TheMatrixIsSymmetricAndItsDiagonalBlocksAreThose) {
  const Eigen::MatrixXd dense = Dense();
  EXPECT_NEAR((dense - dense.transpose()).norm(), 0, 1e-6 * dense.norm());
  for (int node = 0; node < mesh_.node_count(); ++node) {
    Double4 columns[3];
    matrix_.DiagonalBlock(node, columns);
    for (int k = 0; k < 9; ++k)
      EXPECT_NEAR(columns[k / 3][k % 3], dense(3 * node + k % 3, 3 * node + k / 3), 1e-12);
  }
}

TEST_F(LinearSolver, CouplingsAreInProductAndDiagonalUntilTheNextMatrix) {
  const Eigen::MatrixXd without = Dense();
  const Double4 spring[3] = {{2, 1, 0, 0}, {1, 3, -1, 0}, {0, -1, 4, 0}};
  const Double4 coupling[3] = {{1, 2, 3, 0}, {4, 5, 6, 0}, {7, 8, 9, 0}};
  matrix_.couplings().AddSpring(4, 30, spring);
  matrix_.couplings().AddCoupling(11, 0, coupling);
  matrix_.Finish(inertia_);
  const Eigen::MatrixXd added = Dense() - without;
  EXPECT_NEAR((added - added.transpose()).norm(), 0, 1e-12);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      EXPECT_NEAR(added(3 * 4 + row, 3 * 4 + column), spring[column][row], 1e-12);
      EXPECT_NEAR(added(3 * 4 + row, 3 * 30 + column), -spring[column][row], 1e-12);
      EXPECT_NEAR(added(3 * 11 + row, 3 * 0 + column), coupling[column][row], 1e-12);
    }
  }
  Double4 columns[3];
  matrix_.DiagonalBlock(30, columns);
  EXPECT_NEAR(columns[1][1], without(3 * 30 + 1, 3 * 30 + 1) + 3, 1e-12);
  matrix_.Clear();
  matrix_.Finish(inertia_);
  EXPECT_EQ(Dense()(3 * 4, 3 * 30), 0);
}

TEST_F(LinearSolver, ATranslationMeetsInertiaAloneToTheLastBit) {
  NodalVector x(static_cast<size_t>(mesh_.node_count()), Double4{3, -7, 11, 0}), product = x;
  matrix_.Multiply(x, 1, 0, mesh_.node_count(), product);
  for (const Double4& of_node : product) {
    EXPECT_EQ(of_node[0], 0.1 * 3);
    EXPECT_EQ(of_node[1], 0.1 * -7);
    EXPECT_EQ(of_node[2], 0.1 * 11);
  }
}

TEST_F(LinearSolver, SolvesWithGivenCoordinatesAtZeroInBothPrecisions) {
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    const std::vector<FixedNode> fixed = {{2, Int64x4{-1, -1, -1, 0}}, {7, Int64x4{0, -1, 0, 0}}};
    PcgSolver pcg(mesh_.node_count(), mesh_.node_count(), fixed, precision);
    pcg.Prepare(matrix_, positions_);
    // Far outside the range of float, which is no matter of precision.
    const double size = 1e-60;
    NodalVector rhs, solution(static_cast<size_t>(mesh_.node_count()));
    for (int node = 0; node < mesh_.node_count(); ++node)
      rhs.push_back(size * Double4{std::sin(node), std::cos(3 * node), 1.0 / (node + 1), 0});
    const StopFlag stop;
    const auto result = pcg.Solve(matrix_, rhs, 1e-10, stop, solution);
    ASSERT_TRUE(result.ok());
    EXPECT_TRUE(result->positive);
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(solution[2][axis], 0);
    EXPECT_EQ(solution[7][1], 0);
    NodalVector product = rhs;
    matrix_.Multiply(solution, 1, 0, mesh_.node_count(), product);
    for (int node = 0; node < mesh_.node_count(); ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        const bool given = node == 2 || (node == 7 && axis == 1);
        if (given) continue;
        const auto n = static_cast<size_t>(node);
        EXPECT_NEAR(product[n][axis], rhs[n][axis],
                    (precision == Precision::kFloat ? 1e-5 : 1e-8) * size);
      }
    }
  }
}

TEST_F(LinearSolver, NoticesAnIndefiniteMatrix) {
  EdgeBlocks& blocks = matrix_.Clear();
  for (float& entry : blocks) entry = 0;
  for (int k = 0; k < 9; k += 4) blocks[static_cast<size_t>(k)] = -1;
  matrix_.Finish(inertia_);
  PcgSolver pcg(mesh_.node_count(), mesh_.node_count(), {}, Precision::kDouble);
  pcg.Prepare(matrix_, positions_);
  NodalVector rhs(static_cast<size_t>(mesh_.node_count()), Double4{1, 0, 0, 0}), solution = rhs;
  rhs[0] = Double4{-1, 2, 0, 0};
  const StopFlag stop;
  const auto result = pcg.Solve(matrix_, rhs, 1e-8, stop, solution);
  ASSERT_TRUE(result.ok());
  EXPECT_FALSE(result->positive);
}

TEST_F(LinearSolver, StopsWhenAsked) {
  PcgSolver pcg(mesh_.node_count(), mesh_.node_count(), {}, Precision::kDouble);
  pcg.Prepare(matrix_, positions_);
  NodalVector rhs(static_cast<size_t>(mesh_.node_count()), Double4{1, 2, 3, 0}), solution = rhs;
  rhs[0] = Double4{-1, 2, 0, 0};
  StopFlag stop;
  stop.Request();
  EXPECT_EQ(pcg.Solve(matrix_, rhs, 1e-8, stop, solution).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace cleave
