#include "core/impurity/surface_paint.h"

#include <Eigen/Core>
#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"
#include "core/impurity/falloff.h"
#include "core/impurity/texture.h"
#include "core/mesh/boundary_faces.h"
#include "core/mesh/surface_distance.h"

namespace cleave {
namespace {

double VertexShareOf(const std::vector<double>& shares, const std::array<int32_t, 3>& vertices,
                     const std::array<double, 3>& weights) {
  double share = 0;
  for (size_t i = 0; i < 3; ++i) share += weights[i] * shares[static_cast<size_t>(vertices[i])];
  return share;
}

double TextureShareOf(const SurfaceTexture& texture, size_t triangle,
                      const std::array<double, 3>& weights) {
  double u = 0, v = 0;
  for (size_t i = 0; i < 3; ++i) {
    u += weights[i] * static_cast<double>(texture.uvs[triangle][2 * i]);
    v += weights[i] * static_cast<double>(texture.uvs[triangle][2 * i + 1]);
  }
  return TextureShare(texture, u, v);
}

}  // namespace

std::vector<double> PaintShares(const SurfacePaint& paint, const ImpurityLayer& layer,
                                const TetMesh& mesh) {
  std::vector<std::array<int32_t, 3>> triangles = paint.triangles;
  if (paint.vertices.empty()) {
    std::vector<int32_t> nodes(mesh.rest_positions.size());
    std::iota(nodes.begin(), nodes.end(), 0);
    for (const BoundaryFace& face : FindBoundaryFaces(mesh, nodes)) triangles.push_back(face.nodes);
  }
  const SurfaceDistance surface(paint.vertices.empty() ? mesh.rest_positions : paint.vertices,
                                triangles);
  std::vector<double> shares(mesh.rest_positions.size());
  ParallelFor(mesh.node_count(), 64, [&](int64_t begin, int64_t end) {
    for (int64_t n = begin; n < end; ++n) {
      const auto node = static_cast<size_t>(n);
      const SurfacePoint closest =
          surface.ClosestPoint(Eigen::Vector3d(mesh.rest_positions[node].data()));
      const auto triangle = static_cast<size_t>(closest.triangle);
      const double share = paint.texture
                               ? TextureShareOf(*paint.texture, triangle, closest.weights)
                               : VertexShareOf(paint.shares, triangles[triangle], closest.weights);
      shares[node] = share * ShareAt(closest.distance - paint.depth, layer);
    }
  });
  return shares;
}

std::vector<int32_t> PaintingTriangles(const SurfacePaint& paint, const ImpurityLayer& layer,
                                       const TetMesh& mesh) {
  const SurfaceDistance surface(paint.vertices, paint.triangles);
  std::vector<int32_t> closest(mesh.rest_positions.size());
  ParallelFor(mesh.node_count(), 64, [&](int64_t begin, int64_t end) {
    for (int64_t n = begin; n < end; ++n) {
      const auto node = static_cast<size_t>(n);
      const SurfacePoint point =
          surface.ClosestPoint(Eigen::Vector3d(mesh.rest_positions[node].data()));
      closest[node] = ShareAt(point.distance - paint.depth, layer) > 0 ? point.triangle : -1;
    }
  });
  std::sort(closest.begin(), closest.end());
  closest.erase(std::unique(closest.begin(), closest.end()), closest.end());
  if (!closest.empty() && closest.front() < 0) closest.erase(closest.begin());
  return closest;
}

}  // namespace cleave
