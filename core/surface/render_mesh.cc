#include "core/surface/render_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <unordered_map>

#include "absl/strings/str_cat.h"
#include "core/base/faults.h"

namespace cleave {

absl::Status CheckRenderMesh(const RenderMesh& mesh) {
  Faults faults;
  if (mesh.triangles.empty()) faults.Error("triangles", "is empty");
  for (size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3& p = mesh.points[i];
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
    faults.Error(absl::StrCat("points[", i, "]"), "is not finite");
    break;
  }
  if (!mesh.uvs.empty() && mesh.uvs.size() != mesh.triangles.size())
    faults.Error("uvs",
                 absl::StrCat("has ", mesh.uvs.size(), " items, not ", mesh.triangles.size()));
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto& [a, b, c] = mesh.triangles[i];
    for (const int32_t point : {a, b, c}) {
      if (point >= 0 && static_cast<size_t>(point) < mesh.points.size()) continue;
      faults.Error(absl::StrCat("triangles[", i, "]"),
                   absl::StrCat("point ", point, " is outside [0, ", mesh.points.size(), ")"));
      return faults.ToStatus();
    }
  }
  for (size_t i = 0; i < mesh.uvs.size(); ++i) {
    for (const auto& [u, v] : mesh.uvs[i]) {
      if (std::isfinite(u) && std::isfinite(v)) continue;
      faults.Error(absl::StrCat("uvs[", i, "]"), "is not finite");
      return faults.ToStatus();
    }
  }
  return faults.ToStatus();
}

absl::Status CheckRenderMeshFits(const RenderMesh& mesh, std::span<const Vec3> rest_positions) {
  constexpr double kMostRatio = 1.5;
  struct Box {
    Vec3 low, high;
    double Diagonal() const {
      return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
    }
  };
  const auto box_of = [](std::span<const Vec3> points) {
    Box box{points[0], points[0]};
    for (const Vec3& p : points) {
      for (size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], p[axis]);
        box.high[axis] = std::max(box.high[axis], p[axis]);
      }
    }
    return box;
  };
  const Box render = box_of(mesh.points);
  const Box body = box_of(rest_positions);
  const double render_size = render.Diagonal();
  const double body_size = body.Diagonal();
  if (!(render_size <= kMostRatio * body_size && body_size <= kMostRatio * render_size)) {
    return absl::InvalidArgumentError(absl::StrCat("spans ", render_size, " m, the body ",
                                                   body_size, " m: is it in the same units?"));
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    if (render.low[axis] <= body.high[axis] && body.low[axis] <= render.high[axis]) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("lies beside the body: along ", std::string(1, "xyz"[axis]), " in [",
                     render.low[axis], ", ", render.high[axis], "] m, the body in [",
                     body.low[axis], ", ", body.high[axis], "] m"));
  }
  return absl::OkStatus();
}

int64_t CountOpenEdges(const std::vector<std::array<int32_t, 3>>& triangles) {
  // How much oftener an edge is run through from its smaller point.
  std::unordered_map<uint64_t, int32_t> surplus;
  surplus.reserve(3 * triangles.size());
  for (const auto& triangle : triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const auto a = static_cast<uint64_t>(triangle[k]);
      const auto b = static_cast<uint64_t>(triangle[(k + 1) % 3]);
      if (a != b) surplus[a < b ? a << 32 | b : b << 32 | a] += a < b ? 1 : -1;
    }
  }
  int64_t open = 0;
  for (const auto& [edge, count] : surplus) open += std::abs(count);
  return open;
}

}  // namespace cleave
