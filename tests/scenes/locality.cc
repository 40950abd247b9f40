#include "tests/scenes/locality.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/status.h"
#include "core/mesh/procedural.h"
#include "tests/scenes/scene_parts.h"

namespace cleave {
namespace {

constexpr double kLength = 0.6;  // m
constexpr double kWidth = 0.3;   // m
constexpr double kGap = 0.2;     // m between the slabs
constexpr double kStretch = 0.09;
// Slow against the wave that the pull sends, 20 ms from end to end; and steps in which a wave
// crosses two cells of full size, for what an implicit step is told of falls off over that length.
constexpr double kSeconds = 0.12;
constexpr int64_t kFrames = 48;

bool InSecond(const Vec3& x) { return x[1] > kWidth + kGap / 2; }

}  // namespace

absl::StatusOr<Demonstration> MakeLocality(const Setting& setting) {
  Demonstration made;
  made.cell_size = 0.04 * setting.coarseness;
  BoxMesh box;
  box.size = {kLength, kWidth, 0.1};
  box.resolution = {setting.layout, made.cell_size, 0.2, setting.seed};
  CLEAVE_ASSIGN_OR_RETURN(made.mesh, BuildMesh(box));
  const size_t nodes = made.mesh.rest_positions.size();
  const size_t tets = made.mesh.tets.size();
  for (size_t node = 0; node < nodes; ++node) {
    Vec3 twin = made.mesh.rest_positions[node];
    twin[1] += kWidth + kGap;
    made.mesh.rest_positions.push_back(twin);
  }
  for (size_t tet = 0; tet < tets; ++tet) {
    auto twin = made.mesh.tets[tet];
    for (int32_t& node : twin) node += static_cast<int32_t>(nodes);
    made.mesh.tets.push_back(twin);
  }
  made.rest_length = kLength;

  Scene& scene = made.scene;
  scene.name = "one impure node";
  scene.seed = setting.seed;
  Material material;
  material.name = "slab";
  material.youngs_modulus = 1e6;
  material.poisson_ratio = 0.3;
  material.density = 1000;
  material.tensile_strength = 1e5;
  scene.materials.push_back(material);
  const auto distance = [](const Vec3& x) {
    return std::hypot(x[0] - kLength / 2, x[1] - kWidth / 2, x[2] - 0.05);
  };
  size_t middle = 0;
  for (size_t node = 0; node < nodes; ++node) {
    if (distance(made.mesh.rest_positions[node]) < distance(made.mesh.rest_positions[middle]))
      middle = node;
  }
  made.in_map.assign(2 * nodes, 0);
  made.in_map[middle] = 1;
  Impurities impurities;
  impurities.potency = setting.variant == "without" ? 0 : 10;
  impurities.map =
      MapOf(setting.variant == "shuffled" ? Shuffled(made.in_map, setting.seed) : made.in_map);
  scene.impurities = impurities;
  const auto left = NodesWhere(made.mesh, [](const Vec3& x) { return x[0] < 1e-9; });
  const auto right = NodesWhere(made.mesh, [](const Vec3& x) { return x[0] > kLength - 1e-9; });
  AddNodeSet(scene, "left", left);
  AddNodeSet(scene, "right", right);
  AddMotion(scene, "left", {true, true, true});
  made.pull_motion =
      AddMotion(scene, "right", {true, true, true}, PullBy({kStretch * kLength, 0, 0}, kSeconds));
  SetPace(scene, kSeconds, kFrames);
  // A change of one node's potency is far smaller than what mid settings leave unsolved.
  scene.quality.residual_tolerance = 1e-10;
  scene.quality.step_tolerance = 1e-10;
  scene.quality.linear_tolerance = 1e-6;
  scene.quality.newton_iterations = 40;
  return made;
}

Metrics MeasureLocality(const Demonstration& demonstration, const Incidence& incidence,
                        const Run& run) {
  Demonstration pure = demonstration;
  pure.scene.impurities->potency = 0;
  const absl::StatusOr<Run> without = RunDemonstration(pure);
  if (!without.ok()) return {};
  const LocalityOfChange change = CompareRuns(demonstration, incidence, *without, run);
  Metrics metrics;
  metrics["first_difference"] = static_cast<double>(change.first_difference);
  metrics["new_broken_edges"] = static_cast<double>(change.new_broken_edges);
  metrics["own_edges"] = change.broken_edges_are_the_nodes_own ? 1 : 0;
  metrics["largest_change"] = change.largest;
  metrics["share_within_three_rings"] = change.share_within_three_rings;
  const double largest = std::max(change.largest, change.largest_elsewhere);
  metrics["change_elsewhere"] = largest > 0 ? change.largest_elsewhere / largest : 0;
  return metrics;
}

LocalityOfChange CompareRuns(const Demonstration& with_impurity, const Incidence& incidence,
                             const Run& without, const Run& with) {
  LocalityOfChange change;
  const size_t frames = std::min(without.frames.size(), with.frames.size());
  size_t frame = 0;
  while (frame < frames && without.frames[frame].positions == with.frames[frame].positions &&
         without.frames[frame].broken_edges == with.frames[frame].broken_edges)
    ++frame;
  if (frame == frames) return change;
  change.first_difference = static_cast<int64_t>(frame);
  std::vector<int32_t> extra;
  std::set_symmetric_difference(
      with.frames[frame].broken_edges.begin(), with.frames[frame].broken_edges.end(),
      without.frames[frame].broken_edges.begin(), without.frames[frame].broken_edges.end(),
      std::back_inserter(extra));
  change.new_broken_edges = static_cast<int64_t>(extra.size());
  const auto impure = [&](int32_t node) {
    return with_impurity.in_map[static_cast<size_t>(node)] != 0;
  };
  change.broken_edges_are_the_nodes_own =
      std::all_of(extra.begin(), extra.end(), [&](int32_t edge) {
        const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
        return impure(a) || impure(b);
      });

  // Edges from the impure node to every node, up to three.
  std::vector<int> rings(with_impurity.in_map.size(), 4);
  for (size_t node = 0; node < rings.size(); ++node) {
    if (with_impurity.in_map[node] != 0) rings[node] = 0;
  }
  for (int pass = 0; pass < 3; ++pass) {
    for (const auto& [a, b] : incidence.edges) {
      int& first = rings[static_cast<size_t>(a)];
      int& second = rings[static_cast<size_t>(b)];
      if (first == pass) second = std::min(second, pass + 1);
      if (second == pass) first = std::min(first, pass + 1);
    }
  }
  const double dt = with.frames[frame].time - with.frames[frame - 1].time;
  double near = 0, all = 0;
  for (size_t node = 0; node < rings.size(); ++node) {
    const Vec3& p = without.frames[frame].positions[node];
    const Vec3& q = with.frames[frame].positions[node];
    const double speed = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]) / dt;
    change.speeds.push_back(speed);
    all += speed * speed;
    if (rings[node] <= 3) near += speed * speed;
    double& largest = InSecond(with_impurity.mesh.rest_positions[node]) ? change.largest_elsewhere
                                                                        : change.largest;
    largest = std::max(largest, speed);
  }
  change.share_within_three_rings = all > 0 ? near / all : 0;
  return change;
}

std::vector<Criterion> LocalityCriteria() {
  const auto waits = [](const std::string& variant) -> std::vector<Condition> {
    return {{"first frame that differs", Of(variant, "first_difference"), Relation::kAbove, 2},
            {"edges that differ", Of(variant, "new_broken_edges"), Relation::kAbove, 0},
            {"1 where all of them are the node's own", Of(variant, "own_edges"), Relation::kAtLeast,
             1}};
  };
  const auto stays = [](const std::string& variant) -> std::vector<Condition> {
    return {{"largest change of velocity, m/s", Of(variant, "largest_change"), Relation::kAbove, 0},
            {"share within three edges of the node", Of(variant, "share_within_three_rings"),
             Relation::kAbove, 0.8},
            {"largest change in the other slab, of the largest", Of(variant, "change_elsewhere"),
             Relation::kBelow, 1e-6}};
  };
  return {
      {"Until an edge of the node breaks, nothing differs in any bit",
       {"with"},
       waits("with"),
       false,
       kAll},
      {"What changes then lies round the node", {"with"}, stays("with"), false, kAll},
      {"Without an impurity nothing differs at all", {"without"}, waits("without"), true, kAll},
      {"Where another node is impure, other edges break", {"shuffled"}, waits("shuffled"), true},
      {"Where another node is impure, what changes lies round that one",
       {"shuffled"},
       stays("shuffled"),
       true},
  };
}

}  // namespace cleave
