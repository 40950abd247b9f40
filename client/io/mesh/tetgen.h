#ifndef CLEAVE_CLIENT_IO_MESH_TETGEN_H_
#define CLEAVE_CLIENT_IO_MESH_TETGEN_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Reads what TetGen writes, a .node and an .ele file, numbered from 0 or 1. The first attribute of
// a tet is its region.
absl::StatusOr<TetMesh> ParseTetGen(absl::string_view node_bytes, absl::string_view ele_bytes);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_TETGEN_H_
