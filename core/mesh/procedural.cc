#include "core/mesh/procedural.h"

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/mesh/body.h"
#include "core/mesh/lattice.h"
#include "core/mesh/mesh_limits.h"
#include "core/mesh/unstructured.h"

namespace cleave {
namespace {

// A cell over this many times longer than it is thick costs accuracy that no tier buys back.
constexpr double kMaxCellRatio = 10;
constexpr double kMaxJitter = 0.4;

bool CheckLength(absl::string_view field, double value, Faults& faults) {
  // From here on cells are longer than limits::kMinEdgeLength too.
  constexpr double kMinLength = 1e-9;
  if (value >= kMinLength && value <= limits::kMaxLength) return true;
  faults.Error(field,
               absl::StrCat(value, " m is outside [", kMinLength, ", ", limits::kMaxLength, "] m"));
  return false;
}

void CheckOrigin(const Vec3& origin, Faults& faults) {
  constexpr double kMost = limits::kMaxLength / 2;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (std::abs(origin[axis]) <= kMost) continue;
    faults.Error(absl::StrCat("origin[", axis, "]"),
                 absl::StrCat(origin[axis], " m is outside [-", kMost, ", ", kMost, "] m"));
  }
}

bool CheckResolution(const MeshResolution& resolution, Faults& faults) {
  if (!(resolution.jitter >= 0 && resolution.jitter <= kMaxJitter)) {
    faults.Error("resolution.jitter",
                 absl::StrCat(resolution.jitter, " is outside [0, ", kMaxJitter, "]"));
  }
  return CheckLength("resolution.cell_size", resolution.cell_size, faults);
}

// Largest cell size that a length or radius of the shape allows.
struct CellBound {
  double largest;
  absl::string_view reason;
};

double EstimateTets(const Body& body, const MeshResolution& resolution);

void CheckCells(const Body& body, const MeshResolution& resolution,
                std::initializer_list<CellBound> bounds, Faults& faults) {
  const CellBound& tightest = *std::min_element(
      bounds.begin(), bounds.end(),
      [](const CellBound& a, const CellBound& b) { return a.largest < b.largest; });
  if (resolution.cell_size > tightest.largest) {
    faults.Error("resolution.cell_size",
                 absl::StrCat(resolution.cell_size, " m is too coarse: at most ", tightest.largest,
                              " m, ", tightest.reason));
    return;
  }
  const double tets = EstimateTets(body, resolution);
  if (!(tets <= static_cast<double>(limits::kMaxTets))) {
    faults.Error("resolution.cell_size",
                 absl::StrCat(resolution.cell_size, " m asks for about ", tets, " tets; at most ",
                              limits::kMaxTets, " can be held"));
  }
}

double EstimateTets(const Body& body, const MeshResolution& resolution) {
  const double h = resolution.cell_size;
  const auto cells = [&](double length, double fewest) {
    return std::max(fewest, std::round(length / h));
  };
  const double layers = cells(body.size[2], body.min_layers);
  if (resolution.layout == MeshLayout::kUnstructured) {
    // What the improved Delaunay meshes of all shapes come to, within a fifth.
    constexpr double kTetsPerCell = 9;
    if (!body.round) {
      return kTetsPerCell * std::max(1.0, body.size[0] / h) * std::max(1.0, body.size[1] / h) *
             std::max(1.0, body.size[2] / h);
    }
    const double wall = body.outer_radius - body.inner_radius;
    return kTetsPerCell * VolumeOf(body) / (h * h * h) *
           std::max(1.0, h * body.min_layers / body.size[2]) * std::max(1.0, h / wall);
  }
  if (!body.round) return 6 * cells(body.size[0], 1) * cells(body.size[1], 1) * layers;
  if (body.inner_radius == 0) {
    const double rings = cells(body.outer_radius, 1);
    return 18 * rings * rings * layers;
  }
  const double rings = cells(body.outer_radius - body.inner_radius, 1);
  return 3 * 2 * rings * layers * 3.1416 * (body.outer_radius + body.inner_radius) / h;
}

absl::StatusOr<TetMesh> Build(const Faults& faults, const Body& body, const Vec3& origin,
                              const MeshResolution& resolution) {
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
  TetMesh mesh;
  if (resolution.layout == MeshLayout::kUnstructured) {
    CLEAVE_ASSIGN_OR_RETURN(mesh, UnstructuredMesh(body, resolution));
  } else {
    mesh = body.round ? RingLattice(body, resolution) : BoxLattice(body, resolution);
  }
  for (Vec3& position : mesh.rest_positions) {
    for (size_t axis = 0; axis < 3; ++axis) position[axis] += origin[axis];
  }
  return mesh;
}

}  // namespace

Faults CheckShape(const BoxMesh& shape) {
  Faults faults;
  CheckOrigin(shape.origin, faults);
  bool sound = CheckResolution(shape.resolution, faults);
  for (size_t axis = 0; axis < 3; ++axis)
    sound = CheckLength(absl::StrCat("size[", axis, "]"), shape.size[axis], faults) && sound;
  if (!sound) return faults;
  const double thinnest = *std::min_element(shape.size.begin(), shape.size.end());
  CheckCells(BodyOf(shape), shape.resolution,
             {{kMaxCellRatio * thinnest, "10 times the shortest side"}}, faults);
  return faults;
}

Faults CheckShape(const CylinderMesh& shape) {
  Faults faults;
  CheckOrigin(shape.origin, faults);
  bool sound = CheckResolution(shape.resolution, faults);
  sound = CheckLength("radius", shape.radius, faults) && sound;
  sound = CheckLength("height", shape.height, faults) && sound;
  if (!sound) return faults;
  CheckCells(BodyOf(shape), shape.resolution,
             {{shape.radius, "the radius"}, {kMaxCellRatio * shape.height, "10 times the height"}},
             faults);
  return faults;
}

Faults CheckShape(const TubeMesh& shape) {
  Faults faults;
  CheckOrigin(shape.origin, faults);
  bool sound = CheckResolution(shape.resolution, faults);
  sound = CheckLength("outer_radius", shape.outer_radius, faults) && sound;
  sound = CheckLength("inner_radius", shape.inner_radius, faults) && sound;
  sound = CheckLength("height", shape.height, faults) && sound;
  if (!sound) return faults;
  if (!(shape.inner_radius < shape.outer_radius)) {
    faults.Error("inner_radius", absl::StrCat(shape.inner_radius, " m is not below outer_radius, ",
                                              shape.outer_radius, " m"));
    return faults;
  }
  const double wall = shape.outer_radius - shape.inner_radius;
  // A chord c of the inner circle leaves it by c^2 / (8 radius).
  const double chord = std::sqrt(2 * shape.inner_radius * wall);
  CheckCells(BodyOf(shape), shape.resolution,
             {{shape.inner_radius, "the inner radius"},
              {kMaxCellRatio * wall, "10 times the wall"},
              {chord, "a chord that cuts a quarter into the wall"},
              {kMaxCellRatio * shape.height, "10 times the height"}},
             faults);
  return faults;
}

Faults CheckShape(const DiscMesh& shape) {
  Faults faults;
  CheckOrigin(shape.origin, faults);
  bool sound = CheckResolution(shape.resolution, faults);
  sound = CheckLength("radius", shape.radius, faults) && sound;
  sound = CheckLength("thickness", shape.thickness, faults) && sound;
  if (!sound) return faults;
  CheckCells(
      BodyOf(shape), shape.resolution,
      {{shape.radius, "the radius"},
       {kMaxCellRatio / 2 * shape.thickness, "5 times the thickness, which takes two cells"}},
      faults);
  return faults;
}

double EstimateTets(const BoxMesh& shape) { return EstimateTets(BodyOf(shape), shape.resolution); }
double EstimateTets(const CylinderMesh& shape) {
  return EstimateTets(BodyOf(shape), shape.resolution);
}
double EstimateTets(const TubeMesh& shape) { return EstimateTets(BodyOf(shape), shape.resolution); }
double EstimateTets(const DiscMesh& shape) { return EstimateTets(BodyOf(shape), shape.resolution); }

absl::StatusOr<TetMesh> BuildMesh(const BoxMesh& shape) {
  return Build(CheckShape(shape), BodyOf(shape), shape.origin, shape.resolution);
}
absl::StatusOr<TetMesh> BuildMesh(const CylinderMesh& shape) {
  return Build(CheckShape(shape), BodyOf(shape), shape.origin, shape.resolution);
}
absl::StatusOr<TetMesh> BuildMesh(const TubeMesh& shape) {
  return Build(CheckShape(shape), BodyOf(shape), shape.origin, shape.resolution);
}
absl::StatusOr<TetMesh> BuildMesh(const DiscMesh& shape) {
  return Build(CheckShape(shape), BodyOf(shape), shape.origin, shape.resolution);
}

}  // namespace cleave
