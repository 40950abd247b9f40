#ifndef CLEAVE_CORE_SCENE_IMPURITY_RULES_H_
#define CLEAVE_CORE_SCENE_IMPURITY_RULES_H_

#include <set>
#include <string>

#include "core/base/faults.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// The rules of ValidateScene for impurities. `names` are those of the node sets.
void CheckImpurities(const Impurities& impurities, const std::set<std::string>& names,
                     Faults& faults);

// The rules of ValidateSceneWithMesh for them: arrays have the mesh's size, and every layer meets
// the body (CheckReach). Preconditions: the scene has impurities; the mesh passed CheckMesh. Layers
// that CheckImpurities refuses are passed over.
void CheckImpuritiesOfMesh(const Scene& scene, const TetMesh& mesh, Faults& faults);

// How a picture is traced: threshold and tolerance. `prefix` stands before their names.
void CheckTracing(const std::string& prefix, const ImageDrawing& image, Faults& faults);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_IMPURITY_RULES_H_
