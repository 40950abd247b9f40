#ifndef CLEAVE_CORE_STREAM_STENCIL_WEIGHTS_H_
#define CLEAVE_CORE_STREAM_STENCIL_WEIGHTS_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/int4.h"

namespace cleave {

inline constexpr size_t kStencilNodes = 8;
inline constexpr int kStencilBits = 15;
inline constexpr int32_t kStencilOne = 1 << kStencilBits;  // weights of a stencil add up to this

// What surrounds four places, a lane each.
struct StencilBatch {
  Int32x4 counts{};  // neighbours of each: 1 to kStencilNodes; 0 in lanes that are not used
  // Of each neighbour in turn, nearest first, x, y, z from its place (m); 0 where there is none.
  std::array<std::array<Double4, 3>, kStencilNodes> offsets{};
};

// Of each neighbour in turn the weights that reproduce affine maps of the rest positions as well as
// the neighbours allow; FORMAT.md, "Weights".
std::array<Int32x4, kStencilNodes> StencilWeights(const StencilBatch& batch);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_STENCIL_WEIGHTS_H_
