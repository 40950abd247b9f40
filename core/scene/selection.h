#ifndef CLEAVE_CORE_SCENE_SELECTION_H_
#define CLEAVE_CORE_SCENE_SELECTION_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/strings/string_view.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// The nodes of `set` on `mesh` (rest positions in m), ascending, each once. Ids out of range and
// unknown regions choose nothing; ValidateSceneWithMesh reports them.
std::vector<int32_t> SelectNodes(const NodeSet& set, const TetMesh& mesh);

// The region id that a name or a decimal id stands for, if the mesh has it.
std::optional<int32_t> FindRegion(absl::string_view name_or_id, const TetMesh& mesh);

// A material index for every tet of the mesh, -1 where none covers its region.
std::vector<int32_t> AssignMaterials(const std::vector<Material>& materials, const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_SELECTION_H_
