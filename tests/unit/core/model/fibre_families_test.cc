#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/model/elastic_term.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/model/dense_term.h"

namespace cleave {
namespace {

constexpr double kStiffness = 3000;  // Pa, of fibres

class FibreFamiliesTest : public ::testing::TestWithParam<Precision> {
 protected:
  // With a family of fibres along each of these unit directions.
  std::unique_ptr<TetTerm> TermWith(Precision precision,
                                    const std::vector<Vec3>& directions) const {
    const auto tets = static_cast<size_t>(mesh_.tet_count());
    ElasticPart part{.lame = {ToLame(1000, 0.3)}};
    for (const Vec3& direction : directions) {
      part.fibres.push_back(
          {std::vector<Vec3>(tets, direction), std::vector<double>(tets, kStiffness)});
    }
    return MakeElasticTerm(precision, mesh_, incidence_, part, FractureStress::kTotal);
  }
  NodalVector Stretched(const Eigen::Vector3d& stretches) const {
    NodalVector displacements;
    for (const Vec3& x : mesh_.rest_positions) {
      displacements.push_back(Double4{(stretches[0] - 1) * x[0], (stretches[1] - 1) * x[1],
                                      (stretches[2] - 1) * x[2], 0});
    }
    return displacements;
  }
  // Every tet its own way, some of them inside out where `share` is large.
  NodalVector Wrung(double share) const {
    NodalVector displacements;
    for (const Vec3& x : mesh_.rest_positions) {
      displacements.push_back(share * Double4{0.2 * std::sin(5 * x[1] + 3 * x[2]),
                                              0.2 * std::cos(7 * x[0] * x[2]),
                                              0.1 * (x[0] * x[0] - 2 * x[1]), 0});
    }
    return displacements;
  }
  Eigen::MatrixXd Stiffness(TetTerm& term, const NodalVector& displacements,
                            Curvature curvature) const {
    return DenseStiffness(term, incidence_, displacements, curvature);
  }
  // What fibres along x have of the energy, J.
  double FibreEnergy(TetTerm& term, const NodalVector& displacements) const {
    const std::unique_ptr<TetTerm> plain = TermWith(GetParam(), {});
    NodalVector forces(displacements.size(), Splat(0));
    return term.AddForces(displacements, forces) - plain->AddForces(displacements, forces);
  }
  // Of fibres along x that are longer than they want to be by this share of their rest length, J.
  double EnergyAt(double excess) const { return kVolume * kStiffness / 2 * excess * excess; }

  static constexpr double kVolume = 6;      // m^3
  static constexpr double kRounding = 0.1;  // J
  const TetMesh mesh_ = KuhnBox({3, 2, 1}, {3, 2, 1});
  const Incidence incidence_ = BuildIncidence(mesh_);
};

INSTANTIATE_TEST_SUITE_P(Precisions, FibreFamiliesTest,
                         ::testing::Values(Precision::kDouble, Precision::kFloat));

TEST_P(FibreFamiliesTest, FibresTurnOverAtTheStartOfAStepOnlyAndBackAtATrial) {
  const std::unique_ptr<TetTerm> term = TermWith(GetParam(), {{1, 0, 0}});
  const NodalVector upright = Stretched({1.25, 1, 1}), inverted = Stretched({-0.75, 1, 1});
  for (int step = 0; step < 2; ++step) {
    EXPECT_FALSE(term->ChooseBranches(upright, BranchChoice::kStart));
    EXPECT_NEAR(FibreEnergy(*term, upright), EnergyAt(0.25), kRounding);

    EXPECT_FALSE(term->ChooseBranches(inverted, BranchChoice::kTrial));
    EXPECT_NEAR(FibreEnergy(*term, inverted), EnergyAt(-0.25), kRounding);
    EXPECT_TRUE(term->ChooseBranches(inverted, BranchChoice::kStart));
    EXPECT_NEAR(FibreEnergy(*term, inverted), EnergyAt(1.75), kRounding);

    EXPECT_FALSE(term->ChooseBranches(inverted, BranchChoice::kTrial));
    EXPECT_FALSE(term->ChooseBranches(upright, BranchChoice::kAccepted));
    EXPECT_NEAR(FibreEnergy(*term, inverted), EnergyAt(1.75), kRounding);
    EXPECT_TRUE(term->ChooseBranches(upright, BranchChoice::kTrial));
    EXPECT_NEAR(FibreEnergy(*term, upright), EnergyAt(0.25), kRounding);
  }
}

TEST_P(FibreFamiliesTest, ATrialTurnsBackFibresOfTetsThatWereLeftOut) {
  const std::unique_ptr<TetTerm> term = TermWith(GetParam(), {{1, 0, 0}});
  const NodalVector upright = Stretched({1.25, 1, 1}), inverted = Stretched({-0.75, 1, 1});
  std::vector<uint8_t> asleep(static_cast<size_t>(mesh_.tet_count()), 1);
  term->LeaveOut(asleep, upright);
  EXPECT_FALSE(term->ChooseBranches(upright, BranchChoice::kStart));
  term->LeaveOut({}, inverted);
  EXPECT_TRUE(term->ChooseBranches(upright, BranchChoice::kTrial));
  EXPECT_NEAR(FibreEnergy(*term, upright), EnergyAt(0.25), kRounding);
}

TEST_P(FibreFamiliesTest, ExactStiffnessIsTheForcesDerivative) {
  const std::vector<Vec3> directions = {{1, 0, 0}, {0.6, 0.8, 0}, {0, 0.6, -0.8}};
  const std::unique_ptr<TetTerm> term = TermWith(GetParam(), directions);
  // Differences of what float has rounded say little.
  const std::unique_ptr<TetTerm> in_double = TermWith(Precision::kDouble, directions);
  const NodalVector displacements = Wrung(1);
  const Eigen::MatrixXd stiffness = Stiffness(*term, displacements, Curvature::kExact);
  const int size = static_cast<int>(stiffness.rows());
  const double h = 1e-5;
  for (int i = 0; i < size; ++i) {
    NodalVector up = displacements, down = displacements;
    up[static_cast<size_t>(i / 3)][i % 3] += h;
    down[static_cast<size_t>(i / 3)][i % 3] -= h;
    const Eigen::VectorXd column =
        -(DenseForces(*in_double, up) - DenseForces(*in_double, down)) / (2 * h);
    EXPECT_NEAR((column - stiffness.col(i)).norm(), 0, 3e-6 * stiffness.norm()) << i;
  }
}

TEST_P(FibreFamiliesTest, ProjectedStiffnessOfFibresHasNoNegativeEigenvalue) {
  const std::vector<Vec3> directions = {{1, 0, 0}, {0.6, 0.8, 0}, {0, 0.6, -0.8}};
  const std::unique_ptr<TetTerm> term = TermWith(GetParam(), directions);
  const std::unique_ptr<TetTerm> bare = TermWith(GetParam(), {});
  for (const double share :
       {1.0, 4.0}) {  // some fibres pressed; then the rest stretched or turned over
    const NodalVector displacements = Wrung(share);
    EXPECT_EQ(term->ChooseBranches(displacements, BranchChoice::kStart), share > 1);
    const auto least_over_largest = [&](Curvature curvature) {
      const Eigen::MatrixXd of_fibres =
          Stiffness(*term, displacements, curvature) - Stiffness(*bare, displacements, curvature);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(of_fibres);
      return solver.eigenvalues()(0) / solver.eigenvalues().tail(1)(0);
    };
    // Blocks are stored in float.
    EXPECT_GE(least_over_largest(Curvature::kSemidefinite), -1e-6) << share;
    if (share == 1) {
      EXPECT_LT(least_over_largest(Curvature::kExact), -1e-3);
    }
  }
}

}  // namespace
}  // namespace cleave
