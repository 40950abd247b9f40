#include "client/io/bake/glb_layout.h"

#include <map>

#include "client/io/export/surface_materials.h"

namespace cleave {

GlbLayout::GlbLayout(const BakeContext& context) : context_(context) {
  const SurfaceTopology& topology = context.surface.topology;
  std::map<size_t, std::vector<size_t>> by_material;
  for (size_t i = 0; i < topology.triangles.size(); ++i) {
    by_material[context.materials.IndexOf(context.surface.triangle_regions[i],
                                          topology.inside[i] != 0)]
        .push_back(i);
  }
  for (const auto& [material, triangles] : by_material) {
    GlbPrimitive primitive{material, vertices_.size(), 0, index_count_, {}};
    std::map<std::pair<size_t, size_t>, uint32_t> places;
    for (const size_t triangle : triangles) {
      const auto& [a, b, c] = topology.triangles[triangle];
      const auto rest = [&](int32_t p) { return topology.points[static_cast<size_t>(p)].rest; };
      const size_t axis = FacedAxis(rest(a), rest(b), rest(c));
      for (const int32_t point : topology.triangles[triangle]) {
        const std::pair vertex{static_cast<size_t>(point), axis};
        const auto [place, is_new] =
            places.try_emplace(vertex, static_cast<uint32_t>(places.size()));
        if (is_new) vertices_.push_back(vertex);
        primitive.indices.push_back(place->second);
      }
    }
    primitive.vertices = places.size();
    index_count_ += primitive.indices.size();
    primitives_.push_back(std::move(primitive));
  }
}

}  // namespace cleave
