#include "core/model/collider_term.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/model/build_model.h"
#include "tests/unit/core/contact/test_surfaces.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kStep = 0.01;

double Random(uint64_t index, double reach) {
  return reach * (2 * UniformDraw(3, RandomStream::kMeshJitter, index, 0) - 1);
}

// A unit cube with colliders of every shape at its sides, some resting, some moving, some bodies.
Scene Surrounded() {
  Scene scene = TightScene(1e4, 0.3, 1000, kStep);
  scene.gravity = Vec3{0, 1, -9.81};
  const auto add = [&](const Shape& shape) -> Collider& {
    Collider& collider = scene.colliders.emplace_back();
    collider.shape = shape;
    collider.friction = 0.4;
    return collider;
  };
  add(PlaneShape{{0, 0, 0.05}, {0.1, 0, 1}});
  Collider& paddle = add(BoxShape{{-0.4, 0.5, 0.5}, {1, 1, 1}, {0, 0, 1}, 0.2});
  paddle.rotation_center = {-0.4, 0.5, 0.5};
  paddle.keyframes = {{0, {0, 0, 0}, 0}, {1, {0.4, 0, 0}, 0.5}};
  Collider& ball = add(SphereShape{{0.5, 0.5, 1.25}, 0.4});
  ball.body.emplace().density = 2000;
  ball.body->velocity = {0.2, 0.1, -1};
  ball.body->angular_velocity = {0, 1, 2};
  Collider& brick = add(BoxShape{{1.45, 0.4, 0.6}, {1, 0.7, 0.5}, {0, 1, 1}, 0.1});
  brick.body.emplace().mass = 50;
  brick.body->velocity = {-1, 0, 0};
  brick.body->angular_velocity = {1, 0, 0.5};
  add(SphereSurface({0.5, 1.35, 0.5}, 0.4, 2)).body.emplace().mass = 20;
  return scene;
}

struct Fixture {
  TetMesh mesh = KuhnBox({3, 3, 3}, {1, 1, 1});
  Scene scene = Surrounded();
  Model model = *BuildModel(scene, mesh);
  State state = InitialState(scene, mesh, model);
  NodeTerm& term = *model.node_terms[0];
  NodalVector forces;

  // Steps once by pushing everything a little, so that friction has normal forces to go by.
  void Touch() {
    term.BeginStep(0, kStep, state);
    State end = state;
    for (size_t n = 0; n < end.displacements.size(); ++n)
      end.displacements[n] += kStep * state.velocities[n];
    term.EndStep(end);
    term.Renew(end);
    state = end;
    term.BeginStep(kStep, 2 * kStep, state);
  }
  double Energy(const NodalVector& x) {
    forces.assign(x.size(), Splat(0));
    return term.AddForces(x, forces);
  }
  NodalVector Moved(double reach) const {
    NodalVector x = state.displacements;
    for (size_t n = 0; n < x.size(); ++n) {
      for (uint64_t k = 0; k < 3; ++k) x[n][k] += Random(3 * n + k, reach);
    }
    return x;
  }
};

TEST(ColliderTerm, MovingCollidersBringTwoUnknownsEach) {
  Fixture f;
  EXPECT_EQ(f.model.unknown_count(), f.mesh.node_count() + 6);
  EXPECT_EQ(f.state.velocities.size(), f.model.masses.size());
  // Half m v^2 and half w I w in one sum.
  double kinetic = 0;
  for (size_t n = static_cast<size_t>(f.mesh.node_count()); n < f.model.masses.size(); ++n)
    kinetic += 0.5 * f.model.masses[n] * Dot(f.state.velocities[n], f.state.velocities[n]);
  const double ball = 2000 * 4.0 / 3 * std::acos(-1.0) * 0.064;
  RigidBody body;
  body.mass = 50;
  const MassProperties brick = MassOf(f.scene.colliders[3].shape, body);
  const Eigen::Vector3d spin = brick.axes.transpose() * Eigen::Vector3d(1, 0, 0.5);
  EXPECT_NEAR(
      kinetic,
      0.5 * ball * (1.05 + 0.4 * 0.16 * 5) + 25 + 0.5 * spin.dot(brick.moments.cwiseProduct(spin)),
      1e-9);
}

TEST(ColliderTerm, ForcesAreTheSlopeOfTheEnergy) {
  Fixture f;
  f.Touch();
  const NodalVector x = f.Moved(0.01);
  f.Energy(x);
  const NodalVector forces = f.forces;
  int touched = 0;
  for (size_t n = 0; n < x.size(); ++n) {
    for (int axis = 0; axis < 3; ++axis) {
      constexpr double kDifference = 1e-7;
      NodalVector more = x, less = x;
      more[n][axis] += kDifference;
      less[n][axis] -= kDifference;
      const double slope = (f.Energy(more) - f.Energy(less)) / (2 * kDifference);
      EXPECT_NEAR(-slope, forces[n][axis], 1e-4 + 1e-5 * std::abs(slope)) << n << " " << axis;
      touched += slope != 0;
    }
  }
  EXPECT_GT(touched, 60);
}

TEST(ColliderTerm, StiffnessIsTheSlopeOfTheForcesWhereSurfacesAreFlat) {
  // Balls turn their normals and levers change with the pose, which the stiffness leaves out to
  // stay positive; against a plane and with friction that sticks it is exact.
  Fixture f;
  f.scene.colliders.resize(1);
  f.scene.colliders[0].friction = 10;
  f.model = *BuildModel(f.scene, f.mesh);
  f.state = InitialState(f.scene, f.mesh, f.model);
  NodeTerm& term = *f.model.node_terms[0];
  term.BeginStep(0, kStep, f.state);
  term.EndStep(f.state);
  term.BeginStep(kStep, 2 * kStep, f.state);
  const NodalVector x = f.Moved(1e-4);
  NodeCouplings couplings;
  term.AddStiffness(x, Curvature::kSemidefinite, couplings);
  couplings.Gather();
  ASSERT_FALSE(couplings.empty());
  constexpr double kDifference = 1e-6;
  for (size_t n = 0; n < x.size(); ++n) {
    for (int axis = 0; axis < 3; ++axis) {
      NodalVector more = x, less = x;
      more[n][axis] += kDifference;
      less[n][axis] -= kDifference;
      NodalVector up(x.size(), Splat(0)), down = up;
      term.AddForces(more, up);
      term.AddForces(less, down);
      Double4 column = Splat(0);
      for (const auto& entry : couplings.Rows(static_cast<int64_t>(n), static_cast<int64_t>(n) + 1))
        column += entry.columns[axis];
      for (int row = 0; row < 3; ++row) {
        EXPECT_NEAR(column[row], -(up[n][row] - down[n][row]) / (2 * kDifference), 1e-2)
            << n << " " << axis;
      }
    }
  }
}

TEST(ColliderTerm, StiffnessIsPositiveAndSymmetric) {
  Fixture f;
  f.Touch();
  const NodalVector x = f.Moved(0.01);
  NodeCouplings couplings;
  f.term.AddStiffness(x, Curvature::kSemidefinite, couplings);
  couplings.Gather();
  const auto count = static_cast<Eigen::Index>(3 * x.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(count, count);
  for (const auto& entry : couplings.Rows(0, f.model.unknown_count())) {
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column)
        matrix(3 * entry.row + row, 3 * entry.column + column) += entry.columns[column][row];
    }
  }
  EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm());
  const Eigen::VectorXd eigenvalues =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
  EXPECT_GT(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff());
}

TEST(ColliderTerm, NodesAndBodiesPushEachOtherEqually) {
  Fixture f;
  f.scene.gravity.reset();
  f.scene.colliders.erase(f.scene.colliders.begin(), f.scene.colliders.begin() + 2);
  f.model = *BuildModel(f.scene, f.mesh);
  f.state = InitialState(f.scene, f.mesh, f.model);
  NodeTerm& term = *f.model.node_terms[0];
  term.BeginStep(0, kStep, f.state);
  NodalVector forces(f.state.displacements.size(), Splat(0));
  term.AddForces(f.Moved(0.01), forces);
  Double4 sum = Splat(0);
  double size = 0;
  for (size_t n = 0; n < forces.size(); ++n) {
    // Turns are no forces.
    const bool turn = n > static_cast<size_t>(f.mesh.node_count()) &&
                      (n - static_cast<size_t>(f.mesh.node_count())) % 2 == 1;
    if (turn) continue;
    sum += forces[n];
    size += std::sqrt(Dot(forces[n], forces[n]));
  }
  EXPECT_GT(size, 1);
  EXPECT_LT(std::sqrt(Dot(sum, sum)), 1e-13 * size);
}

TEST(ColliderTerm, ForcesOnNodesDeepInsideAreBounded) {
  Fixture f;
  f.scene.colliders.resize(1);
  f.scene.colliders[0].shape = SphereShape{{0.5, 0.5, 0.5}, 100};
  f.model = *BuildModel(f.scene, f.mesh);
  f.state = InitialState(f.scene, f.mesh, f.model);
  NodeTerm& term = *f.model.node_terms[0];
  term.BeginStep(0, kStep, f.state);
  NodalVector forces(f.state.displacements.size(), Splat(0));
  EXPECT_TRUE(std::isfinite(term.AddForces(f.state.displacements, forces)));
  const double h = f.model.mean_edge_length;
  for (const Double4& force : forces)
    EXPECT_NEAR(std::sqrt(Dot(force, force)), 5 * 1e4 * h * h, 1e-6);
}

TEST(ColliderTerm, BytesAreAtMostThosePlanned) {
  Fixture f;
  f.Touch();
  int64_t planned = static_cast<int64_t>(f.model.node_count()) * ColliderTerm::BytesPerNode() + 8;
  for (const Collider& collider : f.scene.colliders) {
    const auto* surface = std::get_if<SurfaceShape>(&collider.shape);
    planned += ColliderTerm::BytesOf(collider.keyframes.size(),
                                     surface != nullptr ? surface->triangles.size() : 0);
  }
  // Vectors grow by doubling.
  EXPECT_LE(f.term.bytes(), 2 * planned);
  EXPECT_GE(f.term.bytes(), planned / 4);
}

TEST(ColliderTerm, RefusesTheStateOfAnotherScene) {
  Fixture f;
  f.Touch();
  std::string saved;
  ByteWriter out(saved);
  f.term.Save(out);
  ByteReader whole(saved);
  EXPECT_TRUE(f.term.Restore(whole).ok());
  ByteReader cut(absl::string_view(saved).substr(0, saved.size() / 2));
  EXPECT_EQ(f.term.Restore(cut).code(), absl::StatusCode::kDataLoss);
  saved[8] = 99;  // the first collider's number
  ByteReader other(saved);
  EXPECT_EQ(f.term.Restore(other).code(), absl::StatusCode::kDataLoss);
}

}  // namespace
}  // namespace cleave
