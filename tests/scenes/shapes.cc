#include "tests/scenes/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/status.h"
#include "core/mesh/procedural.h"

namespace cleave {
namespace {

double SmoothStep(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

}  // namespace

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
  const double width = 0.75 * shape.foot_radius;
  for (Vec3& p : mesh.rest_positions) {
    const double along = p[2] / shape.length;
    double scale = 1 + (shape.tip_radius / shape.foot_radius - 1) * along;
    const double bark = scale * shape.foot_radius;
    const double angle = std::atan2(p[1], p[0]);
    for (const Stub& stub : kStubs) {
      const double around = std::remainder(angle - stub.angle, 2 * std::numbers::pi) * bark;
      const double away = (along - stub.place) * shape.length;
      const double reach = std::hypot(around, away) / width;
      scale += shape.stub_height / shape.foot_radius * (1 - SmoothStep(0.3, 1, reach));
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
