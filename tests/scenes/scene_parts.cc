#include "tests/scenes/scene_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/counter_rng.h"
#include "core/impurity/bake.h"
#include "core/mesh/incidence.h"

namespace cleave {

std::vector<int32_t> NodesWhere(const TetMesh& mesh, const Place& holds) {
  std::vector<int32_t> nodes;
  for (size_t node = 0; node < mesh.rest_positions.size(); ++node) {
    if (holds(mesh.rest_positions[node])) nodes.push_back(static_cast<int32_t>(node));
  }
  return nodes;
}

std::vector<uint8_t> NodeFlags(const TetMesh& mesh, const Place& holds) {
  std::vector<uint8_t> flags;
  for (const Vec3& position : mesh.rest_positions) flags.push_back(holds(position) ? 1 : 0);
  return flags;
}

Vec3 Centroid(const TetMesh& mesh, size_t tet) {
  Vec3 centroid{0, 0, 0};
  for (const int32_t node : mesh.tets[tet]) {
    for (size_t axis = 0; axis < 3; ++axis)
      centroid[axis] += mesh.rest_positions[static_cast<size_t>(node)][axis] / 4;
  }
  return centroid;
}

void NameRegion(TetMesh& mesh, int32_t id, const std::string& name, const Place& holds) {
  mesh.tet_regions.resize(mesh.tets.size(), 0);
  mesh.regions.push_back({id, name});
  for (size_t tet = 0; tet < mesh.tets.size(); ++tet) {
    if (holds(Centroid(mesh, tet))) mesh.tet_regions[tet] = id;
  }
}

void AddNodeSet(Scene& scene, const std::string& name, const std::vector<int32_t>& nodes) {
  NodeSet set;
  set.name = name;
  set.select.push_back(IdSelector{{nodes.begin(), nodes.end()}});
  scene.node_sets.push_back(std::move(set));
}

size_t AddMotion(Scene& scene, const std::string& set, std::array<bool, 3> axes,
                 std::vector<Keyframe> keyframes) {
  Motion motion;
  motion.node_set = set;
  motion.axes = axes;
  motion.keyframes = std::move(keyframes);
  scene.motions.push_back(std::move(motion));
  return scene.motions.size() - 1;
}

void GripEnds(Demonstration& made, double length, double grip) {
  made.grip = NodesWhere(made.mesh, [&](const Vec3& x) { return x[0] < -length / 2 + grip; });
  made.pulled = NodesWhere(made.mesh, [&](const Vec3& x) { return x[0] > length / 2 - grip; });
  AddNodeSet(made.scene, "left end", made.grip);
  AddNodeSet(made.scene, "right end", made.pulled);
}

void Reinforce(Scene& scene, double place, double reach) {
  for (const double middle : {-place, place})
    scene.weakenings.push_back({BoxSelector{{middle - reach, -1, -1}, {middle + reach, 1, 1}}, 2});
}

std::vector<Keyframe> PullBy(const Vec3& translation, double seconds) {
  Keyframe end;
  end.time = seconds;
  end.translation = translation;
  return {Keyframe{}, end};
}

void SetPace(Scene& scene, double seconds, int64_t frames) {
  scene.timing.frame_count = frames;
  scene.timing.frames_per_second = static_cast<double>(frames) / seconds;
  scene.timing.steps_per_frame = 1;
  scene.quality.residual_tolerance = 1e-3;
  scene.quality.step_tolerance = 1e-3;
  scene.quality.linear_tolerance = 1e-2;
  scene.quality.newton_iterations = 12;
}

std::vector<uint8_t> Shuffled(std::vector<uint8_t> flags, uint32_t seed) {
  for (size_t i = flags.size(); i > 1; --i) {
    const double draw = UniformDraw(seed, RandomStream::kEdgeDeal, i, 0);
    std::swap(flags[i - 1], flags[static_cast<size_t>(draw * static_cast<double>(i))]);
  }
  return flags;
}

std::vector<double> MapOf(const std::vector<uint8_t>& flags) {
  return {flags.begin(), flags.end()};
}

std::vector<uint8_t> ImpureNodes(const Scene& scene, const TetMesh& mesh) {
  const std::vector<double> potencies =
      BakeImpurities(scene, mesh, BuildIncidence(mesh).edges).potencies;
  const double largest = *std::max_element(potencies.begin(), potencies.end());
  std::vector<uint8_t> flags;
  for (const double potency : potencies)
    flags.push_back(largest > 0 && potency >= largest / 2 ? 1 : 0);
  return flags;
}

std::vector<uint8_t> MarkedNodes(const Scene& scene, const TetMesh& mesh) {
  const Incidence incidence = BuildIncidence(mesh);
  const std::vector<uint8_t> marked = BakeImpurities(scene, mesh, incidence.edges).touched_edges;
  std::vector<uint8_t> flags(mesh.rest_positions.size(), 0);
  for (size_t edge = 0; edge < marked.size(); ++edge) {
    if (marked[edge] == 0) continue;
    for (const int32_t node : incidence.edges[edge]) flags[static_cast<size_t>(node)] = 1;
  }
  return flags;
}

void DealOut(Scene& scene, const std::vector<uint8_t>& nodes, uint32_t seed) {
  scene.impurities->layers.resize(1);
  scene.impurities->layers[0].source = NodeValues{MapOf(Shuffled(nodes, seed))};
}

Vec3 InPlane(double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  return {std::cos(angle), std::sin(angle), 0};
}

}  // namespace cleave
