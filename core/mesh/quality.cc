#include "core/mesh/quality.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>

#include "core/mesh/faces.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

constexpr size_t kWorstKept = 10;

class RangeOf {
 public:
  void Add(double value) {
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
    sum_ += value;
    ++count_;
  }
  Range Get() const {
    if (count_ == 0) return {};
    return {min_, sum_ / static_cast<double>(count_), max_};
  }

 private:
  double min_ = std::numeric_limits<double>::infinity();
  double max_ = -std::numeric_limits<double>::infinity();
  double sum_ = 0;
  int64_t count_ = 0;
};

int64_t CountComponents(const TetMesh& mesh, const Incidence& incidence) {
  std::vector<int32_t> parent(mesh.rest_positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int32_t node) {
    while (parent[static_cast<size_t>(node)] != node) {
      int32_t& up = parent[static_cast<size_t>(node)];
      up = parent[static_cast<size_t>(up)];
      node = up;
    }
    return node;
  };
  int64_t count = 0;
  for (int64_t node = 0; node < mesh.node_count(); ++node)
    count += incidence.node_tets[node].empty() ? 0 : 1;
  for (const auto& [a, b] : incidence.edges) {
    const int32_t root_a = root(a);
    const int32_t root_b = root(b);
    if (root_a == root_b) continue;
    parent[static_cast<size_t>(std::max(root_a, root_b))] = std::min(root_a, root_b);
    --count;
  }
  return count;
}

// Counts the faces of exactly one tet and adds up their area.
void ReportSurface(const TetMesh& mesh, MeshReport& report) {
  const auto at = [&](int32_t node) {
    return Eigen::Map<const Eigen::Vector3d>(mesh.rest_positions[static_cast<size_t>(node)].data());
  };
  ForEachFace(
      mesh, [](int64_t) { return true; },
      [&](std::span<const FaceUse> uses) {
        if (uses.size() != 1) return;
        const auto& [a, b, c] = uses[0].nodes;
        ++report.boundary_face_count;
        report.surface_area += (at(b) - at(a)).cross(at(c) - at(a)).norm() / 2;
      });
}

}  // namespace

MeshReport ReportMesh(const TetMesh& mesh, const Incidence& incidence) {
  MeshReport report;
  report.node_count = mesh.node_count();
  report.tet_count = mesh.tet_count();
  report.edge_count = incidence.edge_count();
  report.component_count = CountComponents(mesh, incidence);
  if (mesh.tets.empty()) {
    report.unreferenced_node_count = report.node_count;
    return report;
  }

  report.min_corner.fill(std::numeric_limits<double>::infinity());
  report.max_corner.fill(-std::numeric_limits<double>::infinity());
  for (int64_t node = 0; node < mesh.node_count(); ++node) {
    if (incidence.node_tets[node].empty()) {
      ++report.unreferenced_node_count;
      continue;
    }
    for (size_t axis = 0; axis < 3; ++axis) {
      const double at = mesh.rest_positions[static_cast<size_t>(node)][axis];
      report.min_corner[axis] = std::min(report.min_corner[axis], at);
      report.max_corner[axis] = std::max(report.max_corner[axis], at);
    }
  }

  RangeOf lengths;
  for (const auto& [a, b] : incidence.edges) {
    const Vec3& p = mesh.rest_positions[static_cast<size_t>(a)];
    const Vec3& q = mesh.rest_positions[static_cast<size_t>(b)];
    lengths.Add(std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]));
  }
  report.edge_length = lengths.Get();

  RangeOf aspects;
  report.min_dihedral = std::numbers::pi;
  std::map<int32_t, RegionReport> regions;
  std::vector<WorstTet> shapes;
  shapes.reserve(mesh.tets.size());
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const TetCorners corners = CornersOf(mesh, tet);
    const double volume = SignedVolume(corners);
    const double aspect = Aspect(corners);
    const auto [smallest, largest] = DihedralRange(corners);
    report.volume += volume;
    aspects.Add(aspect);
    report.min_dihedral = std::min(report.min_dihedral, smallest);
    report.max_dihedral = std::max(report.max_dihedral, largest);
    shapes.push_back({tet, smallest, aspect});
    RegionReport& region = regions[mesh.region_of(tet)];
    ++region.tet_count;
    region.volume += volume;
  }
  report.aspect = aspects.Get();
  for (const MeshRegion& region : mesh.regions) regions[region.id].name = region.name;
  for (auto& [id, region] : regions) {
    region.id = id;
    report.regions.push_back(std::move(region));
  }
  const size_t kept = std::min(kWorstKept, shapes.size());
  std::partial_sort(shapes.begin(), shapes.begin() + static_cast<std::ptrdiff_t>(kept),
                    shapes.end(), [](const WorstTet& a, const WorstTet& b) {
                      return a.min_dihedral != b.min_dihedral ? a.min_dihedral < b.min_dihedral
                                                              : a.tet < b.tet;
                    });
  shapes.resize(kept);
  report.worst = std::move(shapes);
  ReportSurface(mesh, report);
  return report;
}

}  // namespace cleave
