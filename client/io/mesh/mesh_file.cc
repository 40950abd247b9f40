#include "client/io/mesh/mesh_file.h"

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/io/mesh/file_bytes.h"
#include "client/io/mesh/gmsh.h"
#include "core/base/status.h"

namespace cleave {
namespace {

// The name's ending in lower case, without a .zst behind it: ".msh".
std::string EndingOf(absl::string_view name) {
  std::string lower = absl::AsciiStrToLower(name.substr(name.find_last_of('/') + 1));
  if (absl::EndsWith(lower, ".zst")) lower.resize(lower.size() - 4);
  const size_t dot = lower.find_last_of('.');
  return dot == std::string::npos ? "" : lower.substr(dot);
}

bool IsSurface(absl::string_view start, absl::string_view ending) {
  for (const char* surface : {".obj", ".ply", ".stl", ".off", ".glb", ".gltf"}) {
    if (ending == surface) return true;
  }
  return absl::StartsWith(start, "ply\n") || absl::StartsWith(start, "ply\r") ||
         absl::StartsWith(start, "solid ") || absl::StartsWith(start, "OFF");
}

absl::StatusOr<TetMesh> Parse(absl::string_view bytes, absl::string_view name) {
  if (bytes.empty()) return absl::InvalidArgumentError("the file is empty");
  const std::string ending = EndingOf(name);
  const absl::string_view start = absl::StripLeadingAsciiWhitespace(bytes.substr(0, 4096));
  if (absl::StartsWith(start, "$MeshFormat") || absl::StartsWith(start, "$NOD") ||
      ending == ".msh") {
    return ParseGmsh(bytes);
  }
  if (IsSurface(start, ending)) {
    return absl::InvalidArgumentError(
        "the file holds a surface, and only the inside of a body can break: fill it with "
        "tetrahedra "
        "first, for example with Gmsh, TetGen or fTetWild, and give the resulting .msh file");
  }
  return absl::InvalidArgumentError("the format is not known; meshes can be Gmsh (.msh)");
}

}  // namespace

absl::StatusOr<TetMesh> ParseMeshFile(absl::string_view bytes, absl::string_view name) {
  absl::StatusOr<TetMesh> mesh = Parse(bytes, name);
  if (mesh.ok()) return mesh;
  return absl::Status(mesh.status().code(), absl::StrCat(name, ": ", mesh.status().message()));
}

absl::StatusOr<TetMesh> ReadMeshFile(const std::string& path) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
  return ParseMeshFile(bytes, path);
}

}  // namespace cleave
