#include "tests/scenes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/status.h"
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

}  // namespace cleave
