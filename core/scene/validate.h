#ifndef CLEAVE_CORE_SCENE_VALIDATE_H_
#define CLEAVE_CORE_SCENE_VALIDATE_H_

#include <vector>

#include "core/base/faults.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// Every rule that a scene can be held to without its mesh: ranges, names, references. Fields are
// named as in the scene file. Never stops at the first fault.
Faults ValidateScene(const Scene& scene);

// The rules that need the mesh, for a scene that passed ValidateScene and a mesh that passed
// CheckAndOrientMesh, in metres: regions that materials and selectors name exist, every tet has a
// material, node sets are not empty, ids are in range, prescribed axes do not collide, loads on
// surfaces find faces, sets that a release waits to see apart share no node.
Faults ValidateSceneWithMesh(const Scene& scene, const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_VALIDATE_H_
