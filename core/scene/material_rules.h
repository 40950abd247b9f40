#ifndef CLEAVE_CORE_SCENE_MATERIAL_RULES_H_
#define CLEAVE_CORE_SCENE_MATERIAL_RULES_H_

#include <string>

#include "core/base/faults.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/checker.h"
#include "core/scene/scene.h"

namespace cleave {

// What a material must be, wherever one stands: `field` is its path in faults.
void CheckMaterial(const std::string& field, const Material& material, Faults& faults,
                   Checker& check);

// The rules of ValidateScene for `scene.materials`.
void CheckMaterials(const Scene& scene, Faults& faults, Checker& check);

// The rules of ValidateSceneWithMesh for arrays of fibre directions.
void CheckFibreArrays(const Scene& scene, const TetMesh& mesh, Faults& faults);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_MATERIAL_RULES_H_
