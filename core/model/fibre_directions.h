#ifndef CLEAVE_CORE_MODEL_FIBRE_DIRECTIONS_H_
#define CLEAVE_CORE_MODEL_FIBRE_DIRECTIONS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// The unit direction of fibres at the centroids of the named tets of `mesh`, which is in the
// client's order, a tet each. Preconditions: the direction passed validation with this mesh.
std::vector<Vec3> FibreDirections(const FibreDirection& direction, const TetMesh& mesh,
                                  std::span<const int32_t> tets);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_FIBRE_DIRECTIONS_H_
