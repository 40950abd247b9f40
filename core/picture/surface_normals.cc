#include "core/picture/surface_normals.h"

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

#include "core/base/parallel.h"

namespace cleave {
namespace {

Eigen::Vector3d At(const ShownSurface& surface, int32_t point) {
  return Eigen::Map<const Eigen::Vector3d>(surface.points[static_cast<size_t>(point)].data());
}

}  // namespace

std::vector<std::array<Eigen::Vector3f, 3>> CornerNormals(const ShownSurface& surface) {
  const size_t triangles = surface.triangles.size();
  std::vector<Eigen::Vector3f> area_normals(triangles);
  std::vector<Eigen::Vector3f> unit_normals(triangles);
  ParallelFor(static_cast<int64_t>(triangles), 4096, [&](int64_t begin, int64_t end) {
    for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
      const auto& [a, b, c] = surface.triangles[i];
      const Eigen::Vector3d origin = At(surface, a);
      const Eigen::Vector3d normal = (At(surface, b) - origin).cross(At(surface, c) - origin);
      area_normals[i] = normal.cast<float>();
      unit_normals[i] = normal.stableNormalized().cast<float>();
    }
  });
  std::vector<int32_t> offsets(surface.points.size() + 1, 0);
  for (const auto& triangle : surface.triangles) {
    for (const int32_t point : triangle) ++offsets[static_cast<size_t>(point) + 1];
  }
  for (size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  std::vector<int32_t> around(3 * triangles);
  std::vector<int32_t> next(offsets.begin(), offsets.end() - 1);
  for (size_t i = 0; i < triangles; ++i) {
    for (const int32_t point : surface.triangles[i]) {
      around[static_cast<size_t>(next[static_cast<size_t>(point)]++)] = static_cast<int32_t>(i);
    }
  }
  std::vector<std::array<Eigen::Vector3f, 3>> normals(triangles);
  ParallelFor(static_cast<int64_t>(triangles), 1024, [&](int64_t begin, int64_t end) {
    for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
      for (size_t k = 0; k < 3; ++k) {
        const auto point = static_cast<size_t>(surface.triangles[i][k]);
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (int32_t at = offsets[point]; at < offsets[point + 1]; ++at) {
          const auto other = static_cast<size_t>(around[static_cast<size_t>(at)]);
          if (surface.inside[other] != surface.inside[i]) continue;
          if (unit_normals[other].dot(unit_normals[i]) < kCreaseCosine) continue;
          sum += area_normals[other];
        }
        normals[i][k] = sum.squaredNorm() > 0 ? sum.stableNormalized() : unit_normals[i];
      }
    }
  });
  return normals;
}

}  // namespace cleave
