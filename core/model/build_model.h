#ifndef CLEAVE_CORE_MODEL_BUILD_MODEL_H_
#define CLEAVE_CORE_MODEL_BUILD_MODEL_H_

#include "absl/status/statusor.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/model.h"
#include "core/scene/scene.h"

namespace cleave {

// Makes the parts that `scene` asks for on `mesh`, in the client's numbering, metres. Reading this
// function is reading what Cleave can do. Preconditions: as Simulation::Create. Errors:
// InvalidArgument where a precondition is found broken.
absl::StatusOr<Model> BuildModel(const Scene& scene, const TetMesh& mesh);

// At rest with the scene's initial velocities.
State InitialState(const Scene& scene, const TetMesh& mesh, const Model& model);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_BUILD_MODEL_H_
