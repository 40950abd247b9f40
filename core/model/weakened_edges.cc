#include "core/model/weakened_edges.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/scene/selection.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

// Whether the segment from a to b has a point in the box: what is left of it between one pair of
// faces after the other.
bool Touches(const BoxSelector& box, const Vec3& a, const Vec3& b) {
  double begin = 0, end = 1;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double run = b[axis] - a[axis];
    if (run == 0) {
      if (a[axis] < box.min[axis] || a[axis] > box.max[axis]) return false;
      continue;
    }
    const double first = (box.min[axis] - a[axis]) / run, second = (box.max[axis] - a[axis]) / run;
    begin = std::max(begin, std::min(first, second));
    end = std::min(end, std::max(first, second));
  }
  return begin <= end;
}

bool Touches(const SphereSelector& sphere, const Vec3& a, const Vec3& b) {
  const Vector3d start(a.data()), center(sphere.center.data());
  const Vector3d run = Vector3d(b.data()) - start;
  const double squared = run.squaredNorm();
  const double share = squared > 0 ? std::clamp(run.dot(center - start) / squared, 0.0, 1.0) : 0;
  return (start + share * run - center).norm() <= sphere.radius;
}

}  // namespace

void WeakenEdges(const Scene& scene, const TetMesh& mesh, const MeshOrder& order,
                 const Incidence& incidence, std::span<double> thresholds) {
  if (scene.weakenings.empty()) return;
  std::vector<double> factors(thresholds.size(), 1);
  const auto apply = [&](double factor, const auto& holds) {
    for (size_t edge = 0; edge < factors.size(); ++edge) {
      const auto [a, b] = incidence.edges[edge];
      if (holds(static_cast<size_t>(order.old_node[static_cast<size_t>(a)]),
                static_cast<size_t>(order.old_node[static_cast<size_t>(b)])))
        factors[edge] = factor;
    }
  };
  const auto apply_shape = [&](double factor, const auto& shape) {
    apply(factor, [&](size_t a, size_t b) {
      return Touches(shape, mesh.rest_positions[a], mesh.rest_positions[b]);
    });
  };
  const RegionIndex regions(mesh);
  for (const Weakening& weakening : scene.weakenings) {
    if (const auto* of_nodes = std::get_if<EdgesOfNodes>(&weakening.edges)) {
      std::vector<uint8_t> chosen(mesh.rest_positions.size(), 0);
      for (const NodeSet& set : scene.node_sets) {
        if (set.name != of_nodes->node_set) continue;
        for (const int32_t node : SelectNodes(set, mesh, regions))
          chosen[static_cast<size_t>(node)] = 1;
      }
      apply(weakening.factor, [&](size_t a, size_t b) { return chosen[a] != 0 && chosen[b] != 0; });
    } else if (const auto* box = std::get_if<BoxSelector>(&weakening.edges)) {
      apply_shape(weakening.factor, *box);
    } else if (const auto* sphere = std::get_if<SphereSelector>(&weakening.edges)) {
      apply_shape(weakening.factor, *sphere);
    }
  }
  CountFactors(factors, thresholds);
}

void CountFactors(std::span<const double> factors, std::span<double> thresholds) {
  for (size_t edge = 0; edge < factors.size(); ++edge) {
    const double factor = factors[edge];
    const bool settles = factor == 0 || std::isinf(factor);  // whatever the threshold
    thresholds[edge] = settles ? factor : thresholds[edge] * factor;
  }
}

}  // namespace cleave
