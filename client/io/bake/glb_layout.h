#ifndef CLEAVE_CLIENT_IO_BAKE_GLB_LAYOUT_H_
#define CLEAVE_CLIENT_IO_BAKE_GLB_LAYOUT_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "client/io/bake/bake_codec.h"
#include "client/io/bake/normal_groups.h"

namespace cleave {

inline constexpr uint64_t kGlbVectorBytes = 12;

// A point as one material shows it at one place of its texture, smooth with some triangles.
struct GlbVertex {
  size_t point = 0;
  size_t normal = 0;          // of NormalGroups
  std::array<float, 2> uv{};  // v upward
};

// What is drawn in one material: vertices of its own, as a range of all of them.
struct GlbPrimitive {
  size_t material = 0;  // of SurfaceMaterials
  size_t first_vertex = 0;
  size_t vertices = 0;
  size_t first_index = 0;
  std::vector<uint32_t> indices;  // from the first vertex
};

// Where everything lies in the binary data of a GLB: indices, rest positions, normals, texture,
// pieces, then for each frame displacements, turns of normals and velocities, then times and
// weights.
class GlbLayout {
 public:
  // `context` must outlive this object.
  explicit GlbLayout(const BakeContext& context);

  const std::vector<GlbPrimitive>& primitives() const { return primitives_; }
  const std::vector<GlbVertex>& vertices() const { return vertices_; }

  // Bytes from the beginning of the data.
  uint64_t RestOffset() const { return 4 * index_count_; }
  uint64_t NormalOffset() const { return RestOffset() + vector_bytes(); }
  uint64_t UvOffset() const { return NormalOffset() + vector_bytes(); }
  uint64_t PieceOffset() const { return UvOffset() + 8 * vertices_.size(); }
  uint64_t TargetOffset() const { return PieceOffset() + 4 * vertices_.size(); }
  uint64_t TimeOffset() const { return TargetOffset() + frames() * target_bytes(); }
  uint64_t bytes() const { return TimeOffset() + 4 * frames() + 4 * frames() * frames(); }
  uint64_t target_bytes() const {  // of a frame
    return vectors_each() * vector_bytes();
  }
  uint64_t vectors_each() const { return context_.velocities ? 3 : 2; }  // of a frame and vertex
  uint64_t vector_bytes() const { return kGlbVectorBytes * vertices_.size(); }
  const NormalGroups& normals() const { return normals_; }
  uint64_t frames() const { return static_cast<uint64_t>(context_.timing.count); }

 private:
  const BakeContext& context_;
  const NormalGroups normals_;
  std::vector<GlbPrimitive> primitives_;
  std::vector<GlbVertex> vertices_;
  size_t index_count_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_BAKE_GLB_LAYOUT_H_
