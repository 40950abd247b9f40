#ifndef CLEAVE_CLIENT_IO_MESH_VEGA_H_
#define CLEAVE_CLIENT_IO_MESH_VEGA_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Reads a Vega FEM mesh (.veg). Each *REGION line makes the set that it names a region of that
// name, numbered from 1 in their order; later ones win where sets overlap. Materials are passed
// over: they are the scene's.
absl::StatusOr<TetMesh> ParseVega(absl::string_view bytes);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_VEGA_H_
