#include "core/mesh/surface_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "core/mesh/boundary_faces.h"
#include "core/mesh/projected_side.h"

namespace cleave {
namespace {

// Where the line through `point` meets a face, in m along the direction; none where it passes by.
std::optional<double> HeightOf(const std::array<Vec3, 3>& face, const Vec3& direction,
                               const PlaneView& view, const Vec3& point) {
  bool left = false, right = false;
  for (size_t i = 0; i < 3; ++i) {
    const int side = ProjectedSide(direction, face[i], face[(i + 1) % 3], point);
    left = left || side > 0;
    right = right || side < 0;
  }
  if (left && right) return std::nullopt;
  const Vec2 a = view.Across(face[0]), b = view.Across(face[1]), c = view.Across(face[2]);
  const Vec2 p = view.Across(point);
  const auto area = [](const Vec2& x, const Vec2& y, const Vec2& z) {
    return (y[0] - x[0]) * (z[1] - x[1]) - (y[1] - x[1]) * (z[0] - x[0]);
  };
  const double whole = area(a, b, c);
  if (whole == 0) return std::nullopt;  // seen edge-on but for rounding
  const double at_a = area(p, b, c) / whole, at_b = area(a, p, c) / whole;
  const double height = at_a * view.Along(face[0]) + at_b * view.Along(face[1]) +
                        (1 - at_a - at_b) * view.Along(face[2]);
  // Faces seen nearly edge-on leave their own range by rounding.
  const auto [low, high] =
      std::minmax({view.Along(face[0]), view.Along(face[1]), view.Along(face[2])});
  return std::clamp(height, low, high);
}

}  // namespace

double ViewMargin(const TetMesh& mesh) {
  double largest = 0;
  for (const Vec3& point : mesh.rest_positions) {
    for (const double x : point) largest = std::max(largest, std::abs(x));
  }
  return 64 * std::numeric_limits<double>::epsilon() * largest;
}

SurfaceDepth::SurfaceDepth(const TetMesh& mesh, const Vec3& direction)
    : direction_(direction), view_(direction), margin_(ViewMargin(mesh)) {
  std::vector<int32_t> nodes(static_cast<size_t>(mesh.node_count()));
  std::iota(nodes.begin(), nodes.end(), 0);
  std::vector<PlaneBox> boxes;
  for (const BoundaryFace& face : FindBoundaryFaces(mesh, nodes)) {
    std::array<Vec3, 3> corners;
    for (size_t i = 0; i < 3; ++i)
      corners[i] = mesh.rest_positions[static_cast<size_t>(face.nodes[i])];
    // Seen edge-on it hides nothing that its neighbours do not.
    if (ProjectedSide(direction_, corners[0], corners[1], corners[2]) == 0) continue;
    faces_.push_back(corners);
    PlaneBox& box = boxes.emplace_back(BoxOf(view_.Across(corners[0]), view_.Across(corners[1])));
    box.Add(view_.Across(corners[2]));
    box.Grow(margin_);
  }
  grid_ = PlaneGrid(boxes);
}

double SurfaceDepth::At(const Vec3& point) const {
  PlaneBox box{view_.Across(point), view_.Across(point)};
  box.Grow(margin_);
  const double here = view_.Along(point);
  double depth = 0;
  grid_.Near(box, [&](int32_t face) {
    const auto height = HeightOf(faces_[static_cast<size_t>(face)], direction_, view_, point);
    if (height) depth = std::max(depth, here - *height);
  });
  return depth;
}

}  // namespace cleave
