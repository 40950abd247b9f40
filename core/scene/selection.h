#ifndef CLEAVE_CORE_SCENE_SELECTION_H_
#define CLEAVE_CORE_SCENE_SELECTION_H_

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// Looks regions of a mesh up by name or decimal id. Holds no reference to the mesh.
class RegionIndex {
 public:
  explicit RegionIndex(const TetMesh& mesh);
  // The region id that the text stands for, if the mesh has it. Names win over ids.
  std::optional<int32_t> Find(absl::string_view name_or_id) const;

 private:
  std::map<std::string, int32_t, std::less<>> by_name_;
  std::set<int32_t> ids_;
};

// The nodes of `set` on `mesh` (rest positions in m), ascending, each once. Ids out of range and
// unknown regions choose nothing; ValidateSceneWithMesh reports them.
std::vector<int32_t> SelectNodes(const NodeSet& set, const TetMesh& mesh,
                                 const RegionIndex& regions);

// A material index for every tet of the mesh, -1 where none covers its region.
std::vector<int32_t> AssignMaterials(const std::vector<Material>& materials, const TetMesh& mesh,
                                     const RegionIndex& regions);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_SELECTION_H_
