#ifndef CLEAVE_CLIENT_IO_SURFACE_SURFACE_FILE_H_
#define CLEAVE_CLIENT_IO_SURFACE_SURFACE_FILE_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/base/vec3.h"

namespace cleave {

// Triangles of a surface, in the unit of its file.
struct SurfaceMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<int32_t, 3>> triangles;  // turning as in the file
  // Texture coordinates of the corners, a triangle each; empty where a part of the file has none.
  std::vector<std::array<std::array<float, 2>, 3>> uvs;
};

// Reads a surface from a .obj, .ply, .stl or .glb file, text or binary; all objects, groups and
// nodes of the file are one surface, as it stands in the file's scene. Polygons become triangles,
// lines and points are passed over, and vertices at the same place become one, as formats repeat
// them where normals or materials change. Coordinates have seven digits: the readers are of single
// precision.
//
// Errors name the path: NotFound, PermissionDenied, or InvalidArgument for another ending, a file
// that cannot be read as what its name says, one without triangles and one with a coordinate that
// is not finite.
absl::StatusOr<SurfaceMesh> ReadSurfaceFile(const std::string& path);

// The same for the bytes of a file that was called `name`.
absl::StatusOr<SurfaceMesh> ParseSurfaceFile(absl::string_view bytes, absl::string_view name);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SURFACE_SURFACE_FILE_H_
