#include "client/io/bake/normal_groups.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <utility>

#include "core/base/parallel.h"
#include "core/picture/surface_normals.h"

namespace cleave {
namespace {

// Twice its area long.
Eigen::Vector3d AreaNormal(const std::array<int32_t, 3>& triangle,
                           const std::vector<Vec3>& points) {
  const auto at = [&](size_t k) {
    return Eigen::Map<const Eigen::Vector3d>(points[static_cast<size_t>(triangle[k])].data());
  };
  return (at(1) - at(0)).cross(at(2) - at(0));
}

}  // namespace

NormalGroups::NormalGroups(const SurfaceTopology& topology)
    : triangles_(topology.triangles), groups_(topology.triangles.size()) {
  std::vector<Vec3> points;
  points.reserve(topology.points.size());
  for (const SurfacePoint& point : topology.points) points.push_back(point.rest);
  std::vector<Eigen::Vector3d> units;
  units.reserve(triangles_.size());
  Csr around;  // triangles and corners of each point, as 3 * triangle + corner
  around.offsets.assign(points.size() + 1, 0);
  for (const auto& triangle : triangles_) {
    units.push_back(AreaNormal(triangle, points).stableNormalized());
    for (const int32_t point : triangle) ++around.offsets[static_cast<size_t>(point) + 1];
  }
  for (size_t i = 0; i < points.size(); ++i) around.offsets[i + 1] += around.offsets[i];
  std::vector<int32_t> next(around.offsets.begin(), around.offsets.end() - 1);
  around.items.resize(3 * triangles_.size());
  for (size_t i = 0; i < around.items.size(); ++i) {
    int32_t& place = next[static_cast<size_t>(triangles_[i / 3][i % 3])];
    around.items[static_cast<size_t>(place++)] = static_cast<int32_t>(i);
  }
  members_.offsets.push_back(0);
  std::vector<std::pair<std::vector<int32_t>, int32_t>> known;  // of a point
  for (int64_t point = 0; point < around.rows(); ++point) {
    known.clear();
    for (const int32_t corner : around[point]) {
      const auto own = static_cast<size_t>(corner / 3);
      std::vector<int32_t> members;
      for (const int32_t each : around[point]) {
        const auto other = static_cast<size_t>(each / 3);
        const bool is_smooth = topology.inside[other] == topology.inside[own] &&
                               units[other].dot(units[own]) >= kCreaseCosine;
        if (is_smooth || other == own) members.push_back(each / 3);
      }
      int32_t& group = groups_[own][static_cast<size_t>(corner % 3)];
      group = -1;
      for (const auto& [list, number] : known) {
        if (list == members) group = number;
      }
      if (group >= 0) continue;
      group = count();
      members_.items.insert(members_.items.end(), members.begin(), members.end());
      members_.offsets.push_back(static_cast<int32_t>(members_.items.size()));
      known.emplace_back(std::move(members), group);
    }
  }
  std::vector<std::array<float, 3>> found;
  rest_.assign(static_cast<size_t>(count()), {0, 0, 1});
  Find(points, found);
  rest_ = std::move(found);
}

void NormalGroups::Find(const std::vector<Vec3>& points,
                        std::vector<std::array<float, 3>>& normals) const {
  normals.resize(rest_.size());
  ParallelFor(members_.rows(), 1024, [&](int64_t begin, int64_t end) {
    for (int64_t group = begin; group < end; ++group) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (const int32_t member : members_[group])
        sum += AreaNormal(triangles_[static_cast<size_t>(member)], points);
      const auto g = static_cast<size_t>(group);
      const double length = sum.stableNorm();
      normals[g] = rest_[g];
      for (size_t k = 0; k < 3 && length > 0; ++k)
        normals[g][k] = static_cast<float>(sum[static_cast<Eigen::Index>(k)] / length);
    }
  });
}

}  // namespace cleave
