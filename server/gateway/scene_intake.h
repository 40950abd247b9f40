#ifndef CLEAVE_SERVER_GATEWAY_SCENE_INTAKE_H_
#define CLEAVE_SERVER_GATEWAY_SCENE_INTAKE_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "cleave/v1/scene.pb.h"
#include "cleave/v1/session.pb.h"
#include "core/base/faults.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"
#include "server/gateway/asset_store.h"

namespace cleave {

// A scene that can be simulated, as a session keeps it.
struct AcceptedScene {
  v1::Scene scene;                    // its mesh is an asset of the store
  std::vector<std::string> warnings;  // "field: what"
  v1::Plan plan;
};

// A scene and its mesh (m, oriented), both of them held to every rule.
struct CheckedScene {
  Scene scene;
  TetMesh mesh;
  std::vector<std::string> warnings;  // "field: what"
};

// Errors: as AcceptScene, which does this and more.
absl::StatusOr<CheckedScene> CheckSceneAndMesh(const v1::Scene& message,
                                               const Faults& request_faults, AssetStore& assets);

// Holds a scene to every rule, with its mesh, and plans its model. Procedural meshes are made, and
// stored as assets when `store_mesh`. Takes as long as the mesh is large. Errors: InvalidArgument
// with every fault by field, those of `request_faults` (faults of the rest of the request) and the
// scene's under "scene."; FailedPrecondition (ASSET_MISSING); ResourceExhausted.
absl::StatusOr<AcceptedScene> AcceptScene(const v1::Scene& message, const Faults& request_faults,
                                          AssetStore& assets, bool store_mesh);

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_SCENE_INTAKE_H_
