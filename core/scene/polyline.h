#ifndef CLEAVE_CORE_SCENE_POLYLINE_H_
#define CLEAVE_CORE_SCENE_POLYLINE_H_

#include <vector>

#include "core/base/vec3.h"

namespace cleave {

struct Polyline {
  std::vector<Vec3> points;  // m
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_POLYLINE_H_
