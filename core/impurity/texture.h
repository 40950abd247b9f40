#ifndef CLEAVE_CORE_IMPURITY_TEXTURE_H_
#define CLEAVE_CORE_IMPURITY_TEXTURE_H_

#include "core/scene/impurities.h"

namespace cleave {

// The share of a texture at (u, v), linear between the middles of the four texels round it.
// Preconditions: CheckImpurities finds no error; u and v within limits::kMaxTextureCoordinate.
double TextureShare(const SurfaceTexture& texture, double u, double v);

}  // namespace cleave

#endif  // CLEAVE_CORE_IMPURITY_TEXTURE_H_
