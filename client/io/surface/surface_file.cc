#include "client/io/surface/surface_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <cmath>
#include <map>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/io/mesh/file_bytes.h"
#include "core/base/status.h"

namespace cleave {
namespace {

// Their reader takes sizes of 32 bits, and a collider's surface has 200 000 triangles at most.
constexpr size_t kMaxSurfaceFileBytes = size_t{256} << 20;

absl::string_view EndingOf(absl::string_view name) {
  if (absl::EndsWithIgnoreCase(name, ".zst")) name.remove_suffix(4);
  for (const absl::string_view ending : {"obj", "ply", "stl", "glb"}) {
    if (absl::EndsWithIgnoreCase(name, absl::StrCat(".", ending))) return ending;
  }
  return "";
}

// Joins what stands at the same place exactly: a tolerance would close the gaps of small bodies.
class Welder {
 public:
  explicit Welder(SurfaceMesh& surface) : surface_(surface) {}

  int32_t VertexAt(const aiVector3D& place) {
    // Zero has two signs.
    const Vec3 position{place.x + 0.0, place.y + 0.0, place.z + 0.0};
    const auto [found, added] =
        vertices_.emplace(position, static_cast<int32_t>(surface_.vertices.size()));
    if (added) surface_.vertices.push_back(position);
    return found->second;
  }

 private:
  SurfaceMesh& surface_;
  std::map<Vec3, int32_t> vertices_;
};

bool IsFinite(const aiVector3D& place) {
  return std::isfinite(place.x) && std::isfinite(place.y) && std::isfinite(place.z);
}

}  // namespace

absl::StatusOr<SurfaceMesh> ParseSurfaceFile(absl::string_view bytes, absl::string_view name) {
  const absl::string_view ending = EndingOf(name);
  if (ending.empty()) {
    return absl::InvalidArgumentError(
        "is not a surface that can be read; .obj, .ply, .stl and .glb are");
  }
  if (bytes.empty()) return absl::InvalidArgumentError("is empty");
  if (bytes.size() > kMaxSurfaceFileBytes) {
    return absl::InvalidArgumentError(
        absl::StrCat("is larger than ", kMaxSurfaceFileBytes >> 20, " MiB"));
  }
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE,
                              aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene = importer.ReadFileFromMemory(
      bytes.data(), bytes.size(),
      aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_PreTransformVertices,
      std::string(ending).c_str());
  if (scene == nullptr) {
    return absl::InvalidArgumentError(absl::StrCat(
        "cannot be read as ", absl::AsciiStrToUpper(ending), ": ", importer.GetErrorString()));
  }
  SurfaceMesh surface;
  Welder welder(surface);
  bool has_uvs = true;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& mesh = *scene->mMeshes[m];
    has_uvs = has_uvs && mesh.HasTextureCoords(0);
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;
      std::array<int32_t, 3> triangle;
      for (unsigned k = 0; k < 3; ++k) {
        const aiVector3D& place = mesh.mVertices[face.mIndices[k]];
        if (!IsFinite(place)) {
          return absl::InvalidArgumentError("has a coordinate that is not a finite number");
        }
        triangle[k] = welder.VertexAt(place);
      }
      surface.triangles.push_back(triangle);
      if (!has_uvs) continue;
      auto& uvs = surface.uvs.emplace_back();
      for (unsigned k = 0; k < 3; ++k) {
        const aiVector3D& uv = mesh.mTextureCoords[0][face.mIndices[k]];
        if (!IsFinite(uv))
          return absl::InvalidArgumentError("has a texture coordinate that is not a finite number");
        uvs[k] = {uv.x, uv.y};
      }
    }
  }
  if (surface.triangles.empty()) return absl::InvalidArgumentError("has no triangle");
  if (!has_uvs) surface.uvs.clear();
  return surface;
}

absl::StatusOr<SurfaceMesh> ReadSurfaceFile(const std::string& path) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
  auto surface = ParseSurfaceFile(bytes, path);
  if (surface.ok()) return surface;
  return absl::InvalidArgumentError(absl::StrCat(path, ": ", surface.status().message()));
}

}  // namespace cleave
