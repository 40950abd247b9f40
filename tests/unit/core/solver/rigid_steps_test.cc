#include "core/solver/rigid_steps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/model/build_model.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

// A place (m) after it turned about the z axis through `center`, which moved by `shift`.
Double4 Turned(Double4 at, Double4 center, double angle, Double4 shift) {
  const Double4 arm = at - center;
  const double c = std::cos(angle), s = std::sin(angle);
  return center + shift + Double4{c * arm[0] - s * arm[1], s * arm[0] + c * arm[1], arm[2], 0};
}

TEST(RigidSteps, EachPieceGoesOnAndTurnsAboutItsCentre) {
  const TetMesh mesh = KuhnBox({4, 2, 2}, {2, 1, 1});
  Scene scene = TightScene(1e5, 0.3, 1000, 0.01);
  const Model model = *BuildModel(scene, mesh);
  State state = InitialState(scene, mesh, model);
  // The left half turns about the z axis through its middle, the right one about that of its own.
  const auto is_left = [&](size_t node) { return model.mesh->rest_positions[node][0] < 1.1; };
  struct Part {
    double mass = 0;
    Double4 center = Splat(0);
    double rate = 0;  // rad/s
    Double4 velocity = Splat(0);
  };
  Part parts[2];
  parts[0].rate = 40, parts[1].rate = -25;
  parts[0].velocity = Double4{1, 2, 3, 0}, parts[1].velocity = Double4{-4, 0, 1, 0};
  const auto nodes = static_cast<size_t>(model.node_count());
  const auto part_of = [&](size_t node) -> Part& { return parts[is_left(node) ? 0 : 1]; };
  const auto at = [&](size_t node) { return ToDouble4(model.mesh->rest_positions[node]); };
  for (size_t node = 0; node < nodes; ++node) {
    part_of(node).mass += model.masses[node];
    part_of(node).center += model.masses[node] * at(node);
  }
  for (Part& part : parts) part.center = part.center / part.mass;
  for (size_t node = 0; node < nodes; ++node) {
    const Part& part = part_of(node);
    const Double4 arm = at(node) - part.center;
    state.velocities[node] = part.velocity + part.rate * Double4{-arm[1], arm[0], 0, 0};
  }
  std::vector<uint8_t> broken;
  for (const auto& [a, b] : model.incidence->edges)
    broken.push_back(is_left(static_cast<size_t>(a)) != is_left(static_cast<size_t>(b)) ? 1 : 0);
  RigidSteps steps(model);
  steps.SetBroken(broken);
  const double dt = 0.02;
  steps.BeginStep(state, dt);
  for (size_t node = 0; node < nodes; ++node) {
    const Part& part = part_of(node);
    const Double4 way =
        Turned(at(node), part.center, part.rate * dt, dt * part.velocity) - at(node);
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(steps.ways()[node][axis], way[axis], 1e-12);
  }
}

TEST(RigidSteps, LoneNodesAndPairsGoOnAsTheyMove) {
  const TetMesh mesh = KuhnBox({1, 1, 1}, {1, 1, 1});
  Scene scene = TightScene(1e5, 0.3, 1000, 0.01);
  const Model model = *BuildModel(scene, mesh);
  State state = InitialState(scene, mesh, model);
  for (size_t node = 0; node < state.velocities.size(); ++node) {
    const auto value = static_cast<double>(node);
    state.velocities[node] = Double4{value, -2 * value, 1 + value * value, 0};
  }
  std::vector<uint8_t> broken(model.incidence->edges.size(), 1);
  const auto& [a, b] = model.incidence->edges[0];
  broken[0] = 0;
  RigidSteps steps(model);
  steps.SetBroken(broken);
  steps.BeginStep(state, 1e-3);
  for (size_t node = 0; node < state.velocities.size(); ++node) {
    const bool paired = node == static_cast<size_t>(a) || node == static_cast<size_t>(b);
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(std::isfinite(steps.ways()[node][axis]));
      if (paired) continue;
      EXPECT_NEAR(steps.ways()[node][axis], 1e-3 * state.velocities[node][axis], 1e-15);
    }
  }
  // Of the pair, the middle goes on, and the length stays.
  const auto m = static_cast<size_t>(a), n = static_cast<size_t>(b);
  const Double4 apart =
      ToDouble4(model.mesh->rest_positions[m]) - ToDouble4(model.mesh->rest_positions[n]);
  const Double4 then = apart + steps.ways()[m] - steps.ways()[n];
  EXPECT_NEAR(std::sqrt(Dot(then, then)), std::sqrt(Dot(apart, apart)), 1e-12);
}

}  // namespace
}  // namespace cleave
