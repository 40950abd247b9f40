#include "core/surface/render_mesh.h"

#include <cmath>
#include <cstddef>
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
