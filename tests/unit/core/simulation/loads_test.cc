#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "core/simulation/simulation.h"
#include "tests/unit/core/simulation/fracture_run.h"
#include "tests/unit/core/simulation/run_frames.h"

namespace cleave {
namespace {

const double kPi = std::acos(-1.0);
constexpr double kFar = 1e6;

TEST(Loads, ABarUnderATractionStretchesAsTheClosedForm) {
  const TetMesh mesh = KuhnBox({2, 2, 2}, {1, 1, 1});
  Scene scene = TightScene(1, 0.3, 1e-9, 1);
  AddSymmetryPlanes(scene);
  AddBoxSet(scene, "x1", {1 - 1e-9, -kFar, -kFar}, {kFar, kFar, kFar});
  scene.loads.push_back(
      {"x1", SurfaceTraction{{0.6538461538461537, 0, 0}}, {{0, 0}, {8, 1}}, std::nullopt});
  auto simulation = MustCreate(scene, mesh);
  FrameReport last;
  for (int step = 0; step < 10; ++step) last = MustAdvance(*simulation);
  EXPECT_NEAR(simulation->positions().back()[0], 2, 1e-6);
  EXPECT_NEAR(simulation->positions().back()[1], 0.7745966692414834, 1e-6);
  EXPECT_NEAR(last.motion_forces[0][0], -0.6538461538461537, 1e-6);
  // The integral of the load over the way is the energy, up to the steps' width.
  EXPECT_GT(last.external_work, last.elastic_energy);
  EXPECT_NEAR(last.external_work, last.elastic_energy, 0.15 * last.elastic_energy);
}

// A quarter of a tube, x and y > 0, one cell high and held there: plane strain.
TetMesh QuarterTube(int across, double inner, double outer) {
  const int around = 3 * across;
  TetMesh mesh = KuhnBox({across, around, 1}, {1, 1, (outer - inner) / across});
  for (Vec3& x : mesh.rest_positions) {
    const double radius = inner + (outer - inner) * x[0];
    const double angle = 0.5 * kPi * x[1];
    x = {x[1] == 1 ? 0 : radius * std::cos(angle), radius * std::sin(angle), x[2]};
  }
  return mesh;
}

// Share by which the inner wall of a tube under inner pressure moves out, over that of Lame.
double InflationOverLame(int across) {
  const double inner = 1, outer = 2, youngs = 1e6, poisson = 0.3, pressure = 10;
  const TetMesh mesh = QuarterTube(across, inner, outer);
  Scene scene = TightScene(youngs, poisson, 1e-6, 10);
  AddSymmetryPlanes(scene);
  AddBoxSet(scene, "flat", {-kFar, -kFar, -kFar}, {kFar, kFar, kFar});
  AddMotion(scene, "flat", {false, false, true});
  scene.motions.erase(scene.motions.begin() + 2);  // z0 is in it
  IdSelector wall;
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    const Vec3& x = mesh.rest_positions[node];
    if (std::hypot(x[0], x[1]) < inner + 1e-9) wall.ids.push_back(static_cast<int64_t>(node));
  }
  scene.node_sets.push_back({"wall", {wall}});
  scene.loads.push_back({"wall", SurfacePressure{pressure}, {}, std::nullopt});
  auto simulation = MustCreate(scene, mesh);
  for (int step = 0; step < 4; ++step) MustAdvance(*simulation);
  double sum = 0;
  for (const int64_t node : wall.ids) {
    const Vec3& x = simulation->positions()[static_cast<size_t>(node)];
    sum += std::hypot(x[0], x[1]) - inner;
  }
  // Plane strain, r = inner.
  const double lame = (1 + poisson) / youngs * inner * inner * pressure /
                      (outer * outer - inner * inner) *
                      ((1 - 2 * poisson) * inner + outer * outer / inner);
  return sum / static_cast<double>(wall.ids.size()) / lame;
}

TEST(Loads, PressureInATubeInflatesItAsLame) {
  const double coarse = InflationOverLame(4), fine = InflationOverLame(8);
  EXPECT_NEAR(coarse, 1, 0.04);
  EXPECT_NEAR(fine, 1, 0.01);
  // Linear tets: the error falls with the square of their size.
  EXPECT_NEAR((coarse - 1) / (fine - 1), 4, 1);
}

TetMesh OneTet() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}};
  return mesh;
}

TEST(Loads, AForceOnAFreeBodyAcceleratesItAndItsWorkIsReported) {
  Scene scene = TightScene(1e6, 0.3, 1200, 0.01);  // 200 kg
  AddBoxSet(scene, "all", {-kFar, -kFar, -kFar}, {kFar, kFar, kFar});
  scene.loads.push_back({"all", PointForce{{0, 100, 0}}, {}, std::nullopt});
  auto simulation = MustCreate(scene, OneTet());
  FrameReport report;
  const int n = 20;
  for (int step = 0; step < n; ++step) report = MustAdvance(*simulation);
  const double acceleration = 100.0 / 200, dt = 0.01;
  const double way = acceleration * dt * dt * n * (n + 1) / 2;
  for (size_t node = 0; node < 4; ++node)
    EXPECT_NEAR(simulation->positions()[node][1], OneTet().rest_positions[node][1] + way, 1e-12);
  EXPECT_NEAR(report.external_work, 100 * way, 1e-12);
  EXPECT_NEAR(report.kinetic_energy, 100 * std::pow(acceleration * dt * n, 2), 1e-12);
}

TEST(Loads, ABodyThatAMotionLetsGoFliesOn) {
  Scene scene = TightScene(1e6, 0.3, 1200, 0.01);
  AddBoxSet(scene, "all", {-kFar, -kFar, -kFar}, {kFar, kFar, kFar});
  Motion& carry = AddMotion(scene, "all");
  carry.keyframes = {{0, {0, 0, 0}, 0}, {1, {2, 0, -1}, 0}};
  carry.release = Release{.time = 0.055};  // within the sixth step: it ends with that
  scene.loads.push_back({"all", PointForce{{0, 4e3, 0}}, {}, Release{.time = 0.1}});
  auto simulation = MustCreate(scene, OneTet());
  const TetMesh rest = OneTet();
  for (int step = 1; step <= 20; ++step) {
    const FrameReport report = MustAdvance(*simulation);
    // 20 m/s^2 along y, in four steps of backward Euler; then none.
    const int pushed = std::clamp(step - 6, 0, 4);
    const double y = 20 * 1e-4 * (pushed * (pushed + 1) / 2 + pushed * std::max(0, step - 10));
    for (size_t node = 0; node < 4; ++node) {
      const Vec3& x = simulation->positions()[node];
      EXPECT_NEAR(x[0], rest.rest_positions[node][0] + 0.02 * step, 1e-12);
      EXPECT_NEAR(x[1], rest.rest_positions[node][1] + y, 1e-12) << "step " << step;
      EXPECT_NEAR(x[2], rest.rest_positions[node][2] - 0.01 * step, 1e-12);
    }
    // Held, it takes the load.
    EXPECT_NEAR(report.motion_forces[0][1], step <= 6 ? -4e3 : 0, 1e-6);
  }
}

TEST(Loads, ASlabHingedAlongALineSwingsAsAPendulum) {
  // Stiff, hanging from a line along y at the middle of its upper side, a little out of plumb.
  const TetMesh mesh = KuhnBox({2, 2, 8}, {0.2, 0.2, 1}, {-0.1, 0, -1});
  const double dt = 0.01, lean = 0.01;
  Scene scene = TightScene(1e8, 0.3, 1000, dt);
  scene.quality = Quality{};
  scene.quality.residual_tolerance = 1e-6;
  scene.gravity = Vec3{9.81 * std::sin(lean), 0, -9.81 * std::cos(lean)};
  AddBoxSet(scene, "hinge", {0, -kFar, 0}, {0, kFar, 0});
  AddMotion(scene, "hinge");
  auto simulation = MustCreate(scene, mesh);
  // From the lumped masses, as the solver sees them.
  double inertia = 0, moment = 0;
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const double mass = 1000 * SignedVolume(CornersOf(mesh, tet)) / 4;
    for (const int32_t node : mesh.tets[static_cast<size_t>(tet)]) {
      const Vec3& x = mesh.rest_positions[static_cast<size_t>(node)];
      inertia += mass * (x[0] * x[0] + x[2] * x[2]);
      moment -= mass * x[2];
    }
  }
  const double frequency = std::sqrt(moment * 9.81 / inertia);  // rad/s
  // It starts at one end of its swing and crosses the middle after a quarter of a period. Backward
  // Euler turns the phase by atan(w dt) a step.
  size_t bottom = 0;
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    const Vec3& x = mesh.rest_positions[node];
    if (std::abs(x[0]) < 1e-9 && x[2] < -0.999) bottom = node;
  }
  const double middle = std::tan(lean);
  double before = -middle, crossing = 0;
  for (int step = 1; step <= 100 && crossing == 0; ++step) {
    MustAdvance(*simulation);
    const Vec3& x = simulation->positions()[bottom];
    const double after = x[0] / -x[2] - middle;
    if (after >= 0) crossing = step - after / (after - before);
    before = after;
  }
  EXPECT_NEAR(crossing * std::atan(frequency * dt), 0.5 * kPi, 0.01 * kPi);
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    const Vec3& x = mesh.rest_positions[node];
    if (x[0] == 0 && x[2] == 0) {
      EXPECT_EQ(simulation->positions()[node], x);
    }
  }
}

// The bar of BreakingScene, whose right end lets go with the first broken edge, while a load hangs
// on it until it is in pieces.
Scene LettingGo() {
  Scene scene = BreakingScene();
  scene.motions[1].release = Release{.first_fracture = true};
  scene.loads.push_back(
      {"right", PointForce{{3e4, 0, 0}}, {}, Release{.separated_node_sets = {"left", "right"}}});
  scene.loads.push_back({"right", SurfacePressure{-100}, {}, Release{.pieces = 2}});
  return scene;
}

TEST(Loads, ReleasesOnEventsAreTheSameBitsForAnyThreadsAndAfterARestore) {
  auto one = MustCreate(LettingGo(), BreakingMesh(), 1);
  auto two = MustCreate(LettingGo(), BreakingMesh(), 2);
  std::string saved;
  bool let_go = false, separated = false;
  for (int frame = 0; frame < 24 && !separated; ++frame) {
    const FrameReport report = MustAdvance(*one);
    MustAdvance(*two);
    ASSERT_EQ(one->state_hash(), two->state_hash()) << "frame " << frame;
    // It is held in the step in which the first edge breaks, and free in the next.
    EXPECT_EQ(report.motion_forces[1] == (Vec3{0, 0, 0}), let_go);
    if (!let_go && report.broken_edges > 0) saved = one->Save();
    let_go = report.broken_edges > 0;
    separated = report.fragments > 1;
  }
  ASSERT_FALSE(saved.empty());
  EXPECT_TRUE(separated);
  for (int frame = 0; frame < 3; ++frame) MustAdvance(*one);
  auto restored = MustCreate(LettingGo(), BreakingMesh());
  ASSERT_TRUE(restored->Restore(saved).ok());
  while (restored->frame() < one->frame()) MustAdvance(*restored);
  EXPECT_EQ(restored->state_hash(), one->state_hash());
  EXPECT_EQ(restored->positions(), one->positions());
}

TEST(Loads, AStateOfAnotherReleaseIsRefused) {
  auto simulation = MustCreate(LettingGo(), BreakingMesh());
  Scene other = LettingGo();
  other.loads[1].release->pieces = 3;
  EXPECT_EQ(simulation->Restore(MustCreate(other, BreakingMesh())->Save()).code(),
            absl::StatusCode::kFailedPrecondition);
}

}  // namespace
}  // namespace cleave
