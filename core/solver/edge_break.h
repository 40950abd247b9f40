#ifndef CLEAVE_CORE_SOLVER_EDGE_BREAK_H_
#define CLEAVE_CORE_SOLVER_EDGE_BREAK_H_

#include <cstdint>

#include "core/base/vec3.h"

namespace cleave {

// An edge that broke.
struct EdgeBreak {
  double time = 0;  // s, at the end of its step
  int32_t edge = 0;
  Vec3 position{0, 0, 0};  // m, its middle when it broke
  // J, elastic: what its tets lost by the break pass, each tet's loss in equal shares to those of
  // its edges that broke in the pass. What a rule took from tets of which no edge broke is shared by
  // all edges of the pass.
  double energy = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_EDGE_BREAK_H_
