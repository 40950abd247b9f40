#include "core/solver/coarse_space.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "core/mesh/incidence.h"
#include "core/solver/pcg.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

// A bar of cells whose nodes are numbered along it, linear elastic with Lame's constants of 1 and 2
// Pa, so soft in inertia that a push crosses it in a step. Blocks of its edges are not symmetric.
class CoarseSpaceTest : public ::testing::Test {
 protected:
  CoarseSpaceTest() : matrix_(incidence_.edges, mesh_.node_count()) {
    std::srand(2);
    AddElasticity(matrix_.Clear());
    inertia_.assign(static_cast<size_t>(mesh_.node_count()), 1e-4);
    matrix_.Finish(inertia_);
    for (const Vec3& position : mesh_.rest_positions) positions_.push_back(ToDouble4(position));
    for (int32_t node = 0; node < 36; ++node) fixed_.push_back({node, Int64x4{-1, -1, -1, 0}});
    fixed_.push_back({700, Int64x4{0, -1, 0, 0}});
    rhs_.resize(positions_.size());
    for (Double4& force : rhs_) {
      const Eigen::Vector3d random = Eigen::Vector3d::Random();
      force = Double4{random[0], random[1], random[2], 0};
    }
    for (const FixedNode& fixed : fixed_) {
      Double4& force = rhs_[static_cast<size_t>(fixed.node)];
      force = fixed.axes ? Splat(0) : force;
    }
  }

  void AddElasticity(EdgeBlocks& blocks) const {
    for (size_t tet = 0; tet < mesh_.tets.size(); ++tet) {
      const std::array<int32_t, 4>& nodes = mesh_.tets[tet];
      Eigen::Matrix3d edges;
      for (int k = 0; k < 3; ++k)
        edges.col(k) = Position(nodes[static_cast<size_t>(k) + 1]) - Position(nodes[0]);
      const double volume = std::abs(edges.determinant()) / 6;
      Eigen::Matrix<double, 4, 3> gradients;
      gradients.bottomRows<3>() = edges.inverse();
      gradients.row(0) = -gradients.bottomRows<3>().colwise().sum();
      for (size_t k = 0; k < 6; ++k) {
        const auto edge = static_cast<size_t>(incidence_.tet_edges[tet][k]);
        const auto [a, b] = incidence_.edges[edge];
        const auto row_of = [&](int32_t node) {
          return std::find(nodes.begin(), nodes.end(), node) - nodes.begin();
        };
        const Eigen::Vector3d to_a = gradients.row(row_of(a)), to_b = gradients.row(row_of(b));
        const Eigen::Matrix3d block = to_a * to_b.transpose() + 2 * to_b * to_a.transpose() +
                                      2 * to_a.dot(to_b) * Eigen::Matrix3d::Identity();
        Eigen::Map<Eigen::Matrix3f>(blocks.data() + 9 * edge) -= (volume * block).cast<float>();
      }
    }
  }

  // Of conjugate gradients with an inverse diagonal, to the same tolerance.
  int64_t IterationsOfOneLevel() const {
    std::vector<Eigen::Triplet<double>> entries;
    const auto size = static_cast<int>(3 * mesh_.node_count());
    const auto is_free = [&](int row) {
      for (const FixedNode& fixed : fixed_) {
        if (fixed.node == row / 3 && fixed.axes[row % 3] != 0) return false;
      }
      return true;
    };
    std::vector<bool> free_rows;
    for (int row = 0; row < size; ++row) free_rows.push_back(is_free(row));
    const auto add = [&](int row, int column, double value) {
      if (free_rows[static_cast<size_t>(row)] && free_rows[static_cast<size_t>(column)])
        entries.emplace_back(row, column, value);
    };
    for (int node = 0; node < mesh_.node_count(); ++node) {
      for (int axis = 0; axis < 3; ++axis)
        entries.emplace_back(3 * node + axis, 3 * node + axis, inertia_[0]);
      matrix_.ForEachBlock(node, [&](int64_t other, const float* block) {
        for (int k = 0; k < 9; ++k) {
          add(3 * node + k % 3, 3 * node + k / 3, block[k]);
          add(3 * node + k % 3, static_cast<int>(3 * other) + k / 3, -block[k]);
        }
      });
    }
    Eigen::SparseMatrix<double> sparse(size, size);
    sparse.setFromTriplets(entries.begin(), entries.end());
    Eigen::VectorXd rhs(size);
    for (int row = 0; row < size; ++row) rhs[row] = rhs_[static_cast<size_t>(row / 3)][row % 3];
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(1e-10);
    solver.compute(sparse);
    const Eigen::VectorXd solution = solver.solve(rhs);
    EXPECT_GT(solution.norm(), 0);
    return solver.iterations();
  }

  Eigen::Vector3d Position(int32_t node) const {
    return Eigen::Vector3d(mesh_.rest_positions[static_cast<size_t>(node)].data());
  }

  const TetMesh mesh_ = KuhnBox({40, 5, 5}, {8, 1, 1});
  const Incidence incidence_ = BuildIncidence(mesh_);
  StiffnessMatrix matrix_;
  std::vector<double> inertia_;
  NodalVector positions_;
  std::vector<FixedNode> fixed_;
  NodalVector rhs_;
};

TEST_F(CoarseSpaceTest, WhatIsLeftAfterItsCorrectionPushesNoPatch) {
  CoarseSpace coarse(mesh_.node_count(), mesh_.node_count(), fixed_);
  ASSERT_TRUE(coarse.pays());
  const Double4 spring[3] = {{2, 1, 0, 0}, {1, 3, -1, 0}, {0, -1, 4, 0}};
  matrix_.couplings().AddSpring(100, 1400, spring);
  matrix_.Finish(inertia_);
  ASSERT_TRUE(coarse.Prepare(matrix_, positions_));
  coarse.Solve(rhs_);
  NodalVector correction(rhs_.size()), product(rhs_.size());
  for (size_t node = 0; node < rhs_.size(); ++node)
    correction[node] = coarse.Correction(static_cast<int64_t>(node));
  for (const FixedNode& fixed : fixed_) {
    for (int axis = 0; axis < 3; ++axis) {
      if (fixed.axes[axis] != 0) {
        EXPECT_EQ(correction[static_cast<size_t>(fixed.node)][axis], 0);
      }
    }
  }
  matrix_.Multiply(correction, 1, 0, mesh_.node_count(), product);
  // The same space answers what is left with nothing.
  for (size_t node = 0; node < rhs_.size(); ++node) rhs_[node] -= product[node];
  double largest = 0;
  for (const Double4& moved : correction) largest = std::max(largest, Dot(moved, moved));
  coarse.Solve(rhs_);
  for (size_t node = 0; node < rhs_.size(); ++node) {
    const Double4 moved = coarse.Correction(static_cast<int64_t>(node));
    EXPECT_LT(Dot(moved, moved), 1e-10 * largest);
  }
}

TEST_F(CoarseSpaceTest, SparesAlongBarMostIterationsForTheSameSolution) {
  const StopFlag stop;
  NodalVector with(rhs_.size()), product(rhs_.size());
  PcgSolver pcg(mesh_.node_count(), mesh_.node_count(), fixed_, Precision::kDouble);
  pcg.Prepare(matrix_, positions_);
  const auto two_levels = pcg.Solve(matrix_, rhs_, 1e-10, stop, with);
  ASSERT_TRUE(two_levels.ok());
  EXPECT_TRUE(two_levels->positive);
  EXPECT_LT(3 * two_levels->iterations, IterationsOfOneLevel());
  matrix_.Multiply(with, 1, 0, mesh_.node_count(), product);
  for (const FixedNode& fixed : fixed_) {
    Double4& force = product[static_cast<size_t>(fixed.node)];
    force = fixed.axes ? Splat(0) : force;
  }
  for (size_t node = 0; node < rhs_.size(); ++node) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(product[node][axis], rhs_[node][axis], 1e-7);
  }
  // So heavy that a step's waves cross few cells, it is solved without patches.
  inertia_.assign(inertia_.size(), 10);
  matrix_.Finish(inertia_);
  pcg.Prepare(matrix_, positions_);
  const auto one_level = pcg.Solve(matrix_, rhs_, 1e-10, stop, with);
  ASSERT_TRUE(one_level.ok());
  EXPECT_LT(one_level->iterations, 40);
}

TEST_F(CoarseSpaceTest, AFewNodesHaveNoPatches) {
  EXPECT_FALSE(CoarseSpace(500, 500, {}).pays());
  EXPECT_EQ(CoarseSpace(500, 500, {}).bytes(), 0);
}

}  // namespace
}  // namespace cleave
