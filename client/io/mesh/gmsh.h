#ifndef CLEAVE_CLIENT_IO_MESH_GMSH_H_
#define CLEAVE_CLIENT_IO_MESH_GMSH_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Reads a Gmsh mesh, format 2.2 or 4.1, ASCII or binary. Tets are taken, points, lines, triangles
// and quads passed over, other volume elements refused. A tet's region is the first physical group
// of its volume, 0 without one; groups of dimension 3 name the regions. InvalidArgument names the
// line or byte and what was expected there. Time and memory are bounded by the size of `bytes`, not
// by the counts in it.
absl::StatusOr<TetMesh> ParseGmsh(absl::string_view bytes);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_GMSH_H_
