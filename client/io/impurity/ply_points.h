#ifndef CLEAVE_CLIENT_IO_IMPURITY_PLY_POINTS_H_
#define CLEAVE_CLIENT_IO_IMPURITY_PLY_POINTS_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/base/vec3.h"

namespace cleave {

// The vertices of a PLY file with one of their properties, and its faces.
struct PlyPoints {
  std::vector<Vec3> vertices;  // in the unit of the file
  // A vertex each; of properties of type uchar, such as colours, the 255th part.
  std::vector<double> values;
  std::vector<std::array<int32_t, 3>> triangles;  // faces, cut into fans; may be none
};

// Reads a PLY file, text or binary of either byte order. `property` names the values; empty: the
// only property beside x, y, z and normals, or "red" where there are colours. Errors:
// InvalidArgument, which says where and lists the properties where the wanted one is missing.
absl::StatusOr<PlyPoints> ParsePlyPoints(absl::string_view bytes, const std::string& property);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_IMPURITY_PLY_POINTS_H_
