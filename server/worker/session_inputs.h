#ifndef CLEAVE_SERVER_WORKER_SESSION_INPUTS_H_
#define CLEAVE_SERVER_WORKER_SESSION_INPUTS_H_

#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"
#include "core/stream/rungs.h"
#include "server/session/session_paths.h"

namespace cleave {

// What a session directory says to simulate.
struct SessionInputs {
  Scene scene;
  TetMesh mesh;              // in metres, checked and oriented
  std::string mesh_sha256;   // 32 raw bytes
  int threads = 0;           // 0: not said
  std::optional<Rung> rung;  // what its frames are kept at, where scene.output does not say
};

// Reads the config and the mesh asset, and holds both to every rule again: a directory may come
// from anywhere. Errors: NotFound, DataLoss, InvalidArgument with every fault by field.
absl::StatusOr<SessionInputs> LoadSessionInputs(const SessionPaths& paths);

}  // namespace cleave

#endif  // CLEAVE_SERVER_WORKER_SESSION_INPUTS_H_
