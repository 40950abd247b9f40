#include "client/io/scene/scene_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/io/scene/parse.h"
#include "client/io/scene/utf8.h"
#include "core/base/status.h"

namespace cleave {
namespace {

absl::StatusOr<SceneFormat> FormatOf(const std::string& path) {
  if (absl::EndsWith(path, ".json")) return SceneFormat::kJson;
  for (const char* ending : {".textproto", ".txtpb", ".pbtxt"})
    if (absl::EndsWith(path, ending)) return SceneFormat::kText;
  return absl::InvalidArgumentError(absl::StrCat(
      path,
      ": a scene file's name ends in .scene.json (protobuf JSON) or .textproto (text format)"));
}

absl::StatusOr<std::string> ReadBounded(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    return absl::InvalidArgumentError(absl::StrCat(path, ": is a folder, not a scene file"));
  errno = 0;
  std::ifstream in(path, std::ios::binary);
  if (!in) {
    const std::string text = absl::StrCat(path, ": ", std::strerror(errno));
    if (errno == ENOENT || errno == ENOTDIR) return absl::NotFoundError(text);
    return absl::PermissionDeniedError(text);
  }
  // One byte more than allowed tells a file that is too large, also where no size is known (pipes).
  std::string text(kMaxSceneFileBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) return absl::DataLossError(absl::StrCat(path, ": could not be read"));
  text.resize(static_cast<size_t>(in.gcount()));
  return text;
}

// Fills `message` and `file` from the text.
absl::Status ParseInto(absl::string_view text, SceneFormat format, const std::string& path,
                       google::protobuf::Message& message, FileLines& file) {
  if (text.size() > kMaxSceneFileBytes)
    return absl::InvalidArgumentError(absl::StrCat(
        path, ": is larger than ", kMaxSceneFileBytes >> 20,
        " MiB; a scene names its mesh (mesh.file), and node sets by box, sphere, plane or region"));
  if (const int line = LineOfInvalidUtf8(text); line > 0)
    return absl::InvalidArgumentError(absl::StrCat(path, ":", line, ": is not UTF-8 text"));
  file.path = path;
  std::vector<SceneFault> faults = format == SceneFormat::kJson
                                       ? ParseJsonMessage(text, message, file.lines)
                                       : ParseTextMessage(text, message, file.lines);
  if (faults.empty()) return absl::OkStatus();
  std::stable_sort(faults.begin(), faults.end(),
                   [](const SceneFault& a, const SceneFault& b) { return a.line < b.line; });
  return absl::InvalidArgumentError(
      absl::StrJoin(faults, "\n", [&path](std::string* out, const SceneFault& fault) {
        absl::StrAppend(out, path, ":", fault.line, ": ", fault.text);
      }));
}

}  // namespace

int FileLines::LineOf(absl::string_view field) const {
  std::string prefix(field);
  while (true) {
    if (const auto found = lines.find(prefix); found != lines.end()) return found->second;
    const size_t cut = prefix.find_last_of(".[");
    if (cut == std::string::npos) return 0;
    prefix.resize(cut);
  }
}

std::string FileLines::Describe(const std::vector<Fault>& faults) const {
  return absl::StrJoin(faults, "\n", [this](std::string* out, const Fault& fault) {
    const int line = LineOf(fault.field);
    absl::StrAppend(out, path, ":", line > 0 ? absl::StrCat(line, ": ") : " ", fault.field, ": ",
                    fault.description);
  });
}

absl::StatusOr<SceneFile> ParseScene(absl::string_view text, SceneFormat format,
                                     const std::string& path) {
  SceneFile file;
  CLEAVE_RETURN_IF_ERROR(ParseInto(text, format, path, file.scene, file));
  return file;
}

absl::StatusOr<SceneFile> ReadSceneFile(const std::string& path) {
  CLEAVE_ASSIGN_OR_RETURN(const SceneFormat format, FormatOf(path));
  CLEAVE_ASSIGN_OR_RETURN(const std::string text, ReadBounded(path));
  return ParseScene(text, format, path);
}

absl::StatusOr<MaterialFile> ReadMaterialFile(const std::string& path) {
  CLEAVE_ASSIGN_OR_RETURN(const SceneFormat format, FormatOf(path));
  CLEAVE_ASSIGN_OR_RETURN(const std::string text, ReadBounded(path));
  MaterialFile file;
  CLEAVE_RETURN_IF_ERROR(ParseInto(text, format, path, file.material, file));
  return file;
}

std::string PathBeside(const FileLines& file, const std::string& path) {
  const std::filesystem::path folder = std::filesystem::path(file.path).parent_path();
  return (folder / path).lexically_normal().string();
}

std::string MeshPath(const SceneFile& file) {
  if (file.scene.mesh().file().empty()) return "";
  return PathBeside(file, file.scene.mesh().file());
}

}  // namespace cleave
