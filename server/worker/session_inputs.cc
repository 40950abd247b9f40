#include "server/worker/session_inputs.h"

#include <utility>
#include <variant>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/base/faults.h"
#include "core/base/sha256.h"
#include "core/base/status.h"
#include "core/mesh/mesh_check.h"
#include "core/scene/validate.h"
#include "proto/convert/mesh.h"
#include "proto/convert/rung.h"
#include "proto/convert/scene.h"
#include "server/files/durable_file.h"
#include "server/session/config.h"

namespace cleave {
namespace {

constexpr int64_t kMaxMeshBytes = int64_t{2} << 30;  // what a message can hold

}  // namespace

absl::StatusOr<SessionInputs> LoadSessionInputs(const SessionPaths& paths) {
  CLEAVE_ASSIGN_OR_RETURN(const worker::v1::SessionConfig config, ReadSessionConfig(paths));
  SessionInputs inputs;
  inputs.threads = config.threads();
  inputs.rung = RungFromMessage(config.rung());
  Faults faults;
  inputs.scene = SceneFromMessage(config.scene(), faults);
  faults.Append("", ValidateScene(inputs.scene));
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
  const auto* asset = std::get_if<MeshAsset>(&inputs.scene.mesh.source);
  if (asset == nullptr) {
    return absl::InvalidArgumentError("scene.mesh: a session directory names its mesh by asset");
  }
  CLEAVE_ASSIGN_OR_RETURN(const std::string path, FindSessionAsset(paths, asset->sha256));
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(path, kMaxMeshBytes));
  inputs.mesh_sha256 = Sha256::Of(bytes);
  if (absl::BytesToHexString(inputs.mesh_sha256) != asset->sha256) {
    return absl::DataLossError(absl::StrCat(path, " is damaged: its SHA-256 is not its name"));
  }
  CLEAVE_ASSIGN_OR_RETURN(inputs.mesh, ParseMesh(bytes));
  ScaleMesh(inputs.scene.mesh.unit_scale, inputs.mesh);
  CLEAVE_RETURN_IF_ERROR(CheckAndOrientMesh(inputs.mesh).ToStatus());
  CLEAVE_RETURN_IF_ERROR(ValidateSceneWithMesh(inputs.scene, inputs.mesh).ToStatus());
  return inputs;
}

}  // namespace cleave
