#include "tests/scenes/figure.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "core/base/status.h"
#include "tests/metrics/pieces.h"
#include "tests/scenes/scene_parts.h"
#include "tests/scenes/shapes.h"

namespace cleave {
namespace {

// m. The feet are at z = 0, the struck fist is at x > 0.
constexpr double kHip = 0.3;
constexpr double kShoulder = 0.42;
constexpr double kNeck = 0.45;
constexpr double kHead = 0.64;
constexpr double kReach = 0.34;  // from the torso's axis to a hand
constexpr double kArmRadius = 0.055;
constexpr double kFistRadius = 0.085;
constexpr double kRing = 0.17;  // from the torso's axis to the ring's middle
constexpr double kRingWidth = 0.06;

constexpr double kProngRadius = 0.05;  // m
constexpr double kSpeed = 1.5;         // m/s; a wave of it has three fifths of the strength
constexpr double kSeconds = 0.06;
constexpr int64_t kFrames = 40;

std::vector<Capsule> Limbs() {
  constexpr double kStance = 0.05, kThin = 0.03;
  return {{{0, 0, kHip}, {0, 0, kNeck}, 0.07},
          {{0, 0, kNeck}, {0, 0, kHead}, kThin},
          {{0, 0, kHead}, {0, 0, kHead}, 0.05},
          {{0, 0, kShoulder}, {kReach, 0, kShoulder}, kArmRadius},
          {{kReach, 0, kShoulder}, {kReach, 0, kShoulder}, kFistRadius},
          {{0, 0, kShoulder}, {-kReach, 0, kShoulder}, kThin},
          {{-kReach, 0, kShoulder}, {-kReach, 0, kShoulder}, 0.045},
          {{kStance, 0, 0}, {kStance, 0, kHip}, kThin},
          {{-kStance, 0, 0}, {-kStance, 0, kHip}, kThin}};
}

// On either side of the arm, just behind the fist: the arm is pulled and not bent.
void AddProngs(Scene& scene) {
  const double aside = kArmRadius + kProngRadius + 0.01;
  const double touching = kFistRadius + kProngRadius;
  const double behind = std::sqrt(touching * touching - aside * aside) + 0.002;
  for (const double side : {-1.0, 1.0}) {
    Collider prong;
    prong.name = side < 0 ? "front prong" : "back prong";
    prong.shape = SphereShape{{kReach - behind, side * aside, kShoulder}, kProngRadius};
    prong.keyframes = PullBy({kSpeed * kSeconds, 0, 0}, kSeconds);
    prong.friction = 0.3;
    prong.stiffness = 0.05;
    scene.colliders.push_back(prong);
  }
}

}  // namespace

Demonstration MakeRingedPlaster(TetMesh mesh, double cell_size, const ImpuritySource& ring,
                                const Setting& setting) {
  Demonstration made;
  made.mesh = std::move(mesh);
  made.cell_size = cell_size;
  Scene& scene = made.scene;
  scene.seed = setting.seed;
  Material plaster;
  plaster.name = "plaster";
  plaster.youngs_modulus = 1e9;
  plaster.poisson_ratio = 0.2;
  plaster.density = 1500;
  plaster.tensile_strength = 3e6;
  scene.materials.push_back(plaster);

  ImpurityLayer layer;
  layer.name = "ring";
  layer.source = ring;
  layer.potency = 10;
  Impurities impurities;
  impurities.layers.push_back(layer);
  scene.impurities = impurities;
  made.in_map = ImpureNodes(scene, made.mesh);
  Impurities& used = *scene.impurities;
  if (setting.variant == "off") used.model = ImpurityModel::kOff;
  if (setting.variant == "static") used.model = ImpurityModel::kStatic;
  if (setting.variant == "uncorrelated") used.model = ImpurityModel::kUncorrelated;
  if (setting.variant == "shuffled") {
    used.layers.clear();
    used.potency = 10;
    used.map = MapOf(Shuffled(made.in_map, setting.seed));
  }
  return made;
}

absl::StatusOr<Demonstration> MakeFigure(const Setting& setting) {
  const double cell_size = 0.02 * setting.coarseness;
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh,
                          Capsules(Limbs(), {setting.layout, cell_size, 0.2, setting.seed}));
  BandField ring;
  ring.center = {0, 0, kShoulder};
  ring.axis = {1, 0, 0};
  ring.position = kRing;
  ring.width = kRingWidth;
  Demonstration made = MakeRingedPlaster(std::move(mesh), cell_size, ring, setting);
  Scene& scene = made.scene;
  scene.name = "figure";

  made.grip = NodesWhere(made.mesh,
                         [](const Vec3& x) { return x[2] < 0 || x[2] > kHead || x[0] < -kReach; });
  AddNodeSet(scene, "head, feet and hand", made.grip);
  AddMotion(scene, "head, feet and hand");
  // So that the blow does not start the crack.
  scene.weakenings.push_back({BoxSelector{{0.25, -1, -1}, {1, 1, 1}}, 2});
  AddProngs(scene);
  SetPace(scene, kSeconds, kFrames);
  scene.timing.steps_per_frame = 2;
  return made;
}

Metrics MeasureFigure(const Demonstration& demonstration, const Incidence& incidence,
                      const Run& run) {
  Metrics metrics;
  const Pieces pieces = PiecesOf(demonstration.mesh, incidence, run.frames.back().broken_edges);
  std::vector<int32_t> fists(static_cast<size_t>(pieces.count), 0);
  for (size_t node = 0; node < pieces.node_pieces.size(); ++node) {
    if (pieces.node_pieces[node] >= 0 && demonstration.mesh.rest_positions[node][0] > kReach)
      ++fists[static_cast<size_t>(pieces.node_pieces[node])];
  }
  const auto most = std::max_element(fists.begin(), fists.end()) - fists.begin();
  metrics["arm_share"] = fists.empty() ? 0 : pieces.shares[static_cast<size_t>(most)];
  return metrics;
}

std::vector<Criterion> FigureCriteria() {
  const auto comes_off = [](const std::string& variant) -> std::vector<Condition> {
    return {
        {"pieces", Of(variant, "pieces"), Relation::kAtMost, 2},
        {"pieces", Of(variant, "pieces"), Relation::kAtLeast, 2},
        {"share of broken edges in the ring", Of(variant, "band_share"), Relation::kAtLeast, 0.9}};
  };
  const auto shatters = [](const std::string& variant) -> std::vector<Condition> {
    return {
        {"share of broken edges in the ring, less than with the random graph",
         Difference(Of("graph", "band_share"), Of(variant, "band_share")), Relation::kAtLeast, 0.2},
        {"pieces, times as many as with the random graph",
         Ratio(Of(variant, "pieces"), Of("graph", "pieces")), Relation::kAtLeast, 2}};
  };
  return {
      {"Only the arm with the ring comes off, at the ring", {"graph"}, comes_off("graph")},
      {"Without the random graph it breaks into more pieces, elsewhere",
       {"graph", "off"},
       shatters("off")},
      {"Without the random graph only the arm comes off", {"off"}, comes_off("off"), true, kAll},
      {"With the same impurities at other nodes only the arm comes off",
       {"shuffled"},
       comes_off("shuffled"),
       true,
       kAll},
  };
}

}  // namespace cleave
