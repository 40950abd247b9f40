#ifndef CLEAVE_CORE_SCENE_LOAD_RULES_H_
#define CLEAVE_CORE_SCENE_LOAD_RULES_H_

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/base/faults.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/checker.h"
#include "core/scene/scene.h"

namespace cleave {

// The rules of ValidateScene for `scene.loads` and for the releases of loads and motions. `names`
// are those of the node sets.
void CheckLoads(const Scene& scene, const std::set<std::string>& names, Faults& faults,
                Checker& check);

// The rules of ValidateSceneWithMesh for the same. `nodes_of` has the nodes of every node set.
void CheckLoadedNodes(const Scene& scene, const TetMesh& mesh,
                      const std::map<std::string, std::vector<int32_t>>& nodes_of, Faults& faults);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_LOAD_RULES_H_
