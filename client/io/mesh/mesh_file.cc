#include "client/io/mesh/mesh_file.h"

#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/io/mesh/file_bytes.h"
#include "client/io/mesh/gmsh.h"
#include "client/io/mesh/medit.h"
#include "client/io/mesh/tetgen.h"
#include "client/io/mesh/vega.h"
#include "client/io/mesh/vtk_legacy.h"
#include "client/io/mesh/vtu.h"
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

// Whether the first thing after blank lines and # comments is `word`, in any case.
bool FirstWordIs(absl::string_view bytes, absl::string_view word) {
  while (true) {
    bytes = absl::StripLeadingAsciiWhitespace(bytes);
    if (!absl::StartsWith(bytes, "#")) return absl::StartsWithIgnoreCase(bytes, word);
    const size_t end = bytes.find('\n');
    if (end == absl::string_view::npos) return false;
    bytes.remove_prefix(end);
  }
}

absl::StatusOr<TetMesh> Parse(absl::string_view bytes, absl::string_view name) {
  if (bytes.empty()) return absl::InvalidArgumentError("the file is empty");
  const std::string ending = EndingOf(name);
  const absl::string_view start = absl::StripLeadingAsciiWhitespace(bytes.substr(0, 65536));
  if (absl::StartsWith(start, "$MeshFormat")) return ParseGmsh(bytes);
  if (absl::StartsWith(start, "# vtk DataFile")) return ParseVtkLegacy(bytes);
  if (absl::StartsWith(start, "<?xml") || absl::StartsWith(start, "<VTKFile"))
    return ParseVtu(bytes);
  if (FirstWordIs(start, "MeshVersionFormatted")) return ParseMeditText(bytes);
  if (FirstWordIs(start, "*VERTICES")) return ParseVega(bytes);
  if (IsMeditBinary(bytes)) return ParseMeditBinary(bytes);
  if (IsSurface(start, ending)) {
    return absl::InvalidArgumentError(
        "the file holds a surface, and only the inside of a body can break: fill it with "
        "tetrahedra "
        "first, for example with Gmsh, TetGen or fTetWild, and give the resulting .msh file");
  }
  if (absl::StartsWith(start, "MFEM"))
    return absl::InvalidArgumentError("MFEM meshes cannot be read; save as VTK");
  if (ending == ".node" || ending == ".ele") {
    return absl::InvalidArgumentError(
        "a TetGen mesh is a .node and an .ele file side by side; give the path of either");
  }
  // Nothing in the content tells; the reader that the name asks for says what it misses.
  if (ending == ".msh") return ParseGmsh(bytes);
  if (ending == ".vtk") return ParseVtkLegacy(bytes);
  if (ending == ".vtu") return ParseVtu(bytes);
  if (ending == ".mesh") return ParseMeditText(bytes);
  if (ending == ".meshb") return ParseMeditBinary(bytes);
  if (ending == ".veg") return ParseVega(bytes);
  return absl::InvalidArgumentError(
      "the format is not known; meshes can be Gmsh (.msh), VTK (.vtu, .vtk), TetGen (.node and "
      ".ele), Medit (.mesh, .meshb) or Vega (.veg)");
}

absl::StatusOr<TetMesh> WithName(absl::string_view name, absl::StatusOr<TetMesh> mesh) {
  if (mesh.ok()) return mesh;
  return absl::Status(mesh.status().code(), absl::StrCat(name, ": ", mesh.status().message()));
}

// Reads the .node and .ele files of which `path` names one, compressed or not.
absl::StatusOr<TetMesh> ReadTetGenFiles(const std::string& path, const std::string& ending) {
  const std::string stem = path.substr(0, absl::AsciiStrToLower(path).rfind(ending));
  const auto read = [&](absl::string_view wanted) -> absl::StatusOr<std::string> {
    if (wanted == ending) return ReadFileBytes(path);
    absl::StatusOr<std::string> bytes = ReadFileBytes(absl::StrCat(stem, wanted));
    if (bytes.ok() || !absl::IsNotFound(bytes.status())) return bytes;
    absl::StatusOr<std::string> packed = ReadFileBytes(absl::StrCat(stem, wanted, ".zst"));
    return absl::IsNotFound(packed.status()) ? std::move(bytes) : std::move(packed);
  };
  CLEAVE_ASSIGN_OR_RETURN(const std::string nodes, read(".node"));
  CLEAVE_ASSIGN_OR_RETURN(const std::string tets, read(".ele"));
  return WithName(path, ParseTetGen(nodes, tets));
}

}  // namespace

absl::StatusOr<TetMesh> ParseMeshFile(absl::string_view bytes, absl::string_view name) {
  return WithName(name, Parse(bytes, name));
}

absl::StatusOr<TetMesh> ReadMeshFile(const std::string& path) {
  const std::string ending = EndingOf(path);
  if (ending == ".node" || ending == ".ele") return ReadTetGenFiles(path, ending);
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
  return ParseMeshFile(bytes, path);
}

}  // namespace cleave
