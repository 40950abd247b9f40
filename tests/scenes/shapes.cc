#include "tests/scenes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "core/base/status.h"
#include "core/mesh/boundary_faces.h"
#include "core/mesh/procedural.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

absl::StatusOr<TetMesh> CenteredBox(const Vec3& size, const MeshResolution& resolution) {
  BoxMesh box;
  box.origin = {-size[0] / 2, -size[1] / 2, -size[2] / 2};
  box.size = size;
  box.resolution = resolution;
  return BuildMesh(box);
}

// The largest of |p_i / half_i| over the first `axes`, and their n-norm: their quotient carries a
// box onto the superellipsoid, each ray from the centre onto itself.
struct Norms {
  double box = 0;
  double ellipsoid = 0;
};
Norms NormsOf(const Vec3& p, const Vec3& size, double exponent, size_t axes) {
  Norms norms;
  double sum = 0;
  for (size_t axis = 0; axis < axes; ++axis) {
    const double share = std::abs(p[axis]) / (size[axis] / 2);
    norms.box = std::max(norms.box, share);
    sum += std::pow(share, exponent);
  }
  norms.ellipsoid = std::pow(sum, 1 / exponent);
  return norms;
}

// Tets that a rounded-off edge of the box flattened are left out: what was a sharp edge is part of
// a smooth side, on which they have no room.
void LeaveOutFlatTets(TetMesh& mesh, double cell_size) {
  const double least = 0.01 * cell_size * cell_size * cell_size;
  std::vector<std::array<int32_t, 4>> kept;
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    if (SignedVolume(CornersOf(mesh, tet)) > least)
      kept.push_back(mesh.tets[static_cast<size_t>(tet)]);
  }
  mesh.tets = std::move(kept);
}

void DropUnusedNodes(TetMesh& mesh) {
  std::vector<int32_t> ids(mesh.rest_positions.size(), -1);
  for (const auto& tet : mesh.tets)
    for (const int32_t node : tet) ids[static_cast<size_t>(node)] = 0;
  std::vector<Vec3> positions;
  for (size_t node = 0; node < ids.size(); ++node) {
    if (ids[node] < 0) continue;
    ids[node] = static_cast<int32_t>(positions.size());
    positions.push_back(mesh.rest_positions[node]);
  }
  for (auto& tet : mesh.tets)
    for (int32_t& node : tet) node = ids[static_cast<size_t>(node)];
  mesh.rest_positions = std::move(positions);
}

void RoundOff(TetMesh& mesh, const Vec3& size, double exponent, size_t axes) {
  for (Vec3& p : mesh.rest_positions) {
    const Norms norms = NormsOf(p, size, exponent, axes);
    if (norms.ellipsoid == 0) continue;
    for (size_t axis = 0; axis < axes; ++axis) p[axis] *= norms.box / norms.ellipsoid;
  }
}

double SmoothStep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

// `distance` is signed, negative inside, and `normal` its gradient.
struct SurfaceSide {
  double distance = 0;  // m
  Vec3 normal{0, 0, 0};
};

// What of a box is within a surface: tets that lie inside, the nodes of their boundary moved onto
// the surface as far as that crushes no tet. Precondition: the box holds the surface.
absl::StatusOr<TetMesh> CutFromBox(const BoxMesh& box,
                                   const std::function<SurfaceSide(const Vec3&)>& side) {
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, BuildMesh(box));
  const double cell = box.resolution.cell_size;
  std::vector<double> distances;
  for (const Vec3& p : mesh.rest_positions) distances.push_back(side(p).distance);
  const auto at = [&](int32_t node) -> double& { return distances[static_cast<size_t>(node)]; };
  // How far out a node may be for its tets to be kept: all nodes of the boundary that is left go
  // onto the surface.
  constexpr double kSnap = 0.45;  // cells
  std::erase_if(mesh.tets, [&](const std::array<int32_t, 4>& nodes) {
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](int32_t node) { return at(node) > kSnap * cell; });
  });
  // A tet all of whose nodes would lie on the surface is left out.
  std::erase_if(mesh.tets, [&](const std::array<int32_t, 4>& nodes) {
    return std::all_of(nodes.begin(), nodes.end(),
                       [&](int32_t node) { return at(node) > -kSnap * cell; });
  });
  const std::vector<Vec3> from = mesh.rest_positions;
  std::vector<double> shares(from.size(), 0);
  std::vector<int32_t> nodes(from.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  for (const BoundaryFace& face : FindBoundaryFaces(mesh, nodes))
    for (const int32_t node : face.nodes) shares[static_cast<size_t>(node)] = 1;
  // Where a tet would be crushed its nodes go a part of the way only.
  std::vector<double> volumes;
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet)
    volumes.push_back(SignedVolume(CornersOf(mesh, tet)));
  for (bool crushed = true; crushed;) {
    crushed = false;
    for (size_t node = 0; node < from.size(); ++node) {
      if (shares[node] == 0) {
        mesh.rest_positions[node] = from[node];
        continue;
      }
      const SurfaceSide there = side(from[node]);
      for (size_t axis = 0; axis < 3; ++axis) {
        mesh.rest_positions[node][axis] =
            from[node][axis] - shares[node] * there.distance * there.normal[axis];
      }
    }
    for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
      const auto index = static_cast<size_t>(tet);
      if (SignedVolume(CornersOf(mesh, tet)) >= 0.1 * volumes[index]) continue;
      for (const int32_t node : mesh.tets[index]) {
        double& share = shares[static_cast<size_t>(node)];
        crushed = crushed || share > 0;
        share = share > 0.2 ? 0.7 * share : 0;
      }
    }
  }
  DropUnusedNodes(mesh);
  return mesh;
}

}  // namespace

absl::StatusOr<TetMesh> SuperellipseSlab(const Vec3& size, double exponent,
                                         const MeshResolution& resolution) {
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, CenteredBox(size, resolution));
  RoundOff(mesh, size, exponent, 2);
  LeaveOutFlatTets(mesh, resolution.cell_size);
  return mesh;
}

absl::StatusOr<TetMesh> SuperellipsoidLoaf(const Vec3& size, double exponent,
                                           const MeshResolution& resolution) {
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, CenteredBox(size, resolution));
  RoundOff(mesh, size, exponent, 3);
  LeaveOutFlatTets(mesh, resolution.cell_size);
  return mesh;
}

double SuperellipsoidDepth(const Vec3& position, const Vec3& size, double exponent) {
  return 1 - NormsOf(position, size, exponent, 3).ellipsoid;
}

absl::StatusOr<TetMesh> Branch(const BranchShape& shape, const MeshResolution& resolution) {
  CylinderMesh cylinder;
  cylinder.radius = shape.foot_radius;
  cylinder.height = shape.length;
  cylinder.resolution = resolution;
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, BuildMesh(cylinder));
  struct Stub {
    double place;  // along the branch, as a share
    double angle;  // rad
  };
  constexpr Stub kStubs[] = {{0.62, 0.4}, {0.36, 2.7}};
  // Narrower than a few cells they would fold it too.
  const double width = std::max(0.75 * shape.foot_radius, 3 * resolution.cell_size);
  for (Vec3& p : mesh.rest_positions) {
    const double along = p[2] / shape.length;
    double scale = 1 + (shape.tip_radius / shape.foot_radius - 1) * along;
    const double bark = scale * shape.foot_radius;
    const double angle = std::atan2(p[1], p[0]);
    // Stubs grow from the bark: at the axis, where all angles meet, they would fold the mesh.
    const double out = std::hypot(p[0], p[1]) / shape.foot_radius;
    const double height = shape.stub_height / shape.foot_radius * out * out;
    for (const Stub& stub : kStubs) {
      const double around = std::remainder(angle - stub.angle, 2 * std::numbers::pi) * bark;
      const double away = (along - stub.place) * shape.length;
      const double reach = std::hypot(around, away) / width;
      scale += height * (1 - SmoothStep(0.3, 1, reach));
    }
    p[0] *= scale;
    p[1] *= scale;
  }
  return mesh;
}

absl::StatusOr<TetMesh> Column(const MeshResolution& resolution) {
  CylinderMesh cylinder;
  cylinder.radius = 0.1;
  cylinder.height = 1;
  cylinder.resolution = resolution;
  CLEAVE_ASSIGN_OR_RETURN(TetMesh mesh, BuildMesh(cylinder));
  for (Vec3& p : mesh.rest_positions) {
    const double foot = 1 - SmoothStep(0.08, 0.16, p[2]);
    const double head = SmoothStep(0.84, 0.92, p[2]);
    const double scale = 1 + 0.4 * foot + 0.3 * head;
    p[0] *= scale;
    p[1] *= scale;
  }
  return mesh;
}

absl::StatusOr<TetMesh> Capsules(std::span<const Capsule> capsules,
                                 const MeshResolution& resolution) {
  BoxMesh box;
  box.resolution = resolution;
  Vec3 low = capsules[0].from, high = low;
  for (const Capsule& capsule : capsules) {
    for (const Vec3& end : {capsule.from, capsule.to}) {
      for (size_t axis = 0; axis < 3; ++axis) {
        const double room = capsule.radius + resolution.cell_size;
        low[axis] = std::min(low[axis], end[axis] - room);
        high[axis] = std::max(high[axis], end[axis] + room);
      }
    }
  }
  box.origin = low;
  for (size_t axis = 0; axis < 3; ++axis) box.size[axis] = high[axis] - low[axis];
  return CutFromBox(box, [&](const Vec3& p) {
    SurfaceSide nearest{std::numeric_limits<double>::infinity(), {}};
    for (const Capsule& capsule : capsules) {
      Vec3 along, off;
      double dot = 0, squared = 0;
      for (size_t axis = 0; axis < 3; ++axis) {
        along[axis] = capsule.to[axis] - capsule.from[axis];
        dot += along[axis] * (p[axis] - capsule.from[axis]);
        squared += along[axis] * along[axis];
      }
      const double share = squared > 0 ? std::clamp(dot / squared, 0.0, 1.0) : 0;
      for (size_t axis = 0; axis < 3; ++axis)
        off[axis] = p[axis] - capsule.from[axis] - share * along[axis];
      const double length = std::hypot(off[0], off[1], off[2]);
      if (length - capsule.radius >= nearest.distance) continue;
      nearest.distance = length - capsule.radius;
      for (size_t axis = 0; axis < 3; ++axis)
        nearest.normal[axis] = length > 0 ? off[axis] / length : 0;
    }
    return nearest;
  });
}

}  // namespace cleave
