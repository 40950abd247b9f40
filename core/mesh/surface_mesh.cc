#include "core/mesh/surface_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "core/base/faults.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/mesh/body_centred_lattice.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/mesh_limits.h"
#include "core/mesh/procedural.h"
#include "core/mesh/reorder.h"
#include "core/mesh/surface_distance.h"
#include "core/mesh/tet_clip.h"
#include "core/mesh/tet_geometry.h"
#include "core/mesh/tet_improver.h"
#include "core/mesh/winding_number.h"

namespace cleave {
namespace {

using Triangles = std::vector<std::array<int32_t, 3>>;

constexpr double kMaxJitter = 0.4;
constexpr double kDustVolume = 0.01;  // of the body
constexpr double kSharp = 0.7;        // cosine between triangles at an edge that is to be kept
// Cells that a node goes to where it should lie, and the sine of dihedral angles that must be left.
constexpr double kSurfaceReach = 0.3;
constexpr double kEdgeReach = 0.45;
constexpr double kSnapSine = 0.2;
constexpr double kWantedSine = 0.45;
constexpr int kImprovingPasses = 12;

Eigen::Vector3d ToEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

absl::Status CheckInput(const std::vector<Vec3>& vertices, const Triangles& triangles,
                        const MeshResolution& resolution) {
  Faults faults;
  const double cell = resolution.cell_size;
  if (!(cell > 0 && cell <= limits::kMaxLength)) {
    faults.Error("cell_size", absl::StrCat(cell, " is outside (0, ", limits::kMaxLength, "] m"));
  }
  if (!(resolution.jitter >= 0 && resolution.jitter <= kMaxJitter)) {
    faults.Error("jitter", absl::StrCat(resolution.jitter, " is outside [0, ", kMaxJitter, "]"));
  }
  if (triangles.empty()) faults.Error("triangles", "is empty");
  for (size_t k = 0; k < vertices.size(); ++k) {
    for (const double coordinate : vertices[k]) {
      if (std::abs(coordinate) <= limits::kMaxLength) continue;
      faults.Error(absl::StrCat("vertices[", k, "]"),
                   absl::StrCat(coordinate, " is not a number within ", limits::kMaxLength, " m"));
    }
  }
  for (size_t k = 0; k < triangles.size(); ++k) {
    for (const int32_t vertex : triangles[k]) {
      if (vertex >= 0 && static_cast<size_t>(vertex) < vertices.size()) continue;
      faults.Error(absl::StrCat("triangles[", k, "]"),
                   absl::StrCat("names vertex ", vertex, " of ", vertices.size()));
    }
  }
  return faults.ToStatus();
}

double VolumeInside(const std::vector<Vec3>& vertices, const Triangles& triangles,
                    const Eigen::Vector3d& middle) {
  double volume = 0;
  for (const auto& triangle : triangles) {
    std::array<Eigen::Vector3d, 3> corners;
    for (size_t i = 0; i < 3; ++i)
      corners[i] = ToEigen(vertices[static_cast<size_t>(triangle[i])]) - middle;
    volume += corners[0].dot(corners[1].cross(corners[2])) / 6;
  }
  return volume;
}

// Directed sides of triangles that stand alone, and the sharp edges between two.
struct Edges {
  int64_t open = 0;
  Eigen::Vector3d middle_of_open = Eigen::Vector3d::Zero();
  Triangles sharp;  // as triangles without area
};

Edges FindEdges(const std::vector<Vec3>& vertices, const Triangles& triangles) {
  std::map<std::pair<int32_t, int32_t>, std::vector<size_t>> sides;
  std::vector<Eigen::Vector3d> normals;
  for (size_t k = 0; k < triangles.size(); ++k) {
    std::array<Eigen::Vector3d, 3> at;
    for (size_t i = 0; i < 3; ++i) at[i] = ToEigen(vertices[static_cast<size_t>(triangles[k][i])]);
    normals.push_back((at[1] - at[0]).cross(at[2] - at[0]).normalized());
    for (size_t i = 0; i < 3; ++i) sides[{triangles[k][i], triangles[k][(i + 1) % 3]}].push_back(k);
  }
  Edges edges;
  for (const auto& [ends, uses] : sides) {
    const auto other = sides.find({ends.second, ends.first});
    const size_t others = other == sides.end() ? 0 : other->second.size();
    if (uses.size() > others) {
      edges.open += static_cast<int64_t>(uses.size() - others);
      edges.middle_of_open += static_cast<double>(uses.size() - others) / 2 *
                              (ToEigen(vertices[static_cast<size_t>(ends.first)]) +
                               ToEigen(vertices[static_cast<size_t>(ends.second)]));
    }
    if (ends.first > ends.second || uses.size() != 1 || others != 1) continue;
    if (normals[uses[0]].dot(normals[other->second[0]]) < kSharp)
      edges.sharp.push_back({ends.first, ends.second, ends.second});
  }
  if (edges.open > 0) edges.middle_of_open /= static_cast<double>(edges.open);
  return edges;
}

absl::StatusOr<TetMesh> CellsOver(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                                  const MeshResolution& resolution) {
  const Eigen::Vector3d rim = Eigen::Vector3d::Constant(1.5 * resolution.cell_size);
  const Eigen::Vector3d size = high - low + 2 * rim;
  // Tets of an edge's length fill 0.1 of its cube.
  const double tets = 10 * (size / resolution.cell_size).prod();
  if (tets > static_cast<double>(limits::kMaxTets)) {
    return absl::InvalidArgumentError(absl::StrCat(
        "cell_size: ", resolution.cell_size, " m makes about ", std::floor(tets),
        " tets of the box round the surface; at most ", limits::kMaxTets, " are allowed"));
  }
  if (resolution.layout == MeshLayout::kJitteredLattice)
    return BodyCentredLattice(low - rim, high + rim, resolution);
  BoxMesh box;
  for (int axis = 0; axis < 3; ++axis) {
    box.origin[static_cast<size_t>(axis)] = low[axis] - rim[axis];
    box.size[static_cast<size_t>(axis)] = size[axis];
  }
  box.resolution = resolution;
  return BuildMesh(box);
}

// Keeps the tets of parts that have more than a hundredth of the volume. Returns how many went.
int64_t DropDust(TetMesh& mesh) {
  std::vector<int32_t> parent(mesh.rest_positions.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&parent](int32_t node) {
    while (parent[static_cast<size_t>(node)] != node) {
      int32_t& up = parent[static_cast<size_t>(node)];
      up = parent[static_cast<size_t>(up)];
      node = up;
    }
    return node;
  };
  for (const auto& tet : mesh.tets) {
    for (size_t k = 1; k < 4; ++k) parent[static_cast<size_t>(root(tet[k]))] = root(tet[0]);
  }
  std::map<int32_t, double> volumes;
  double whole = 0;
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const double volume = SignedVolume(CornersOf(mesh, tet));
    volumes[root(mesh.tets[static_cast<size_t>(tet)][0])] += volume;
    whole += volume;
  }
  std::erase_if(mesh.tets,
                [&](const auto& tet) { return volumes[root(tet[0])] < kDustVolume * whole; });
  return std::count_if(volumes.begin(), volumes.end(),
                       [&](const auto& part) { return part.second < kDustVolume * whole; });
}

// The smallest sine of a dihedral angle round a node, -1 where a tet is turned over.
double WorstSine(const TetMesh& mesh, std::span<const int32_t> tets) {
  double worst = 1;
  for (const int32_t tet : tets) {
    const TetCorners corners = CornersOf(mesh, tet);
    const auto [least, most] = DihedralRange(corners);
    const double sine = std::min(std::sin(least), std::sin(most));
    worst = std::min(worst, SignedVolume(corners) > 0 ? sine : -1);
  }
  return worst;
}

// Moves nodes of the body's surface onto triangles, which may be lines, within `reach`, the nearest
// first, where the tets round them bear it.
void DrawOnto(const std::vector<Vec3>& vertices, const Triangles& triangles, double reach,
              const Incidence& incidence, ClippedTets& body) {
  if (triangles.empty()) return;
  const SurfaceDistance surface(vertices, triangles);
  struct Pull {
    double distance = 0;
    size_t node = 0;
    Vec3 to{0, 0, 0};
  };
  std::vector<Pull> all(body.on_surface.size());
  ParallelFor(static_cast<int64_t>(all.size()), 64, [&](int64_t begin, int64_t end) {
    for (int64_t n = begin; n < end; ++n) {
      Pull& pull = all[static_cast<size_t>(n)];
      pull.node = static_cast<size_t>(n);
      if (body.on_surface[pull.node] == 0) continue;
      const SurfacePoint near = surface.ClosestPoint(ToEigen(body.mesh.rest_positions[pull.node]));
      pull.distance = near.distance;
      for (size_t i = 0; i < 3; ++i) {
        const int32_t vertex = triangles[static_cast<size_t>(near.triangle)][i];
        for (size_t axis = 0; axis < 3; ++axis)
          pull.to[axis] += near.weights[i] * vertices[static_cast<size_t>(vertex)][axis];
      }
    }
  });
  std::erase_if(all, [reach](const Pull& pull) {
    return pull.distance <= 1e-9 * reach || pull.distance > reach;
  });
  std::sort(all.begin(), all.end(), [](const Pull& a, const Pull& b) {
    return std::pair(a.distance, a.node) < std::pair(b.distance, b.node);
  });
  std::set<Vec3> taken;  // two nodes at a corner would be a gap
  for (const Pull& pull : all) {
    if (taken.count(pull.to) > 0) continue;
    const std::span<const int32_t> tets = incidence.node_tets[static_cast<int64_t>(pull.node)];
    Vec3& place = body.mesh.rest_positions[pull.node];
    const Vec3 from = place;
    const double before = WorstSine(body.mesh, tets);
    place = pull.to;
    if (WorstSine(body.mesh, tets) < std::min(before, kSnapSine)) {
      place = from;
    } else {
      taken.insert(pull.to);
    }
  }
}

absl::Status CheckVolume(const SurfaceBody& body, double cell_size) {
  double volume = 0;
  for (int64_t tet = 0; tet < body.mesh.tet_count(); ++tet)
    volume += SignedVolume(CornersOf(body.mesh, tet));
  const double share = volume / body.surface_volume;
  if (body.open_edges > 0 || (share > 0.5 && share < 1.5)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrCat("cell_size: ", cell_size, " m gives a body of ", volume,
                   " m^3 where the surface "
                   "encloses ",
                   body.surface_volume, " m^3; smaller cells are needed"));
}

}  // namespace

absl::StatusOr<SurfaceBody> MeshSurface(const std::vector<Vec3>& vertices,
                                        const std::vector<std::array<int32_t, 3>>& triangles,
                                        const MeshResolution& resolution) {
  CLEAVE_RETURN_IF_ERROR(CheckInput(vertices, triangles, resolution));
  Eigen::Vector3d low = ToEigen(vertices[static_cast<size_t>(triangles[0][0])]), high = low;
  for (const auto& triangle : triangles) {
    for (const int32_t vertex : triangle) {
      low = low.cwiseMin(ToEigen(vertices[static_cast<size_t>(vertex)]));
      high = high.cwiseMax(ToEigen(vertices[static_cast<size_t>(vertex)]));
    }
  }
  SurfaceBody body;
  const Edges edges = FindEdges(vertices, triangles);
  body.open_edges = edges.open;
  // Seen from the middle of a hole, a fan over it encloses nothing.
  body.surface_volume =
      VolumeInside(vertices, triangles,
                   edges.open > 0 ? edges.middle_of_open : Eigen::Vector3d(0.5 * (low + high)));
  const double turn = body.surface_volume < 0 ? -1 : 1;
  body.surface_volume *= turn;
  CLEAVE_ASSIGN_OR_RETURN(const TetMesh cells, CellsOver(low, high, resolution));
  const WindingNumber winding(vertices, triangles);
  ClippedTets clipped = ClipTets(cells, [&winding, turn](const Eigen::Vector3d& point) {
    return turn * winding.At(point) > 0.5;
  });
  if (clipped.mesh.tets.empty()) {
    return absl::InvalidArgumentError(absl::StrCat(
        "the surface encloses nothing at a cell_size of ", resolution.cell_size,
        " m: it is thinner than that, wide open, or its triangles do not turn one way"));
  }
  body.dropped_parts = DropDust(clipped.mesh);
  const Incidence incidence = BuildIncidence(clipped.mesh);
  DrawOnto(vertices, triangles, kSurfaceReach * resolution.cell_size, incidence, clipped);
  DrawOnto(vertices, edges.sharp, kEdgeReach * resolution.cell_size, incidence, clipped);
  PlacedPoints points;
  points.positions = clipped.mesh.rest_positions;
  for (const uint8_t on_surface : clipped.on_surface)
    points.bindings.push_back({static_cast<uint8_t>(on_surface != 0 ? 7 : 0), 0});
  TetImprover improver(std::move(points), clipped.mesh.tets);
  improver.Improve(kWantedSine, kImprovingPasses);
  body.mesh = improver.Take();
  const Faults faults = CheckAndOrientMesh(body.mesh);
  if (!faults.ok()) return faults.ToStatus();
  body.mesh = Reordered(body.mesh, LocalityOrder(body.mesh));
  CLEAVE_RETURN_IF_ERROR(CheckVolume(body, resolution.cell_size));
  return body;
}

}  // namespace cleave
