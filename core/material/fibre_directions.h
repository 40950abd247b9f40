#ifndef CLEAVE_CORE_MATERIAL_FIBRE_DIRECTIONS_H_
#define CLEAVE_CORE_MATERIAL_FIBRE_DIRECTIONS_H_

#include <cstdint>
#include <optional>
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

// The unit direction of fibres at a point at rest, m; nullopt for a direction that no point
// decides: none, or one a tet. Precondition: the direction passed validation.
std::optional<Vec3> FibreDirectionAt(const FibreDirection& direction, const Vec3& point);

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_FIBRE_DIRECTIONS_H_
