#ifndef CLEAVE_CORE_SCENE_IMPURITY_BLADES_H_
#define CLEAVE_CORE_SCENE_IMPURITY_BLADES_H_

#include <vector>

#include "core/mesh/blades.h"
#include "core/scene/impurities.h"

namespace cleave {

// What strokes and patterns cut with, and which of their curves every segment is of. A curve of n
// points has n - 1 segments. Preconditions: CheckImpurities finds no error in the layer, and an
// image has become curves.
struct CurveBlades {
  BladeSet blades;
  std::vector<int32_t> curve_of;
};
CurveBlades BladesOf(const Strokes& strokes);
CurveBlades BladesOf(const SegmentPattern& pattern);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_IMPURITY_BLADES_H_
