#include "core/scene/render_mesh_rules.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/scene/checker.h"
#include "core/scene/limits.h"

namespace cleave {
namespace {

constexpr double kMostRatio = 1.5;  // of diagonals
constexpr double kFarthest = 0.5;   // from the body's box, of its diagonal

struct Box {
  Vec3 low, high;

  double Diagonal() const {
    return std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  }
  double DistanceTo(const Vec3& point) const {
    Vec3 beyond;
    for (size_t axis = 0; axis < 3; ++axis)
      beyond[axis] = std::max({low[axis] - point[axis], point[axis] - high[axis], 0.0});
    return std::hypot(beyond[0], beyond[1], beyond[2]);
  }
};

Box BoxOf(std::span<const Vec3> points) {
  Box box{points[0], points[0]};
  for (const Vec3& p : points) {
    for (size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], p[axis]);
      box.high[axis] = std::max(box.high[axis], p[axis]);
    }
  }
  return box;
}

void CheckNumbers(const RenderMesh& mesh, Faults& faults) {
  for (size_t i = 0; i < mesh.points.size(); ++i) {
    const Vec3& p = mesh.points[i];
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
    faults.Error(At("points", i), "is not finite");
    break;
  }
  for (size_t i = 0; i < mesh.uvs.size(); ++i) {
    const bool finite = std::all_of(mesh.uvs[i].begin(), mesh.uvs[i].end(), [](const auto& uv) {
      return std::isfinite(uv[0]) && std::isfinite(uv[1]);
    });
    if (finite) continue;
    faults.Error(At("uvs", i), "is not finite");
    break;
  }
}

void CheckCorners(const RenderMesh& mesh, Faults& faults) {
  for (size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const int32_t point : mesh.triangles[i]) {
      if (point >= 0 && static_cast<size_t>(point) < mesh.points.size()) continue;
      faults.Error(At("triangles", i),
                   absl::StrCat("point ", point, " is outside [0, ", mesh.points.size(), ")"));
      return;
    }
  }
}

}  // namespace

void CheckRenderMeshSource(const RenderMeshSource& source, Faults& faults) {
  Checker check(faults);
  if (const auto* file = std::get_if<MeshFile>(&source.source)) {
    faults.Error("render_mesh.file",
                 absl::StrCat("\"", file->path.substr(0, limits::kMaxNameBytes),
                              "\" is a path of the client; upload the mesh and send "
                              "render_mesh.asset"));
  } else if (const auto* asset = std::get_if<MeshAsset>(&source.source)) {
    check.Sha256("render_mesh.asset", asset->sha256);
  } else {
    faults.Error("render_mesh", "names no source; one of file, asset is required");
  }
  check.Above("render_mesh.unit_scale", source.unit_scale, 0, limits::kMaxUnitScale);
}

Faults CheckRenderMesh(const RenderMesh& mesh) {
  Faults faults;
  Checker check(faults);
  if (mesh.triangles.empty()) faults.Error("triangles", "is empty");
  const bool few_triangles =
      check.List("triangles", mesh.triangles.size(), limits::kMaxRenderTriangles);
  const bool few_points = check.List("points", mesh.points.size(), 3 * limits::kMaxRenderTriangles);
  if (!mesh.uvs.empty() && mesh.uvs.size() != mesh.triangles.size())
    faults.Error("uvs",
                 absl::StrCat("has ", mesh.uvs.size(), " items, not ", mesh.triangles.size()));
  if (!few_triangles || !few_points) return faults;
  CheckNumbers(mesh, faults);
  CheckCorners(mesh, faults);
  return faults;
}

Faults CheckRenderMeshFits(const RenderMesh& mesh, std::span<const Vec3> rest_positions) {
  Faults faults;
  const Box render = BoxOf(mesh.points);
  const Box body = BoxOf(rest_positions);
  const double render_size = render.Diagonal();
  const double body_size = body.Diagonal();
  if (!(render_size <= kMostRatio * body_size && body_size <= kMostRatio * render_size)) {
    faults.Error("points", absl::StrCat("spans ", render_size, " m, the body ", body_size,
                                        " m: is it in the same units?"));
    return faults;
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    if (render.low[axis] <= body.high[axis] && body.low[axis] <= render.high[axis]) continue;
    faults.Error("points",
                 absl::StrCat("lies beside the body: along ", std::string(1, "xyz"[axis]), " in [",
                              render.low[axis], ", ", render.high[axis], "] m, the body in [",
                              body.low[axis], ", ", body.high[axis], "] m"));
    return faults;
  }
  for (size_t i = 0; i < mesh.points.size(); ++i) {
    const double distance = body.DistanceTo(mesh.points[i]);
    if (distance <= kFarthest * body_size) continue;
    faults.Error(At("points", i),
                 absl::StrCat("is ", distance, " m away from the body's bounding box; at most ",
                              kFarthest * body_size, " m, half of its diagonal, is allowed"));
    break;
  }
  return faults;
}

}  // namespace cleave
