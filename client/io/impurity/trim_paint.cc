#include "client/io/impurity/trim_paint.h"

#include <cstdint>
#include <utility>
#include <variant>
#include <vector>

#include "core/impurity/surface_paint.h"

namespace cleave {
namespace {

// Keeps those triangles and the vertices that they have.
void Keep(const std::vector<int32_t>& kept, v1::SurfacePaint& paint) {
  v1::SurfacePaint trimmed;
  std::vector<int32_t> renamed(static_cast<size_t>(paint.vertices_size() / 3), -1);
  int32_t vertices = 0;
  for (const int32_t triangle : kept) {
    for (int corner = 0; corner < 3; ++corner) {
      const int32_t vertex = paint.triangles(3 * triangle + corner);
      int32_t& name = renamed[static_cast<size_t>(vertex)];
      if (name < 0) {
        name = vertices++;
        for (int axis = 0; axis < 3; ++axis)
          trimmed.add_vertices(paint.vertices(3 * vertex + axis));
        if (paint.shares_size() > 0) trimmed.add_shares(paint.shares(vertex));
      }
      trimmed.add_triangles(name);
    }
    for (int i = 0; i < 6 && paint.has_texture(); ++i)
      trimmed.mutable_texture()->add_uvs(paint.texture().uvs(6 * triangle + i));
  }
  *paint.mutable_vertices() = std::move(*trimmed.mutable_vertices());
  *paint.mutable_triangles() = std::move(*trimmed.mutable_triangles());
  *paint.mutable_shares() = std::move(*trimmed.mutable_shares());
  if (paint.has_texture())
    *paint.mutable_texture()->mutable_uvs() = std::move(*trimmed.mutable_texture()->mutable_uvs());
}

}  // namespace

void TrimPaint(const Scene& scene, const TetMesh& mesh, v1::Scene& message) {
  if (!scene.impurities) return;
  for (size_t k = 0; k < scene.impurities->layers.size(); ++k) {
    const ImpurityLayer& layer = scene.impurities->layers[k];
    const auto* paint = std::get_if<SurfacePaint>(&layer.source);
    if (paint == nullptr || paint->vertices.empty()) continue;
    const std::vector<int32_t> kept = PaintingTriangles(*paint, layer, mesh);
    // A surface that no node is near to paints nothing: that is for the server to say.
    if (kept.empty()) continue;
    Keep(kept, *message.mutable_impurities()->mutable_layers(static_cast<int>(k))->mutable_paint());
  }
}

}  // namespace cleave
