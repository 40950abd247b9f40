#ifndef CLEAVE_CLIENT_IO_MESH_VTU_H_
#define CLEAVE_CLIENT_IO_MESH_VTU_H_

#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Reads a VTK XML file of an UnstructuredGrid (.vtu): ASCII, inline Base64, appended raw or Base64,
// plain or zlib-compressed, of either byte order. Pieces are put one after the other. The first
// cell array with a name as in IsRegionArray gives the regions.
absl::StatusOr<TetMesh> ParseVtu(absl::string_view bytes);

// The values of an array of one component over the points of such a file; an empty name stands for
// the only one. Errors: those of ParseVtu's file, and where the array is missing the names of those
// that there are.
absl::StatusOr<std::vector<double>> ParseVtuPointArray(absl::string_view bytes,
                                                       const std::string& name);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_VTU_H_
