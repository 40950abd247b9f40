#ifndef CLEAVE_CORE_DAMAGE_EDGE_THRESHOLDS_H_
#define CLEAVE_CORE_DAMAGE_EDGE_THRESHOLDS_H_

#include <span>
#include <vector>

#include "core/mesh/incidence.h"

namespace cleave {

// The failure threshold of every edge, Pa, from the tensile strength of every tet, Pa (>= 0;
// infinite: never breaks). An edge takes the smallest strength among its tets: the mean stress of
// an edge on an interface pulls on both sides alike, so the weaker side gives first, and a bond is
// never stronger than what it bonds. So an edge on the interface of a material that never breaks
// has its neighbour's strength, and only edges wholly inside such a material are infinite.
std::vector<double> EdgeThresholds(const Incidence& incidence,
                                   std::span<const double> tet_strengths);

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_EDGE_THRESHOLDS_H_
