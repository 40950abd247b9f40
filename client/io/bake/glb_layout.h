#ifndef CLEAVE_CLIENT_IO_BAKE_GLB_LAYOUT_H_
#define CLEAVE_CLIENT_IO_BAKE_GLB_LAYOUT_H_

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "client/io/bake/bake_codec.h"

namespace cleave {

inline constexpr uint64_t kGlbVectorBytes = 12;

// What is drawn in one material: vertices of its own, as a range of all of them.
struct GlbPrimitive {
  size_t material = 0;  // of SurfaceMaterials
  size_t first_vertex = 0;
  size_t vertices = 0;
  size_t first_index = 0;
  std::vector<uint32_t> indices;  // from the first vertex
};

// Where everything lies in the binary data of a GLB: indices, rest positions, texture, pieces, then
// for each frame displacements and velocities, then times and weights.
class GlbLayout {
 public:
  // `context` must outlive this object.
  explicit GlbLayout(const BakeContext& context);

  const std::vector<GlbPrimitive>& primitives() const { return primitives_; }
  // A vertex is a point as one material shows it from one direction of texture: the point and the
  // axis of its texture.
  const std::vector<std::pair<size_t, size_t>>& vertices() const { return vertices_; }

  // Bytes from the beginning of the data.
  uint64_t RestOffset() const { return 4 * index_count_; }
  uint64_t UvOffset() const { return RestOffset() + kGlbVectorBytes * vertices_.size(); }
  uint64_t PieceOffset() const { return UvOffset() + 8 * vertices_.size(); }
  uint64_t TargetOffset() const { return PieceOffset() + 4 * vertices_.size(); }
  uint64_t TimeOffset() const { return TargetOffset() + frames() * target_bytes(); }
  uint64_t bytes() const { return TimeOffset() + 4 * frames() + 4 * frames() * frames(); }
  uint64_t target_bytes() const {  // of a frame
    return vertices_.size() * (context_.velocities ? 2 : 1) * kGlbVectorBytes;
  }
  uint64_t frames() const { return static_cast<uint64_t>(context_.timing.count); }

 private:
  const BakeContext& context_;
  std::vector<GlbPrimitive> primitives_;
  std::vector<std::pair<size_t, size_t>> vertices_;
  size_t index_count_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_BAKE_GLB_LAYOUT_H_
