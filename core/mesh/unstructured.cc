#include "core/mesh/unstructured.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/mesh/delaunay.h"
#include "core/mesh/faces.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/placed_points.h"
#include "core/mesh/reorder.h"
#include "core/mesh/tet_improver.h"

namespace cleave {
namespace {

constexpr int kSmoothings = 6;
constexpr double kLeastDepth = 0.45;   // cell sizes, of inner nodes, kept through smoothing
constexpr double kImageDepth = 1.2;    // cell sizes, of points that are mirrored at a round side
constexpr double kBridgeDepth = 0.25;  // cell sizes; inner nodes lie deeper
constexpr double kWantedSine = 0.35;   // of dihedral angles: 20 degrees
constexpr double kAcceptedSine = 0.1;  // below it another set of points is tried
constexpr int kImprovingPasses = 12;
constexpr int kMostTries = 4;

using Tets = std::vector<std::array<int32_t, 4>>;

// The body as it is meshed: nowhere thinner than a cell.
Body Stretched(const Body& body, double cell_size) {
  Body stretched = body;
  for (size_t axis = 0; axis < 3; ++axis) {
    const double least = cell_size * (axis == 2 ? body.min_layers : 1);
    stretched.size[axis] = std::max(body.size[axis], least);
  }
  if (body.inner_radius > 0 && body.outer_radius - body.inner_radius < cell_size) {
    const double middle = (body.outer_radius + body.inner_radius) / 2;
    stretched.inner_radius = middle - cell_size / 2;
    stretched.outer_radius = middle + cell_size / 2;
  }
  return stretched;
}

// Where a point of the stretched body lies in the body itself.
Vec3 Pressed(const Vec3& p, const Body& stretched, const Body& body) {
  Vec3 result = p;
  for (size_t axis = body.round ? 2 : 0; axis < 3; ++axis) {
    if (stretched.size[axis] != body.size[axis])
      result[axis] = p[axis] / stretched.size[axis] * body.size[axis];
  }
  if (body.inner_radius > 0 && stretched.inner_radius != body.inner_radius) {
    const double radius = std::hypot(p[0], p[1]);
    const double share =
        (radius - stretched.inner_radius) / (stretched.outer_radius - stretched.inner_radius);
    const double pressed = body.inner_radius + share * (body.outer_radius - body.inner_radius);
    result[0] *= pressed / radius;
    result[1] *= pressed / radius;
  }
  return result;
}

// Points outside a round body, the images of those near its round sides. With them beyond, the
// triangles on a side come out as if it were flat; alone, the hull would bridge a side by long thin
// triangles along z and the hole of a tube would be spanned by tets as long as it is wide.
std::vector<Vec3> ImagesOf(const PlacedPoints& points, const Body& body, double cell_size) {
  std::vector<Vec3> images;
  if (!body.round) return images;
  const double reach = kImageDepth * cell_size;
  for (size_t node = 0; node < points.positions.size(); ++node) {
    const Vec3& p = points.positions[node];
    const double radius = std::hypot(p[0], p[1]);
    if (radius == 0) continue;  // no direction to be mirrored in
    for (const double side : {body.outer_radius, body.inner_radius}) {
      if (side == 0 || points.bindings[node].radius == side || std::abs(radius - side) > reach)
        continue;
      const double depth = std::abs(radius - side);
      const double beyond = 1.1 * cell_size + 0.4 * depth;
      const double image =
          side == body.outer_radius ? side + beyond : std::max(side - beyond, 0.2 * side);
      images.push_back({p[0] / radius * image, p[1] / radius * image, p[2]});
    }
  }
  return images;
}

// Delaunay tets of the points that lie in the body.
Tets TetsOf(const PlacedPoints& points, const Body& body, double cell_size) {
  std::vector<Vec3> all = points.positions;
  const std::vector<Vec3> images = ImagesOf(points, body, cell_size);
  all.insert(all.end(), images.begin(), images.end());
  const auto count = static_cast<int32_t>(points.positions.size());
  Tets tets = DelaunayTets(all);
  std::erase_if(tets, [&](const std::array<int32_t, 4>& nodes) {
    // A tet of points on the inner side of a tube alone lies in its hole.
    bool in_hole = body.inner_radius > 0;
    for (const int32_t node : nodes) {
      if (node >= count) return true;
      in_hole = in_hole && points.bindings[static_cast<size_t>(node)].radius == body.inner_radius;
    }
    return in_hole;
  });
  return tets;
}

// Whether every triangle of the surface lies on one side of the body: none reaches inside, or cuts
// an edge of the body off.
bool SurfaceIsWhole(const PlacedPoints& points, const Tets& tets) {
  TetMesh mesh;
  mesh.rest_positions = points.positions;
  mesh.tets = tets;
  bool whole = true;
  ForEachFace(
      mesh, [](int64_t) { return true; },
      [&](std::span<const FaceUse> uses) {
        if (uses.size() != 1) return;
        uint8_t shared_axes = 7;
        const double radius = points.bindings[static_cast<size_t>(uses[0].nodes[0])].radius;
        bool round = radius > 0;
        for (const int32_t node : uses[0].nodes) {
          const Binding& binding = points.bindings[static_cast<size_t>(node)];
          shared_axes &= binding.fixed_axes;
          round = round && binding.radius == radius;
        }
        whole = whole && (round || shared_axes != 0);
      });
  return whole;
}

// Keeps an inner point the least depth below the surface.
Vec3 KeptDeep(const Body& body, double depth, Vec3 p) {
  for (size_t axis = body.round ? 2 : 0; axis < 3; ++axis) {
    const double far = std::max(depth, body.size[axis] - depth);
    p[axis] = std::clamp(p[axis], std::min(depth, body.size[axis] / 2), far);
  }
  if (!body.round) return p;
  const double radius = std::hypot(p[0], p[1]);
  const double least = body.inner_radius > 0 ? body.inner_radius + depth : 0;
  const double most = std::max(least, body.outer_radius - depth);
  if (radius > 0 && (radius < least || radius > most)) {
    const double scale = std::clamp(radius, least, most) / radius;
    p[0] *= scale;
    p[1] *= scale;
  }
  return p;
}

// One round of optimal Delaunay smoothing (Chen and Xu 2004): inner nodes go to the volume-weighted
// mean of the circumcentres round them, nodes on a side to the area-weighted mean of the centroids
// of its triangles.
void Smooth(PlacedPoints& points, const Body& body, double cell_size) {
  TetMesh mesh;
  mesh.tets = TetsOf(points, body, cell_size);
  mesh.rest_positions = points.positions;
  const size_t count = points.positions.size();
  std::vector<Eigen::Vector3d> sums(count, Eigen::Vector3d::Zero());
  std::vector<double> weights(count, 0);
  const auto at = [&](int32_t node) {
    return Eigen::Map<const Eigen::Vector3d>(mesh.rest_positions[static_cast<size_t>(node)].data());
  };
  for (const auto& nodes : mesh.tets) {
    const Eigen::Vector3d a = at(nodes[0]);
    const Eigen::Vector3d u = at(nodes[1]) - a;
    const Eigen::Vector3d v = at(nodes[2]) - a;
    const Eigen::Vector3d w = at(nodes[3]) - a;
    const double volume = u.dot(v.cross(w)) / 6;
    // Volume times circumcentre, which stays small where the centre itself runs off.
    const Eigen::Vector3d moment =
        volume * a + (u.squaredNorm() * v.cross(w) + v.squaredNorm() * w.cross(u) +
                      w.squaredNorm() * u.cross(v)) /
                         12;
    for (const int32_t node : nodes) {
      if (!points.bindings[static_cast<size_t>(node)].inside()) continue;
      sums[static_cast<size_t>(node)] += moment;
      weights[static_cast<size_t>(node)] += volume;
    }
  }
  const auto nearly_outside = [&](int64_t tet) {
    int bound = 0;
    for (const int32_t node : mesh.tets[static_cast<size_t>(tet)])
      bound += points.bindings[static_cast<size_t>(node)].inside() ? 0 : 1;
    return bound >= 3;
  };
  ForEachFace(mesh, nearly_outside, [&](std::span<const FaceUse> uses) {
    if (uses.size() != 1) return;
    const auto& [a, b, c] = uses[0].nodes;
    const double area = (at(b) - at(a)).cross(at(c) - at(a)).norm();
    const Eigen::Vector3d centroid = (at(a) + at(b) + at(c)) / 3;
    for (const int32_t node : uses[0].nodes) {
      if (!points.bindings[static_cast<size_t>(node)].on_one_side()) continue;
      sums[static_cast<size_t>(node)] += area * centroid;
      weights[static_cast<size_t>(node)] += area;
    }
  });
  for (size_t node = 0; node < count; ++node) {
    if (!(weights[node] > 0)) continue;
    const Eigen::Vector3d mean = sums[node] / weights[node];
    const Binding& binding = points.bindings[node];
    const Vec3 to = Bound(binding, points.positions[node], {mean[0], mean[1], mean[2]});
    points.positions[node] = binding.inside() ? KeptDeep(body, kLeastDepth * cell_size, to) : to;
  }
}

}  // namespace

absl::StatusOr<TetMesh> UnstructuredMesh(const Body& body, const MeshResolution& resolution) {
  const double cell_size = resolution.cell_size;
  const Body stretched = Stretched(body, cell_size);
  for (uint64_t attempt = 0; attempt < kMostTries; ++attempt) {
    PlacedPoints points = PlacePoints(stretched, cell_size, resolution.seed | attempt << 32);
    for (int round = 0; round < kSmoothings; ++round) Smooth(points, stretched, cell_size);
    const Tets tets = TetsOf(points, stretched, cell_size);
    if (!SurfaceIsWhole(points, tets)) continue;
    TetImprover improver(std::move(points), tets);
    if (stretched.round) improver.PeelRoundSide(stretched.outer_radius, kBridgeDepth * cell_size);
    const double smallest = improver.Improve(kWantedSine, kImprovingPasses);
    if (!(smallest > kAcceptedSine)) continue;
    TetMesh mesh = improver.Take();
    for (Vec3& position : mesh.rest_positions) position = Pressed(position, stretched, body);
    const Faults faults = CheckAndOrientMesh(mesh);
    if (!faults.ok() || faults.warning_count() > 0) continue;
    return Reordered(mesh, LocalityOrder(mesh));
  }
  return absl::InternalError(
      "no sound unstructured mesh was found; another seed or cell_size will give one");
}

}  // namespace cleave
