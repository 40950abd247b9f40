#ifndef CLEAVE_CORE_DAMAGE_COMPONENTS_H_
#define CLEAVE_CORE_DAMAGE_COMPONENTS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/incidence.h"

namespace cleave {

// Labels the connected components of a mesh's nodes through its unbroken edges: graph components,
// which the orphan and hinge rules make the same as mechanical and visible pieces. Labels count
// from 0 in the order of each component's smallest node; a node of no tet has label -1.
// `broken[edge]` is nonzero for a broken edge. `labels` is resized to a node each. Returns the
// number of components. Linear in the mesh up to the inverse Ackermann function.
int32_t LabelComponents(const Incidence& incidence, std::span<const uint8_t> broken,
                        std::vector<int32_t>& labels);

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_COMPONENTS_H_
