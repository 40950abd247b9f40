#include "client/cli/session_start.h"

#include <algorithm>
#include <filesystem>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/progress.h"
#include "client/cpp/mesh_transfer.h"
#include "core/base/status.h"
#include "core/base/stopwatch.h"

namespace cleave {

absl::StatusOr<v1::Scene> SceneForServer(Client& client, const SceneInput& input, bool quiet) {
  v1::Scene scene = input.file.scene;
  const Stopwatch watch;
  double shown = 1;  // seconds: what is over sooner needs no words
  const auto telling = [&](const char* what) {
    return [&, what](int64_t done, int64_t total) {
      if (quiet || watch.Seconds() < shown) return;
      shown = watch.Seconds() + 2;
      PrintNote(absl::StrCat("uploading the ", what, ": ", FormatBytes(static_cast<double>(done)),
                             " of ", FormatBytes(static_cast<double>(total))));
    };
  };
  if (input.mesh.has_value()) {
    CLEAVE_ASSIGN_OR_RETURN(const UploadedMesh mesh,
                            UploadMesh(client, *input.mesh, telling("mesh")));
    scene.mutable_mesh()->set_asset(mesh.asset);
  }
  if (input.render_mesh.has_value()) {
    CLEAVE_ASSIGN_OR_RETURN(const UploadedMesh mesh,
                            UploadRenderMesh(client, *input.render_mesh, telling("render mesh")));
    scene.mutable_render_mesh()->set_asset(mesh.asset);
  }
  return scene;
}

std::string NewSessionId(absl::string_view scene_path) {
  constexpr size_t kMaxStem = 40;
  std::string stem = std::filesystem::path(std::string(scene_path)).filename().string();
  stem.resize(std::min(stem.find('.'), stem.size()));
  std::string id;
  for (const char letter : stem) {
    const auto byte = static_cast<unsigned char>(letter);
    if (absl::ascii_isalnum(byte))
      id.push_back(absl::ascii_tolower(byte));
    else if (!id.empty() && id.back() != '-')
      id.push_back('-');
  }
  if (id.empty() || !absl::ascii_islower(static_cast<unsigned char>(id[0]))) id.insert(0, "scene-");
  if (id.size() > kMaxStem) id.resize(kMaxStem);
  while (id.back() == '-') id.pop_back();
  return absl::StrCat(id, "-", NewRequestId().substr(0, 6));
}

}  // namespace cleave
