#include "client/io/bake/glb_layout.h"

#include <map>
#include <tuple>
#include <utility>

namespace cleave {

GlbLayout::GlbLayout(const BakeContext& context)
    : context_(context), normals_(context.surface.topology) {
  const SurfaceTopology& topology = context.surface.topology;
  std::map<size_t, std::vector<size_t>> by_material;
  for (size_t i = 0; i < topology.triangles.size(); ++i) {
    by_material[context.materials.IndexOf(context.surface.triangle_regions[i],
                                          topology.inside[i] != 0)]
        .push_back(i);
  }
  for (const auto& [material, triangles] : by_material) {
    GlbPrimitive primitive{material, vertices_.size(), 0, index_count_, {}};
    std::map<std::tuple<size_t, size_t, float, float>, uint32_t> places;
    for (const size_t triangle : triangles) {
      for (size_t k = 0; k < 3; ++k) {
        const auto point = static_cast<size_t>(topology.triangles[triangle][k]);
        const auto normal = static_cast<size_t>(normals_.group(triangle, k));
        const auto [u, v] = context.surface.UvAt(triangle, k);
        const auto [place, is_new] =
            places.try_emplace({point, normal, u, v}, static_cast<uint32_t>(places.size()));
        if (is_new) vertices_.push_back({point, normal, {u, v}});
        primitive.indices.push_back(place->second);
      }
    }
    primitive.vertices = places.size();
    index_count_ += primitive.indices.size();
    primitives_.push_back(std::move(primitive));
  }
}

}  // namespace cleave
