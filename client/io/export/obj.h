#ifndef CLEAVE_CLIENT_IO_EXPORT_OBJ_H_
#define CLEAVE_CLIENT_IO_EXPORT_OBJ_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "client/io/export/surface_materials.h"
#include "core/base/vec3.h"
#include "core/picture/shown_surface.h"

namespace cleave {

struct ObjOptions {
  std::string comment;        // stands in the first line
  std::string object;         // the name after "o"
  std::string material_file;  // the name after "mtllib"
  bool normals = true;        // of corners, as CornerNormals has them
};

// The bytes of a Wavefront OBJ file: every point in its place as a `v` line (float precision, the
// scene's axes, m), then faces by piece and material: "g piece_3", "usemtl inside_7". Texture
// coordinates are the surface's own on outer faces, where it has any, else RestUv of the rest
// points, which must be known. Precondition: `materials` knows
// the surface's regions. Errors: InvalidArgument for what CheckShownSurface refuses, and for no
// triangles. Source: Wavefront, "Object files (.obj)", version 3.0.
absl::StatusOr<std::string> EncodeObj(const ShownSurface& surface,
                                      const SurfaceMaterials& materials, const ObjOptions& options);

// The material file that goes with it: a diffuse colour each.
std::string EncodeMtl(const SurfaceMaterials& materials);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_EXPORT_OBJ_H_
