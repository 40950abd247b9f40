#include "tests/scenes/slab_trio.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "core/base/status.h"
#include "core/mesh/procedural.h"
#include "tests/metrics/crack_surface.h"
#include "tests/metrics/pieces.h"
#include "tests/metrics/statistics.h"
#include "tests/metrics/strain.h"
#include "tests/scenes/scene_parts.h"

namespace cleave {
namespace {

constexpr double kLength = 1;        // m
constexpr double kWidth = 0.5;       // m
constexpr double kThickness = 0.05;  // m
constexpr double kClamp = 0.08;      // m, the end that is pulled
constexpr double kTab = 0.12;        // m, what tabs cover of either end
constexpr double kFibreAngle = 45;   // degrees from the pull
constexpr int64_t kFrames = 40;
constexpr int32_t kStepsPerFrame = 5;
constexpr double kScore = 0.7;  // m, where scored ones are marked across
// Lines across ruled ones. Between two there are 2.3 cells of full size, or 1.2 that are twice as
// long: such edges cross one nearly anywhere.
constexpr int kRules = 21;
constexpr double kFirstRule = 0.105;   // m
constexpr double kRuleSpacing = 0.04;  // m
constexpr double kSameCrack = 0.0172;  // m, a cell of full size, on any mesh

// How a body is pulled, until it is long torn.
struct Pull {
  double speed = 1;  // m/s
  double seconds = 0.4;
  int64_t frames_after_separation = 10;
};
// Sends a wave through the slab, 30 ms from end to end, which steps of 2 ms follow. When it is torn
// the wave has yet to reach the band.
constexpr Pull kFast;
// Slower, so that it gives way at one line: the last, at the end that is pulled.
constexpr Pull kGentle = {0.65, 0.5, 2};
// So slow that the whole slab is strained alike, in steps of 5 ms; and as long after it is torn.
constexpr Pull kSlow = {0.25, 1, 4};

// Runs with the edge-projected reformulation, and is compared with the uniform one.
bool IsProjected(const std::string& kind) {
  return kind.starts_with("projected") || kind.starts_with("scored") || kind.starts_with("ruled");
}

// Pulled slowly, between tabs: "plain" is what the others are without fibres.
bool IsTestPiece(const std::string& kind) {
  return kind == "aniso" || kind == "turned" || kind == "plain";
}

// A row of pockets near the pulled end, and a band that leans across the slab near the hinge. The
// wave breaks the pockets as it passes, and reaches the band before what is left between them has
// given way and unloads the slab.
bool InMap(const Vec3& x, double cell_size) {
  const double half_band = std::max(0.03, 0.8 * cell_size);
  const double band = (x[0] - 0.25) * std::cos(0.35) + x[1] * std::sin(0.35);
  if (std::abs(band) <= half_band) return true;
  for (const double y : {-0.2, -0.067, 0.067, 0.2}) {
    if (std::hypot(x[0] - 0.78, x[1] - y) <= std::max(0.044, 1.2 * cell_size)) return true;
  }
  return false;
}

Polyline LineAcross(double x) { return {{{x, -kWidth, 0}, {x, kWidth, 0}}}; }

// A knife's lines; edges that they cross have this share of their strength.
ImpurityLayer Scores(const std::vector<Polyline>& lines, double strength) {
  ImpurityLayer scores;
  scores.name = "score";
  Strokes knife;
  knife.curves = lines;
  scores.source = knife;
  scores.weakening = strength;
  return scores;
}

Pull PullOf(const std::string& kind) {
  if (IsTestPiece(kind)) return kSlow;
  return kind.starts_with("ruled") ? kGentle : kFast;
}

// How this broke against the same body without fibres and with uniform weakening; adds nothing
// where that fails to run.
void CompareWithUsual(const Demonstration& demonstration, const Incidence& incidence,
                      const Run& run, Metrics& metrics) {
  Demonstration usual = demonstration;
  usual.scene.fracture.reformulation = Reformulation::kUniform;
  usual.scene.materials[0].fibres.clear();
  const auto other = RunDemonstration(usual);
  if (!other.ok()) return;
  const std::vector<int32_t>& broken = run.frames.back().broken_edges;
  const std::vector<int32_t>& usually = other->frames.back().broken_edges;
  metrics["common_edges"] = Jaccard(broken, usually);
  metrics["common_crack"] =
      JaccardWithin(demonstration.mesh, incidence, broken, usually, kSameCrack);
}

// Cracks beside the largest, without what is smaller than a tenth of a crack across the slab.
double SecondaryCracks(std::span<const CrackFacet> crack, double cell_size) {
  int cracks = 0;
  for (const std::vector<CrackFacet>& part : CrackParts(crack, 2 * cell_size))
    cracks += CrackArea(part) >= 0.1 * kWidth * kThickness ? 1 : 0;
  return std::max(0, cracks - 1);
}

}  // namespace

absl::StatusOr<Demonstration> MakeSlabTrio(const Setting& setting) {
  const std::string& kind = setting.variant;
  Demonstration made;
  made.cell_size = 0.0172 * setting.coarseness * (kind.ends_with("-coarse") ? 2 : 1);
  BoxMesh box;
  box.origin = {0, -kWidth / 2, -kThickness / 2};
  box.size = {kLength, kWidth, kThickness};
  box.resolution = {setting.layout, made.cell_size, 0.2, setting.seed};
  CLEAVE_ASSIGN_OR_RETURN(made.mesh, BuildMesh(box));
  made.fibres.assign(made.mesh.tets.size(), InPlane(kFibreAngle));
  made.rest_length = kLength - kClamp;

  Scene& scene = made.scene;
  scene.name = kind;
  scene.seed = setting.seed;
  if (IsProjected(kind)) scene.fracture.reformulation = Reformulation::kEdgeProjected;
  Material material;
  material.name = "slab";
  material.youngs_modulus = 1e6;
  material.poisson_ratio = 0.35;
  material.density = 1000;
  material.tensile_strength = 1e5;
  if (kind == "aniso" || kind == "turned") {
    FibreFamily family;
    family.stiffness = 4e6;
    family.direction = ConstantDirection{InPlane(kind == "aniso" ? kFibreAngle : kFibreAngle + 90)};
    family.strength_ratio = 3;
    material.fibres.push_back(family);
  }
  if (IsTestPiece(kind) || kind.starts_with("scored")) {
    // Tabs, as on any test piece: it shall break along its fibres or score and not along a grip.
    scene.weakenings.push_back({BoxSelector{{kLength - kTab, -1, -1}, {kLength + 1, 1, 1}}, 2});
    scene.weakenings.push_back({BoxSelector{{-1, -1, -1}, {kTab, 1, 1}}, 2});
  }
  scene.materials.push_back(material);

  Impurities impurities;
  impurities.noise = 0.05;
  made.in_map = NodeFlags(made.mesh, [&](const Vec3& x) { return InMap(x, made.cell_size); });
  if (kind == "impure" || kind == "shuffled") {
    impurities.potency = 10;
    impurities.map = MapOf(kind == "impure" ? made.in_map : Shuffled(made.in_map, setting.seed));
  }
  if (kind.starts_with("scored")) impurities.layers.push_back(Scores({LineAcross(kScore)}, 0.7));
  if (kind.starts_with("ruled")) {
    std::vector<Polyline> lines;
    for (int line = 0; line < kRules; ++line)
      lines.push_back(LineAcross(kFirstRule + line * kRuleSpacing));
    impurities.layers.push_back(Scores(lines, 0.5));
  }
  scene.impurities = impurities;

  const Pull pull = PullOf(kind);
  made.grip = NodesWhere(made.mesh, [](const Vec3& x) { return x[0] < 1e-9; });
  made.pulled = NodesWhere(made.mesh, [](const Vec3& x) { return x[0] > kLength - kClamp; });
  AddNodeSet(scene, "hinge", made.grip);
  AddNodeSet(scene, "pulled", made.pulled);
  AddMotion(scene, "hinge", {true, false, true});
  made.pull_motion = AddMotion(scene, "pulled", {true, true, true},
                               PullBy({pull.speed * pull.seconds, 0, 0}, pull.seconds));
  SetPace(scene, pull.seconds, kFrames);
  scene.timing.steps_per_frame = kStepsPerFrame;
  made.frames_after_separation = pull.frames_after_separation;
  return made;
}

Metrics MeasureSlabTrio(const Demonstration& demonstration, const Incidence& incidence,
                        const Run& run) {
  Metrics metrics;
  const std::string& kind = demonstration.scene.name;
  if (kind == "turned" || IsProjected(kind))
    CompareWithUsual(demonstration, incidence, run, metrics);
  double newton = 0, linear = 0, seconds = 0;
  for (const FrameReport& report : run.reports) {
    metrics["solves"] += report.steps + report.break_passes;
    seconds += report.total_seconds;
    newton += report.newton_iterations;
    linear += report.linear_iterations;
  }
  metrics["newton_per_solve"] = newton / metrics["solves"];
  metrics["seconds_per_solve"] = seconds / metrics["solves"];
  metrics["linear_per_newton"] = linear / newton;
  const auto crack = CrackOfPieces(demonstration.mesh, incidence, run.frames.back().broken_edges);
  if (crack.empty()) return metrics;
  metrics["secondary_cracks"] = SecondaryCracks(crack, demonstration.cell_size);
  metrics["center_from_pulled"] = 1 - CrackCenter(crack)[0] / kLength;
  metrics["trace_thickness"] = ExtentAlong(crack, {1, 0, 0}, 0.05).length() / kLength;
  metrics["trace_angle"] =
      TraceAngle(crack, {0, 0, 1}, 3 * demonstration.cell_size, InPlane(kFibreAngle));
  metrics["strain_to_crack"] =
      StrainToFirstCrack(demonstration.mesh, incidence, run.frames) / demonstration.cell_size;
  return metrics;
}

}  // namespace cleave
