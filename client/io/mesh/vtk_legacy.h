#ifndef CLEAVE_CLIENT_IO_MESH_VTK_LEGACY_H_
#define CLEAVE_CLIENT_IO_MESH_VTK_LEGACY_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Reads an UNSTRUCTURED_GRID of a legacy VTK file, ASCII or binary, with the cell lists of version
// 2 to 4 or the offsets of version 5. The first cell array with a name as in IsRegionArray gives
// the regions; other attributes are passed over, and reading ends at the first that is not known.
absl::StatusOr<TetMesh> ParseVtkLegacy(absl::string_view bytes);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_VTK_LEGACY_H_
