// The method note's end-to-end scenario: a bar with a weak zone, pulled apart. The staging of
// fracture is what is tested here, so the solver is the plainest that can be exact: backward Euler,
// Newton with dense matrices and difference quotients of the stress.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "core/damage/fracture.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using ::testing::ElementsAre;

using NodePair = std::array<int32_t, 2>;

// Reference values of the method note.
const std::vector<NodePair> kBrokenEdges = {
    {18, 27}, {18, 28}, {18, 30}, {18, 31}, {19, 28}, {19, 29}, {19, 31}, {19, 32}, {20, 29},
    {20, 32}, {21, 30}, {21, 31}, {21, 33}, {21, 34}, {22, 31}, {22, 32}, {22, 34}, {22, 35},
    {23, 32}, {23, 35}, {24, 33}, {24, 34}, {25, 34}, {25, 35}, {26, 35}};

class PulledBar {
 public:
  PulledBar(double dt, StressAggregation aggregation)
      : dt_(dt),
        thresholds_(Thresholds()),
        fracture_(mesh_, incidence_, Broadcast<double>::PerItem(thresholds_.data()),
                  {.simultaneity = 0.9, .aggregation = aggregation}) {
    const auto nodes = static_cast<Eigen::Index>(mesh_.rest_positions.size());
    positions_.resize(3 * nodes);
    velocities_ = VectorXd::Zero(3 * nodes);
    masses_ = VectorXd::Zero(nodes);
    for (Eigen::Index node = 0; node < nodes; ++node) {
      const Vec3& rest = mesh_.rest_positions[static_cast<size_t>(node)];
      positions_.segment<3>(3 * node) = Vector3d(rest.data());
      speeds_.push_back(rest[0] > 3 - 1e-9 ? 0.15 : 0);  // m/s, of given nodes
      given_.push_back(rest[0] < 1e-9 || rest[0] > 3 - 1e-9);
    }
    for (const std::array<int32_t, 4>& tet : mesh_.tets) {
      const Matrix3d edges = EdgeMatrix(tet, positions_);
      inverse_rest_.push_back(edges.inverse());
      volumes_.push_back(edges.determinant() / 6);
      for (const int32_t node : tet) masses_[node] += kDensity * volumes_.back() / 4;
    }
  }

  struct Pass {
    int step;
    size_t edges;
    bool operator==(const Pass& other) const { return step == other.step && edges == other.edges; }
  };

  // Runs until `end` (s).
  void Run(double end) {
    for (int step = 1; step * dt_ <= end + 1e-9; ++step) {
      const VectorXd inertial = positions_ + dt_ * velocities_;
      VectorXd next = inertial;
      for (size_t node = 0; node < given_.size(); ++node) {
        const auto i = static_cast<Eigen::Index>(3 * node);
        if (!given_[node]) continue;
        next.segment<3>(i) = positions_.segment<3>(i);
        next[i] += speeds_[node] * dt_;
      }
      for (;;) {
        Solve(inertial, next);
        const PassResult result = Break(next);
        if (result.broken_edges.empty()) break;
        if (passes.empty()) {
          first_ratio = result.max_ratio;
          for (const int32_t edge : result.broken_edges)
            first_edges.push_back(incidence_.edges[static_cast<size_t>(edge)]);
        }
        passes.push_back({step, result.broken_edges.size()});
      }
      velocities_ = (next - positions_) / dt_;
      positions_ = next;
    }
  }

  std::vector<NodePair> BrokenEdges() const {
    std::vector<NodePair> pairs;
    for (const int32_t edge : fracture_.BrokenEdges())
      pairs.push_back(incidence_.edges[static_cast<size_t>(edge)]);
    return pairs;
  }
  EdgeFracture& fracture() { return fracture_; }

  std::vector<Pass> passes;
  double first_ratio = 0;
  std::vector<NodePair> first_edges;

 private:
  static constexpr double kYoungs = 1e5;  // Pa
  static constexpr double kPoisson = 0.3;
  static constexpr double kDensity = 10;  // kg/m^3

  std::vector<double> Thresholds() const {
    std::vector<double> thresholds;
    for (const auto& [a, b] : incidence_.edges) {
      const double middle = 0.5 * (mesh_.rest_positions[static_cast<size_t>(a)][0] +
                                   mesh_.rest_positions[static_cast<size_t>(b)][0]);
      const bool held = middle < 0.45 || middle > 2.55;
      const double strength = std::abs(middle - 1.25) < 0.3 ? 1500 : 3000;
      thresholds.push_back(held ? std::numeric_limits<double>::infinity() : strength);
    }
    return thresholds;
  }

  static Matrix3d EdgeMatrix(const std::array<int32_t, 4>& tet, const VectorXd& positions) {
    Matrix3d edges;
    for (int k = 0; k < 3; ++k) {
      edges.col(k) = positions.segment<3>(3 * tet[static_cast<size_t>(k + 1)]) -
                     positions.segment<3>(3 * tet[0]);
    }
    return edges;
  }
  // Stable Neo-Hookean (method note, section 5).
  static Matrix3d Stress(const Matrix3d& gradient) {
    constexpr double kMu = kYoungs / (2 * (1 + kPoisson));
    constexpr double kLambda = kYoungs * kPoisson / ((1 + kPoisson) * (1 - 2 * kPoisson));
    Matrix3d cofactor;
    cofactor << gradient.col(1).cross(gradient.col(2)), gradient.col(2).cross(gradient.col(0)),
        gradient.col(0).cross(gradient.col(1));
    return kMu * gradient + ((kLambda + kMu) * (gradient.determinant() - 1) - kMu) * cofactor;
  }

  void AddTet(size_t tet, const VectorXd& positions, VectorXd& forces, MatrixXd& stiffness) const {
    const std::array<int32_t, 4>& nodes = mesh_.tets[tet];
    const double scale = fracture_.damage_factors()[tet] * volumes_[tet];
    if (scale == 0) return;
    const Matrix3d gradient = EdgeMatrix(nodes, positions) * inverse_rest_[tet];
    Eigen::Matrix<double, 3, 4> shape;  // gradients of the shape functions
    shape.rightCols<3>() = inverse_rest_[tet].transpose();
    shape.col(0) = -shape.rightCols<3>().rowwise().sum();
    const Matrix3d stress = Stress(gradient);
    for (int i = 0; i < 4; ++i)
      forces.segment<3>(3 * nodes[static_cast<size_t>(i)]) += scale * stress * shape.col(i);
    constexpr double kStep = 1e-6;
    for (int j = 0; j < 4; ++j) {
      for (int axis = 0; axis < 3; ++axis) {
        Matrix3d change = Matrix3d::Zero();
        change.row(axis) = kStep * shape.col(j).transpose();
        const Matrix3d slope =
            (Stress(gradient + change) - Stress(gradient - change)) / (2 * kStep);
        for (int i = 0; i < 4; ++i) {
          stiffness.block<3, 1>(3 * nodes[static_cast<size_t>(i)],
                                3 * nodes[static_cast<size_t>(j)] + axis) +=
              scale * slope * shape.col(i);
        }
      }
    }
  }

  void Solve(const VectorXd& inertial, VectorXd& next) const {
    for (int iteration = 0; iteration < 30; ++iteration) {
      VectorXd forces(next.size());
      MatrixXd stiffness = MatrixXd::Zero(next.size(), next.size());
      for (Eigen::Index i = 0; i < next.size(); ++i) {
        stiffness(i, i) = masses_[i / 3] / (dt_ * dt_);
        forces[i] = stiffness(i, i) * (next[i] - inertial[i]);
      }
      for (size_t tet = 0; tet < mesh_.tets.size(); ++tet) AddTet(tet, next, forces, stiffness);
      for (Eigen::Index i = 0; i < next.size(); ++i) {
        if (!given_[static_cast<size_t>(i / 3)]) continue;
        forces[i] = 0;
        stiffness.row(i).setZero();
        stiffness.col(i).setZero();
        stiffness(i, i) = 1;
      }
      const VectorXd step = stiffness.partialPivLu().solve(-forces);
      next += step;
      if (step.cwiseAbs().maxCoeff() < 1e-10) return;
    }
    FAIL() << "Newton's method does not converge";
  }

  PassResult Break(const VectorXd& next) {
    std::vector<Vec3> positions(mesh_.rest_positions.size());
    for (size_t node = 0; node < positions.size(); ++node) {
      Eigen::Map<Vector3d>(positions[node].data()) =
          next.segment<3>(static_cast<Eigen::Index>(3 * node));
    }
    std::vector<Matrix3d> stress;
    for (size_t tet = 0; tet < mesh_.tets.size(); ++tet)
      stress.push_back(Stress(EdgeMatrix(mesh_.tets[tet], next) * inverse_rest_[tet]));
    return fracture_.BreakPass(positions, stress);
  }

  const TetMesh mesh_ = KuhnBox({6, 2, 2}, {3, 1, 1});
  const Incidence incidence_ = BuildIncidence(mesh_);
  const double dt_;
  const std::vector<double> thresholds_;
  EdgeFracture fracture_;
  VectorXd positions_, velocities_, masses_;
  std::vector<double> speeds_;
  std::vector<bool> given_;
  std::vector<Matrix3d> inverse_rest_;
  std::vector<double> volumes_;
};

void ExpectBrokenInTwo(PulledBar& bar) {
  EXPECT_EQ(bar.BrokenEdges(), kBrokenEdges);
  const std::span<const double> factors = bar.fracture().damage_factors();
  EXPECT_EQ(std::count(factors.begin(), factors.end(), 0.0), 24);
  EXPECT_EQ(bar.fracture().ComponentCount(), 2);
}

TEST(FractureScenario, BreaksInTheReferencePasses) {
  PulledBar bar(0.004, StressAggregation::kMean);
  bar.Run(0.32);
  EXPECT_NEAR(bar.first_ratio, 1.0021342176984573, 1e-9);
  EXPECT_THAT(bar.first_edges, ElementsAre(NodePair{22, 31}, NodePair{23, 32}, NodePair{25, 34}));
  using Pass = PulledBar::Pass;
  EXPECT_THAT(bar.passes, ElementsAre(Pass{71, 3}, Pass{71, 5}, Pass{71, 1}, Pass{73, 10},
                                      Pass{73, 2}, Pass{74, 4}));
  ExpectBrokenInTwo(bar);
}

TEST(FractureScenario, BreaksTheSameEdgesForOtherStepsAndAggregation) {
  for (const double dt : {0.002, 0.004, 0.008}) {
    for (const StressAggregation aggregation :
         {StressAggregation::kMean, StressAggregation::kMax}) {
      PulledBar bar(dt, aggregation);
      bar.Run(0.32);
      ExpectBrokenInTwo(bar);
    }
  }
}

}  // namespace
}  // namespace cleave
