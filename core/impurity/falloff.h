#ifndef CLEAVE_CORE_IMPURITY_FALLOFF_H_
#define CLEAVE_CORE_IMPURITY_FALLOFF_H_

#include "core/scene/impurities.h"

namespace cleave {

// The share of a node at a distance (m, >= 0) outside of a source: 1 at 0, 0 from layer.falloff on.
inline double ShareAt(double distance, const ImpurityLayer& layer) {
  if (distance <= 0) return 1;
  if (!(distance < layer.falloff)) return 0;
  const double t = 1 - distance / layer.falloff;
  return layer.falloff_shape == FalloffShape::kSmooth ? t * t * (3 - 2 * t) : t;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_IMPURITY_FALLOFF_H_
