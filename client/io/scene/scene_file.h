#ifndef CLEAVE_CLIENT_IO_SCENE_SCENE_FILE_H_
#define CLEAVE_CLIENT_IO_SCENE_SCENE_FILE_H_

#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cleave/v1/scene.pb.h"
#include "core/base/faults.h"

namespace cleave {

// Where in a file that a person wrote everything stands.
struct FileLines {
  std::string path;                  // as given; names the file in messages
  std::map<std::string, int> lines;  // line, from 1, by field path: materials[2].poisson_ratio

  // The line of a field, or of the nearest enclosing one that the file holds; 0 if there is none.
  int LineOf(absl::string_view field) const;
  // "path:line: field: description", one a line: how a fault of the file is shown.
  std::string Describe(const std::vector<Fault>& faults) const;
};

struct SceneFile : FileLines {
  cleave::v1::Scene scene;
};

// One material, as in a scene's list of materials.
struct MaterialFile : FileLines {
  cleave::v1::Material material;
};

enum class SceneFormat {
  kJson,  // protobuf JSON: fields by their proto or lowerCamelCase names; no comments
  kText,  // protobuf text format; # begins a comment
};

// A scene travels in one message of at most 4 MiB; four times that is room for any indentation.
inline constexpr size_t kMaxSceneFileBytes = 16 << 20;

// Reads a scene file; its name decides the format: .json, or .textproto, .txtpb, .pbtxt.
// Errors: NotFound or PermissionDenied for the file, InvalidArgument whose message lists every
// unknown field, wrong type and unknown name as "path:line: what", one a line. Ranges and
// references are ValidateScene's to judge.
absl::StatusOr<SceneFile> ReadSceneFile(const std::string& path);

// The same for text in memory; `path` is for messages only.
absl::StatusOr<SceneFile> ParseScene(absl::string_view text, SceneFormat format,
                                     const std::string& path);

// Reads a material file, under the same rules.
absl::StatusOr<MaterialFile> ReadMaterialFile(const std::string& path);

// Where a path that a file names lies: relative ones count from the file's folder.
std::string PathBeside(const FileLines& file, const std::string& path);

// Where the scene's mesh.file lies, by PathBeside. Empty when the scene names no file.
std::string MeshPath(const SceneFile& file);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SCENE_SCENE_FILE_H_
