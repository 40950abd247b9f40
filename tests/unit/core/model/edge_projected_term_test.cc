#include "core/model/edge_projected_term.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/counter_rng.h"
#include "core/model/elastic_term.h"
#include "core/model/tet_batches.h"
#include "tests/unit/core/model/dense_term.h"

namespace cleave {
namespace {

// A tet whose nodes are not in order, as the mesh's may be.
TetMesh OneTet() {
  TetMesh mesh;
  mesh.rest_positions = {{0.2, 0.9, 0.1}, {0, 0, 0}, {0.1, 0.2, 1.1}, {1, 0.1, 0}};
  mesh.tets = {{1, 3, 0, 2}};
  return mesh;
}

class EdgeProjectedTermTest : public ::testing::Test {
 protected:
  EdgeProjectedTermTest() {
    elastic_->AddRestModuli(0, isotropic_);
    fibrous_->AddRestModuli(0, moduli_);
  }

  double Draw(uint64_t index) {
    return 2 * UniformDraw(7, RandomStream::kNodeNoise, index, draws_++) - 1;
  }
  NodalVector Random(double size) {
    NodalVector displacements;
    for (uint64_t node = 0; node < 4; ++node)
      displacements.push_back(size * Double4{Draw(node), Draw(node), Draw(node), 0});
    return displacements;
  }
  Eigen::MatrixXd Stiffness(TetTerm& term, const NodalVector& displacements,
                            Curvature curvature) const {
    return DenseStiffness(term, incidence_, displacements, curvature);
  }
  static NodalVector Moved(NodalVector displacements, int coordinate, double by) {
    displacements[static_cast<size_t>(coordinate / 3)][coordinate % 3] += by;
    return displacements;
  }
  std::unique_ptr<TetTerm> Make(ElasticLaw law, bool with_fibres) const {
    ElasticPart part{.law = law, .lame = {ToLame(1000, 0.3)}};
    if (with_fibres) part.fibres = {{{{0.6, 0, 0.8}}, {2000}}};
    return MakeElasticTerm(Precision::kDouble, mesh_, incidence_, std::move(part),
                           FractureStress::kMatrix);
  }
  EdgeProjectedTerm Projected(EdgeMask mask) const {
    EdgeProjectedTerm term(mesh_, incidence_);
    term.Put(0, mask, moduli_, 1);
    return term;
  }

  const TetMesh mesh_ = OneTet();
  const Incidence incidence_ = BuildIncidence(mesh_);
  const std::unique_ptr<TetTerm> elastic_ = Make(ElasticLaw::kStVenantKirchhoff, false);
  const std::unique_ptr<TetTerm> fibrous_ = Make(ElasticLaw::kStVenantKirchhoff, true);
  Matrix6 isotropic_ = Matrix6::Zero(), moduli_ = Matrix6::Zero();
  uint64_t draws_ = 0;
};

TEST_F(EdgeProjectedTermTest, IntactATetIsAStVenantKirchhoffSolid) {
  EdgeProjectedTerm term(mesh_, incidence_);
  term.Put(0, 0, isotropic_, 1);
  for (int k = 0; k < 20; ++k) {
    const NodalVector displacements = Random(0.5);
    const double energy = elastic_->TetEnergy(0, displacements);
    EXPECT_NEAR(term.TetEnergy(0, displacements), energy, 1e-12 * energy);
    const Eigen::VectorXd forces = DenseForces(*elastic_, displacements);
    EXPECT_NEAR((DenseForces(term, displacements) - forces).norm(), 0, 1e-12 * forces.norm());
  }
}

TEST_F(EdgeProjectedTermTest, IntactItsFibresAreTheirEnergyAtSmallStrain) {
  EdgeProjectedTerm term(mesh_, incidence_);
  term.Put(0, 0, moduli_ - isotropic_, 1);
  const NodalVector displacements = Random(1e-5);
  const double energy =
      fibrous_->TetEnergy(0, displacements) - elastic_->TetEnergy(0, displacements);
  EXPECT_NEAR(term.TetEnergy(0, displacements), energy, 1e-4 * energy);
}

TEST_F(EdgeProjectedTermTest, TermsTellTheEnergyOfATet) {
  NodalVector forces(4, Splat(0));
  const NodalVector displacements = Random(0.3);
  EXPECT_EQ(elastic_->TetEnergy(0, displacements), elastic_->AddForces(displacements, forces));
  EXPECT_EQ(fibrous_->TetEnergy(0, displacements), fibrous_->AddForces(displacements, forces));
}

TEST_F(EdgeProjectedTermTest, ForcesAreTheEnergysDescentForEveryMask) {
  for (int mask = 0; mask < kEdgeMasks; ++mask) {
    EdgeProjectedTerm term = Projected(static_cast<EdgeMask>(mask));
    const NodalVector displacements = Random(0.5);
    const Eigen::VectorXd forces = DenseForces(term, displacements);
    const double h = 1e-5;
    for (int i = 0; i < 12; ++i) {
      const double slope = (term.TetEnergy(0, Moved(displacements, i, h)) -
                            term.TetEnergy(0, Moved(displacements, i, -h))) /
                           (2 * h);
      EXPECT_NEAR(-slope, forces[i], 1e-6 * forces.norm()) << mask;
    }
  }
}

TEST_F(EdgeProjectedTermTest, ExactStiffnessIsTheForcesDerivativeAndTheOtherHasNoNegative) {
  double lowest_exact = 0;
  for (int mask = 0; mask < kEdgeMasks; ++mask) {
    EdgeProjectedTerm term = Projected(static_cast<EdgeMask>(mask));
    const NodalVector displacements = Random(0.5);
    const Eigen::MatrixXd exact = Stiffness(term, displacements, Curvature::kExact);
    const double h = 1e-5;
    for (int i = 0; i < 12; ++i) {
      const Eigen::VectorXd column = -(DenseForces(term, Moved(displacements, i, h)) -
                                       DenseForces(term, Moved(displacements, i, -h))) /
                                     (2 * h);
      EXPECT_NEAR((column - exact.col(i)).norm(), 0, 3e-6 * exact.norm() + 1e-12) << mask;
    }
    const Eigen::MatrixXd semidefinite = Stiffness(term, displacements, Curvature::kSemidefinite);
    const auto lowest = [](const Eigen::MatrixXd& matrix) {
      return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues()[0];
    };
    EXPECT_GE(lowest(semidefinite), -1e-6 * semidefinite.norm()) << mask;
    lowest_exact = std::min(lowest_exact, lowest(exact) / (exact.norm() + 1e-300));
  }
  EXPECT_LT(lowest_exact, -1e-3);
}

TEST_F(EdgeProjectedTermTest, ForcesAddUpToNoForceAndNoTorqueAndNoneCrossesASeparatedCut) {
  for (int mask = 0; mask < kEdgeMasks; ++mask) {
    EdgeProjectedTerm term = Projected(static_cast<EdgeMask>(mask));
    const NodalVector displacements = Random(0.5);
    const Eigen::VectorXd forces = DenseForces(term, displacements);
    Eigen::Vector3d sum = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
    for (int node = 0; node < 4; ++node) {
      const auto n = static_cast<size_t>(node);
      const Double4 at = ToDouble4(mesh_.rest_positions[n]) + displacements[n];
      sum += forces.segment<3>(3 * node);
      torque +=
          Eigen::Vector3d(at[0], at[1], at[2]).cross(Eigen::Vector3d(forces.segment<3>(3 * node)));
    }
    EXPECT_LE(sum.norm(), 1e-12 * forces.norm());
    EXPECT_LE(torque.norm(), 1e-12 * forces.norm());
    const VertexGroups& groups = kVertexGroups[static_cast<size_t>(mask)];
    for (int8_t group = 0; group < 4; ++group) {
      Eigen::Vector3d across = Eigen::Vector3d::Zero();
      int members = 0;
      for (size_t vertex = 0; vertex < 4; ++vertex) {
        if (groups.group[vertex] != group) continue;
        ++members;
        across += forces.segment<3>(3 * mesh_.tets[0][vertex]);
      }
      if (groups.count > 1) {
        EXPECT_LE(across.norm(), members == 1 ? 0 : 1e-15 * forces.norm()) << mask;
      }
    }
  }
}

TEST_F(EdgeProjectedTermTest, DoesNoWorkRoundAClosedCycle) {
  for (int mask = 1; mask < kEdgeMasks; ++mask) {
    EdgeProjectedTerm term = Projected(static_cast<EdgeMask>(mask));
    const NodalVector corners[3] = {Random(0.5), Random(0.5), Random(0.5)};
    double work = 0, exchanged = 0;
    for (size_t side = 0; side < 3; ++side) {
      // Forces are cubic along a side: two points of Gauss integrate them exactly.
      for (const double share : {0.5 - 0.5 / std::sqrt(3.0), 0.5 + 0.5 / std::sqrt(3.0)}) {
        NodalVector between(4);
        Eigen::VectorXd way(12);
        for (size_t node = 0; node < 4; ++node) {
          const Double4 step = corners[(side + 1) % 3][node] - corners[side][node];
          between[node] = corners[side][node] + share * step;
          for (int axis = 0; axis < 3; ++axis) way[3 * static_cast<int>(node) + axis] = step[axis];
        }
        const double part = 0.5 * DenseForces(term, between).dot(way);
        work += part;
        exchanged += std::abs(part);
      }
    }
    EXPECT_LE(std::abs(work), 1e-12 * exchanged + 1e-300) << mask;
  }
}

TEST_F(EdgeProjectedTermTest, EnergyNeverRisesAtABreakAndBetaNever) {
  const std::unique_ptr<TetTerm> neo_hookean = Make(ElasticLaw::kStableNeoHookean, true);
  int scaled = 0;
  for (int round = 0; round < 300; ++round) {
    EdgeProjectedTerm term(mesh_, incidence_);
    const NodalVector displacements = Random(0.1 + 0.004 * round);
    double energy = neo_hookean->TetEnergy(0, displacements);
    double beta = 1;
    EdgeMask mask = 0;
    for (int k = 0; k < 3; ++k) {
      mask |= static_cast<EdgeMask>(1u << static_cast<int>(3 * (Draw(99) + 1)));
      if (Separated(mask)) break;
      term.Weaken(0, mask, moduli_, 1, energy, displacements);
      const double after = term.TetEnergy(0, displacements);
      EXPECT_LE(after, energy * (1 + 1e-14));
      EXPECT_GE(after, 0);
      EXPECT_LE(term.betas()[0], beta);
      scaled += term.betas()[0] < beta ? 1 : 0;
      beta = term.betas()[0];
      energy = after;
    }
  }
  EXPECT_GT(scaled, 30);
}

TEST_F(EdgeProjectedTermTest, IsFiniteInsideOutAndCollapsed) {
  for (int mask = 0; mask < kEdgeMasks; ++mask) {
    EdgeProjectedTerm term = Projected(static_cast<EdgeMask>(mask));
    NodalVector collapsed, mirrored;
    for (const Vec3& x : mesh_.rest_positions) {
      collapsed.push_back(-ToDouble4(x));
      mirrored.push_back(-2 * ToDouble4(x));
    }
    for (const NodalVector& displacements : {collapsed, mirrored, Random(1e3)}) {
      EXPECT_TRUE(std::isfinite(term.TetEnergy(0, displacements)));
      EXPECT_TRUE(DenseForces(term, displacements).allFinite());
      EXPECT_TRUE(Stiffness(term, displacements, Curvature::kSemidefinite).allFinite());
    }
    // A reflection changes no length.
    EXPECT_NEAR(term.TetEnergy(0, mirrored), 0, 1e-12);
  }
}

TEST_F(EdgeProjectedTermTest, DeadTetsLeaveAndBytesFollow) {
  EdgeProjectedTerm term = Projected(1);
  EXPECT_EQ(term.bytes(), EdgeProjectedTerm::TetBytes());
  term.SetDamageFactor(0, 0.5);
  EXPECT_GT(term.TetEnergy(0, Random(0.5)), 0);
  term.SetDamageFactor(0, 0);
  EXPECT_EQ(term.TetEnergy(0, Random(0.5)), 0);
  EXPECT_EQ(term.bytes(), 0);
}

}  // namespace
}  // namespace cleave
