#include "client/cli/run_folder.h"

#include <google/protobuf/text_format.h>
#include <google/protobuf/util/message_differencer.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "client/io/scene/scene_file.h"
#include "client/io/series/write_aside.h"
#include "core/base/status.h"
#include "proto/convert/mesh.h"

namespace cleave {

RunFolder RunFolder::Of(const std::string& run) {
  std::error_code error;
  if (std::filesystem::is_directory(run, error)) return RunFolder(run);
  const std::string folder = std::filesystem::path(run).parent_path().string();
  return RunFolder(folder.empty() ? "." : folder);
}

absl::Status RunFolder::Make() const { return MakeDirectories(path_); }

std::optional<std::string> RunFolder::EarlierSession() const {
  std::ifstream in(session());
  std::string name;
  if (!std::getline(in, name) || name.empty()) return std::nullopt;
  return name;
}

absl::Status RunFolder::CheckSameScene(const v1::Scene& wanted) const {
  using google::protobuf::util::MessageDifferencer;
  const auto earlier = ReadSceneFile(scene());
  if (earlier.ok() && MessageDifferencer::Equals(earlier->scene, wanted)) return absl::OkStatus();
  bool only_output = false;
  if (earlier.ok()) {
    v1::Scene as_kept = wanted;
    *as_kept.mutable_output() = earlier->scene.output();
    v1::Scene kept = earlier->scene;
    kept.mutable_output();
    only_output = MessageDifferencer::Equals(kept, as_kept);
  }
  return absl::FailedPreconditionError(
      absl::StrCat(path_, ": holds a run of ",
                   only_output ? "this scene with another output or --tolerance" : "another scene",
                   "; choose another --out, or pass --fresh to throw that run away"));
}

absl::Status RunFolder::WriteScene(const v1::Scene& sent) const {
  std::string text;
  if (!google::protobuf::TextFormat::PrintToString(sent, &text))
    return absl::InternalError("the scene could not be written as text");
  return WriteAside(scene(), text);
}

absl::Status RunFolder::Begin(const std::string& name, const v1::Scene& sent) const {
  CLEAVE_RETURN_IF_ERROR(WriteScene(sent));
  return WriteAside(session(), absl::StrCat(name, "\n"));
}

absl::Status RunFolder::WriteMesh(const TetMesh& body) const {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, SerializeMesh(body));
  return WriteAside(mesh(), bytes);
}

absl::Status RunFolder::WriteRenderMesh(const RenderMesh& shown) const {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, SerializeRenderMesh(shown));
  return WriteAside(render_mesh(), bytes);
}

absl::Status RunFolder::Clear() const {
  for (const std::string& item :
       {session(), scene(), frames(), mesh(), render_mesh(), reports(), events(), server_data()}) {
    std::error_code error;
    std::filesystem::remove_all(item, error);
    if (error) return absl::InternalError(absl::StrCat(item, ": ", error.message()));
  }
  return absl::OkStatus();
}

}  // namespace cleave
