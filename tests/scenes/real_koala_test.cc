// The figure's scene on a koala that others modelled; built where CLEAVE_MESHES_DIR holds it.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "client/io/surface/surface_file.h"
#include "core/mesh/surface_mesh.h"
#include "tests/scenes/figure.h"
#include "tests/scenes/scene_parts.h"
#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

// The koala stands on four feet, x to its left, y up, z ahead, 0.42 m long. All in m but the last.
constexpr double kScale = 0.045;  // m a unit of the file
constexpr double kCell = 0.018;
constexpr double kFoot = -0.9 * kScale;               // above it legs are narrower than feet
constexpr double kHold = -0.6 * kScale;               // up to which the other legs are held
constexpr double kBelly = 0.5 * kScale;               // legs are below
constexpr Vec3 kLeg{0.83 * kScale, 0, 1.2 * kScale};  // its left foreleg's axis
constexpr double kRing = -0.1 * kScale;               // height of the ring's middle
constexpr double kRingWidth = 3 * kCell;
constexpr double kStronger = 10;  // times the strength of the legs that are held
constexpr double kJerk = 0.09;    // of the foot, down and a little ahead
constexpr double kSeconds = 0.06;
constexpr int64_t kFrames = 40;

bool IsAtLeg(const Vec3& x) {
  return std::abs(x[0] - kLeg[0]) < 0.75 * kScale && std::abs(x[2] - kLeg[2]) < 0.9 * kScale;
}

// Stands with three legs in plaster and is jerked by the foot of the fourth, that with the ring. A
// koala's legs are as thin as each other: of one strength, the leg that is jerked comes off with
// and without a ring. So this leg, body and head are ten times as strong as the three legs, as the
// figure's arm is stronger than all that holds it: without the ring the jerk tears legs off that
// are held, each by itself, and each is more than the least part that counts as a piece.
Demonstration MakeKoala(const TetMesh& mesh, const Setting& setting) {
  const NodeValues ring{MapOf(NodeFlags(
      mesh, [](const Vec3& x) { return IsAtLeg(x) && std::abs(x[1] - kRing) <= kRingWidth / 2; }))};
  Demonstration made = MakeRingedPlaster(mesh, kCell, ring, setting);
  Scene& scene = made.scene;
  scene.name = "koala";
  made.grip = NodesWhere(mesh, [](const Vec3& x) { return x[1] < kHold && !IsAtLeg(x); });
  AddNodeSet(scene, "three legs", made.grip);
  AddMotion(scene, "three legs");
  made.pulled = NodesWhere(mesh, [](const Vec3& x) { return x[1] < kFoot && IsAtLeg(x); });
  AddNodeSet(scene, "foot", made.pulled);
  made.pull_direction = {0, -0.985, 0.174};  // 10 degrees from down
  Vec3 jerk = made.pull_direction;
  for (double& coordinate : jerk) coordinate *= kJerk;
  made.pull_motion = AddMotion(scene, "foot", {true, true, true}, PullBy(jerk, kSeconds));
  scene.weakenings.push_back({BoxSelector{{-1, kBelly, -1}, {1, 1, 1}}, kStronger});
  scene.weakenings.push_back({BoxSelector{{0, -1, 0}, {1, kBelly, 1}}, kStronger});
  SetPace(scene, kSeconds, kFrames);
  scene.timing.steps_per_frame = 2;
  made.frames_after_separation = kFrames;
  return made;
}

Metrics NoOthers(const Demonstration&, const Incidence&, const Run&) { return {}; }

void ExpectOnlyTheLegWithTheRingToComeOff(MeshLayout layout) {
  auto surface = ReadSurfaceFile(CLEAVE_MESHES_DIR "/surface/koala_low_resolution.obj");
  ASSERT_TRUE(surface.ok()) << surface.status();
  for (Vec3& vertex : surface->vertices) {
    for (double& coordinate : vertex) coordinate *= kScale;
  }
  std::vector<Trial> trials;
  for (const uint32_t seed : kReportedSeeds) {
    const auto body =
        MeshSurface(surface->vertices, surface->triangles, {layout, kCell, 0.2, seed});
    ASSERT_TRUE(body.ok()) << body.status();
    Setting setting{.seed = seed, .layout = layout};
    Trial& trial = trials.emplace_back(Trial{setting, {}});
    for (const std::string& variant : VariantsOf(FigureCriteria())) {
      setting.variant = variant;
      const auto outcome = Measured(MakeKoala(body->mesh, setting), NoOthers);
      ASSERT_TRUE(outcome.ok()) << variant << ": " << outcome.status();
      trial.variants[variant] = outcome->metrics;
      Report("figure " + variant + " of koala_low_resolution.obj", setting, outcome->metrics);
    }
  }
  for (const Criterion& criterion : FigureCriteria()) ExpectHolds(criterion, trials);
}

TEST(FullRealKoala, OnlyTheLegWithTheRingComesOffALattice) {
  ExpectOnlyTheLegWithTheRingToComeOff(MeshLayout::kJitteredLattice);
}

TEST(FullRealKoala, OnlyTheLegWithTheRingComesOffAnUnstructuredMesh) {
  ExpectOnlyTheLegWithTheRingToComeOff(MeshLayout::kUnstructured);
}

}  // namespace
}  // namespace cleave
