#include "core/model/elastic_term.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/model/tet_batches.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/model/dense_term.h"

namespace cleave {
namespace {

class ElasticTermTest : public ::testing::Test {
 protected:
  // Displacements that bend, twist and turn some tets inside out.
  NodalVector Crumpled(double size) const {
    NodalVector displacements;
    for (const Vec3& x : mesh_.rest_positions) {
      displacements.push_back(Double4{size * std::sin(5 * x[1] + 3 * x[2]),
                                      size * std::cos(7 * x[0] * x[2]),
                                      size * (x[0] * x[0] - 2 * x[1]), 0});
    }
    return displacements;
  }
  double Energy(const NodalVector& displacements) const {
    NodalVector forces(displacements.size(), Splat(0));
    return term_->AddForces(displacements, forces);
  }
  Eigen::VectorXd Forces(const NodalVector& displacements) const {
    return DenseForces(*term_, displacements);
  }
  Eigen::MatrixXd Stiffness(const NodalVector& displacements, Curvature curvature) const {
    return DenseStiffness(*term_, incidence_, displacements, curvature);
  }

  const TetMesh mesh_ = KuhnBox({2, 1, 1}, {2, 1, 1});
  const Incidence incidence_ = BuildIncidence(mesh_);
  const std::unique_ptr<TetTerm> term_ =
      MakeElasticTerm(Precision::kDouble, mesh_, incidence_, {.lame = {ToLame(1000, 0.3)}},
                      FractureStress::kMatrix);
};

TEST_F(ElasticTermTest, HasTheReferenceEnergyOfABentBar) {
  NodalVector displacements;
  for (const Vec3& x : mesh_.rest_positions) {
    displacements.push_back(Double4{0.05 * x[0] * x[0] + 0.03 * x[1] * x[2], -0.02 * x[0] * x[1],
                                    0.04 * x[2] * x[0], 0});
  }
  EXPECT_NEAR(Energy(displacements), 23.90223686153844, 1e-11);
}

TEST_F(ElasticTermTest, ForcesAreTheEnergysDescent) {
  const NodalVector displacements = Crumpled(0.6);
  const Eigen::VectorXd forces = Forces(displacements);
  const double h = 1e-5;
  for (int i = 0; i < forces.size(); ++i) {
    NodalVector up = displacements, down = displacements;
    up[static_cast<size_t>(i / 3)][i % 3] += h;
    down[static_cast<size_t>(i / 3)][i % 3] -= h;
    EXPECT_NEAR(-(Energy(up) - Energy(down)) / (2 * h), forces[i], 1e-6 * forces.norm());
  }
}

TEST_F(ElasticTermTest, ExactStiffnessIsTheForcesDerivative) {
  const NodalVector displacements = Crumpled(0.6);
  const Eigen::MatrixXd stiffness = Stiffness(displacements, Curvature::kExact);
  const double h = 1e-5;
  for (int i = 0; i < stiffness.cols(); ++i) {
    NodalVector up = displacements, down = displacements;
    up[static_cast<size_t>(i / 3)][i % 3] += h;
    down[static_cast<size_t>(i / 3)][i % 3] -= h;
    const Eigen::VectorXd column = -(Forces(up) - Forces(down)) / (2 * h);
    // Blocks are float.
    EXPECT_NEAR((column - stiffness.col(i)).norm(), 0, 3e-6 * stiffness.norm()) << i;
  }
}

TEST_F(ElasticTermTest, SemidefiniteStiffnessHasNoNegativeEigenvalue) {
  const NodalVector displacements = Crumpled(0.9);
  const auto lowest = [&](Curvature curvature) {
    const Eigen::MatrixXd stiffness = Stiffness(displacements, curvature);
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(stiffness).eigenvalues()[0] /
           stiffness.norm();
  };
  EXPECT_LT(lowest(Curvature::kExact), -1e-3);
  EXPECT_GT(lowest(Curvature::kSemidefinite), -1e-6);
}

TEST_F(ElasticTermTest, ForcesAddUpToNoForceAndNoTorque) {
  const NodalVector displacements = Crumpled(0.6);
  const Eigen::VectorXd forces = Forces(displacements);
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
  for (int node = 0; node < mesh_.node_count(); ++node) {
    const auto n = static_cast<size_t>(node);
    Eigen::Vector3d position;
    for (int axis = 0; axis < 3; ++axis)
      position[axis] = mesh_.rest_positions[n][static_cast<size_t>(axis)] + displacements[n][axis];
    force += forces.segment<3>(3 * node);
    torque += position.cross(Eigen::Vector3d(forces.segment<3>(3 * node)));
  }
  EXPECT_NEAR(force.norm(), 0, 1e-12 * forces.norm());
  EXPECT_NEAR(torque.norm(), 0, 1e-12 * forces.norm());
}

TEST_F(ElasticTermTest, ADamageFactorScalesEnergyForceAndStiffnessButNotEffectiveStress) {
  const NodalVector displacements = Crumpled(0.3);
  const double energy = Energy(displacements);
  const Eigen::VectorXd forces = Forces(displacements);
  const Eigen::MatrixXd stiffness = Stiffness(displacements, Curvature::kExact);
  std::vector<Eigen::Matrix3d> before(12, Eigen::Matrix3d::Zero()), after = before;
  term_->AddEffectiveStress(displacements, before);
  for (int64_t tet = 0; tet < 12; ++tet) term_->SetDamageFactor(tet, 0.25);
  term_->AddEffectiveStress(displacements, after);
  EXPECT_NEAR(Energy(displacements), 0.25 * energy, 1e-12 * energy);
  EXPECT_NEAR((Forces(displacements) - 0.25 * forces).norm(), 0, 1e-12 * forces.norm());
  EXPECT_NEAR((Stiffness(displacements, Curvature::kExact) - 0.25 * stiffness).norm(), 0,
              1e-6 * stiffness.norm());
  for (size_t tet = 0; tet < 12; ++tet) EXPECT_EQ(before[tet], after[tet]);
  for (int64_t tet = 0; tet < 12; ++tet) term_->SetDamageFactor(tet, 1);
  EXPECT_EQ(Energy(displacements), energy);
}

// Three cells in a row, the middle one dead: where the left one is does not matter to the right
// one, to the last bit, and neither is pushed as a whole.
TEST(DeadTets, LetNoForceAcross) {
  const TetMesh mesh = KuhnBox({3, 1, 1}, {3, 1, 1});
  const Incidence incidence = BuildIncidence(mesh);
  const auto is_left = [&](size_t node) { return mesh.rest_positions[node][0] < 1.5; };
  const auto term = MakeElasticTerm(Precision::kDouble, mesh, incidence,
                                    {.lame = {ToLame(1000, 0.3)}}, FractureStress::kMatrix);
  int dead = 0;
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    const auto left = std::count_if(mesh.tets[tet].begin(), mesh.tets[tet].end(),
                                    [&](int32_t n) { return is_left(static_cast<size_t>(n)); });
    if (left == 0 || left == 4) continue;
    term->SetDamageFactor(static_cast<int64_t>(tet), 0);
    ++dead;
  }
  ASSERT_EQ(dead, 6);
  NodalVector displacements;
  for (const Vec3& x : mesh.rest_positions)
    displacements.push_back(Double4{0.2 * std::sin(5 * x[1]), 0.3 * x[0] * x[2], 0.1 * x[0], 0});
  NodalVector before(displacements.size(), Splat(0)), after = before;
  term->AddForces(displacements, before);
  for (size_t node = 0; node < displacements.size(); ++node) {
    if (is_left(node)) displacements[node] += Double4{2, static_cast<double>(node), -1, 0};
  }
  term->AddForces(displacements, after);
  Double4 on_left = Splat(0), on_right = Splat(0);
  double size = 0;
  for (size_t node = 0; node < after.size(); ++node) {
    (is_left(node) ? on_left : on_right) += after[node];
    size += std::sqrt(Dot(after[node], after[node]));
    if (is_left(node)) continue;
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(after[node][axis], before[node][axis]);
    EXPECT_GT(Dot(before[node], before[node]), 0);
  }
  EXPECT_LE(Dot(on_left, on_left), 1e-28 * size * size);
  EXPECT_LE(Dot(on_right, on_right), 1e-28 * size * size);
}

TEST(ChunkColoring, NoColorHoldsANodeTwiceAndEveryChunkIsThereOnce) {
  const TetMesh mesh = KuhnBox({7, 6, 5}, {1, 1, 1});
  const ChunkColoring coloring = ColorChunks(mesh.tets, mesh.node_count(), 16);
  std::vector<int> uses(static_cast<size_t>((mesh.tet_count() + 15) / 16), 0);
  for (const auto& color : coloring.colors) {
    std::vector<int32_t> owner(static_cast<size_t>(mesh.node_count()), -1);
    for (const int32_t chunk : color) {
      ++uses[static_cast<size_t>(chunk)];
      for (int64_t tet = 16 * chunk; tet < std::min<int64_t>(16 * chunk + 16, mesh.tet_count());
           ++tet) {
        for (const int32_t node : mesh.tets[static_cast<size_t>(tet)]) {
          int32_t& of_node = owner[static_cast<size_t>(node)];
          EXPECT_TRUE(of_node == -1 || of_node == chunk);
          of_node = chunk;
        }
      }
    }
  }
  for (const int use : uses) EXPECT_EQ(use, 1);
}

TEST(ChunkColoring, ANodeInMoreChunksThanColorsOfARoundIsNoLimit) {
  std::vector<std::array<int32_t, 4>> star;
  for (int32_t tet = 0; tet < 200; ++tet)
    star.push_back({0, 3 * tet + 1, 3 * tet + 2, 3 * tet + 3});
  const ChunkColoring coloring = ColorChunks(star, 601, 1);
  EXPECT_EQ(coloring.colors.size(), 200u);
}

}  // namespace
}  // namespace cleave
