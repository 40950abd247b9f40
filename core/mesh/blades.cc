#include "core/mesh/blades.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"
#include "core/mesh/projected_side.h"

namespace cleave {
namespace {

constexpr int64_t kGrain = 256;  // edges or nodes a task

// Where an edge crosses a curtain.
Vec3 CrossingPoint(const Vec3& direction, const BladeSegment& blade, const Vec3& first,
                   const Vec3& second) {
  const Eigen::Vector3d start(blade.start.data()), a(first.data()), b(second.data());
  const Eigen::Vector3d normal =
      (Eigen::Vector3d(blade.end.data()) - start).cross(Eigen::Vector3d(direction.data()));
  const double over_a = normal.dot(a - start), over_b = normal.dot(b - start);
  const double share = over_a == over_b ? 0.5 : std::clamp(over_a / (over_a - over_b), 0.0, 1.0);
  const Eigen::Vector3d point = a + share * (b - a);
  return {point[0], point[1], point[2]};
}

}  // namespace

Blades::Blades(BladeSet set, const TetMesh& mesh)
    : set_(std::move(set)), mesh_(mesh), view_(set_.direction), margin_(ViewMargin(mesh)) {
  if (std::isfinite(set_.depth)) depth_.emplace(mesh, set_.direction);
}

PlaneGrid Blades::SegmentGrid() const {
  std::vector<PlaneBox> boxes;
  boxes.reserve(set_.segments.size());
  for (const BladeSegment& segment : set_.segments) {
    const Vec2 start = view_.Across(segment.start), end = view_.Across(segment.end);
    // Far from the mesh rounding is coarser; what meets the mesh has its size.
    boxes.push_back(BoxOf(start, end));
    double largest = 0;
    for (const double x : {start[0], start[1], end[0], end[1]})
      largest = std::max(largest, std::abs(x));
    boxes.back().Grow(margin_ + 64 * std::numeric_limits<double>::epsilon() * largest);
  }
  return PlaneGrid(boxes);
}

bool Blades::Crosses(const BladeSegment& blade, const Vec3& a, const Vec3& b) const {
  return CrossesCurtain(set_.direction, blade.start, blade.end, a, b) &&
         (!depth_ || depth_->At(CrossingPoint(set_.direction, blade, a, b)) <= set_.depth);
}

std::vector<uint8_t> Blades::CrossedEdges(std::span<const std::array<int32_t, 2>> edges) const {
  const PlaneGrid grid = SegmentGrid();
  std::vector<uint8_t> crossed(edges.size(), 0);
  ParallelFor(static_cast<int64_t>(edges.size()), kGrain, [&](int64_t begin, int64_t end) {
    for (int64_t e = begin; e < end; ++e) {
      const auto edge = static_cast<size_t>(e);
      const Vec3& a = mesh_.rest_positions[static_cast<size_t>(edges[edge][0])];
      const Vec3& b = mesh_.rest_positions[static_cast<size_t>(edges[edge][1])];
      PlaneBox box = BoxOf(view_.Across(a), view_.Across(b));
      box.Grow(margin_);
      grid.Near(box, [&](int32_t id) {
        if (crossed[edge] == 0)
          crossed[edge] = Crosses(set_.segments[static_cast<size_t>(id)], a, b);
      });
    }
  });
  return crossed;
}

std::vector<uint8_t> Blades::CrossingCurves(std::span<const std::array<int32_t, 2>> edges,
                                            std::span<const int32_t> curve_of,
                                            size_t curves) const {
  const PlaneGrid grid = SegmentGrid();
  std::vector<uint8_t> crosses(curves, 0);
  size_t left = curves;
  for (size_t edge = 0; edge < edges.size() && left > 0; ++edge) {
    const Vec3& a = mesh_.rest_positions[static_cast<size_t>(edges[edge][0])];
    const Vec3& b = mesh_.rest_positions[static_cast<size_t>(edges[edge][1])];
    PlaneBox box = BoxOf(view_.Across(a), view_.Across(b));
    box.Grow(margin_);
    grid.Near(box, [&](int32_t id) {
      const auto curve = static_cast<size_t>(curve_of[static_cast<size_t>(id)]);
      if (crosses[curve] != 0 || !Crosses(set_.segments[static_cast<size_t>(id)], a, b)) return;
      crosses[curve] = 1;
      --left;
    });
  }
  return crosses;
}

std::vector<uint8_t> Blades::HoldingCurves(std::span<const int32_t> curve_of, size_t curves) const {
  const PlaneGrid grid = GrooveGrid(0);
  std::vector<uint8_t> holds(curves, 0);
  for (const Vec3& place : mesh_.rest_positions) {
    const Vec2 at = view_.Across(place);
    std::optional<bool> deep;  // below the depth
    grid.Near({at, at}, [&](int32_t id) {
      const BladeSegment& segment = set_.segments[static_cast<size_t>(id)];
      uint8_t& held = holds[static_cast<size_t>(curve_of[static_cast<size_t>(id)])];
      if (held != 0 || std::max(segment.radii[0], segment.radii[1]) <= 0 ||
          OutsideAcross(segment, at) > 0)
        return;
      if (!deep) deep = depth_ && depth_->At(place) > set_.depth;
      if (!*deep) held = 1;
    });
  }
  return holds;
}

double Blades::OutsideAcross(const BladeSegment& segment, const Vec2& at) const {
  const Vec2 start = view_.Across(segment.start), stop = view_.Across(segment.end);
  const Vec2 run = {stop[0] - start[0], stop[1] - start[1]};
  const double squared = run[0] * run[0] + run[1] * run[1];
  const double along = run[0] * (at[0] - start[0]) + run[1] * (at[1] - start[1]);
  const double share = squared > 0 ? std::clamp(along / squared, 0.0, 1.0) : 0;
  const double across =
      std::hypot(at[0] - start[0] - share * run[0], at[1] - start[1] - share * run[1]);
  const double radius = segment.radii[0] + share * (segment.radii[1] - segment.radii[0]);
  return std::max(0.0, across - radius);
}

PlaneGrid Blades::GrooveGrid(double reach) const {
  std::vector<PlaneBox> boxes;
  boxes.reserve(set_.segments.size());
  for (const BladeSegment& segment : set_.segments) {
    boxes.push_back(BoxOf(view_.Across(segment.start), view_.Across(segment.end)));
    boxes.back().Grow(reach + std::max(segment.radii[0], segment.radii[1]) + margin_);
  }
  return PlaneGrid(boxes);
}

std::vector<double> Blades::DistancesOutside(double reach) const {
  const PlaneGrid grid = GrooveGrid(reach);
  std::vector<double> distances(mesh_.rest_positions.size(),
                                std::numeric_limits<double>::infinity());
  ParallelFor(mesh_.node_count(), kGrain, [&](int64_t begin, int64_t end) {
    for (int64_t n = begin; n < end; ++n) {
      const auto node = static_cast<size_t>(n);
      const Vec2 at = view_.Across(mesh_.rest_positions[node]);
      double& distance = distances[node];
      grid.Near({at, at}, [&](int32_t id) {
        distance = std::min(distance, OutsideAcross(set_.segments[static_cast<size_t>(id)], at));
      });
      if (distance > reach) distance = std::numeric_limits<double>::infinity();
      if (!depth_ || std::isinf(distance)) continue;
      const double below = std::max(0.0, depth_->At(mesh_.rest_positions[node]) - set_.depth);
      distance = std::hypot(distance, below);
      if (distance > reach) distance = std::numeric_limits<double>::infinity();
    }
  });
  return distances;
}

}  // namespace cleave
