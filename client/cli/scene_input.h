#ifndef CLEAVE_CLIENT_CLI_SCENE_INPUT_H_
#define CLEAVE_CLIENT_CLI_SCENE_INPUT_H_

#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cleave/v1/scene.pb.h"
#include "client/io/scene/scene_file.h"
#include "core/base/faults.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// A scene file, its mesh file where it names one, and what the local checks say of them.
struct SceneInput {
  SceneFile file;
  Scene scene;
  std::optional<TetMesh> mesh;            // as in the mesh file: not scaled, not oriented
  std::optional<RenderMesh> render_mesh;  // as in its file: not scaled
  std::vector<Fault> warnings;
};

// Reads and checks a scene and its mesh file: all that can be known without a server. Errors:
// every fault of the scene with its line, every fault of the mesh with its file, one a line.
absl::StatusOr<SceneInput> LoadScene(const std::string& path);

// The same with further layers on the scene's impurities. `path` may also be a mesh file: then the
// scene is a body of it, `unit_scale` metres a unit, with a tensile strength of 1 Pa. Files of
// layers lie beside `path`.
absl::StatusOr<SceneInput> LoadSceneWithLayers(const std::string& path, double unit_scale,
                                               const std::vector<v1::ImpurityLayer>& layers);

// The mesh (m, oriented) of a scene: its file's, or built where it is procedural.
// FailedPrecondition when it is an asset, which only a server has.
absl::StatusOr<TetMesh> SceneMesh(const SceneInput& input);

// What is wrong with the scene and its render mesh for this body (m, oriented).
Faults CheckWithBody(const SceneInput& input, const TetMesh& mesh);

// A mesh for `cleave inspect` and exporters: a mesh file, a scene file (its mesh, in metres) or the
// mesh.pb of a run. Not checked. `unit_scale` is for the first; InvalidArgument for another than 1
// with those that say it themselves.
absl::StatusOr<TetMesh> ReadAnyMesh(const std::string& path, double unit_scale);

// The status of a call about this scene: fields of the scene with their lines in its file, others
// as the options that say them.
absl::Status WithLines(const SceneFile& file, const absl::Status& status);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_SCENE_INPUT_H_
