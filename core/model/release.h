#ifndef CLEAVE_CORE_MODEL_RELEASE_H_
#define CLEAVE_CORE_MODEL_RELEASE_H_

#include <cstdint>
#include <vector>

#include "core/scene/scene.h"

namespace cleave {

// A Release with its node sets looked up.
struct ReleaseRule {
  Release when;
  std::vector<std::vector<int32_t>> separated;  // the solver's ids of each named set
};

// What fracture has come to, as far as releases ask.
struct FractureProgress {
  double broken_share = 0;           // of all edges, without those cut before the first step
  int64_t pieces = 0;                // components of nodes, lone ones not counted
  std::vector<int32_t> node_pieces;  // a component's label a node; -1 for a node of no tet
};

// Whether `rule` ends what it belongs to at `time` (s).
bool IsDue(const ReleaseRule& rule, double time, const FractureProgress& progress);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_RELEASE_H_
