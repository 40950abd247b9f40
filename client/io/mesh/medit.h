#ifndef CLEAVE_CLIENT_IO_MESH_MEDIT_H_
#define CLEAVE_CLIENT_IO_MESH_MEDIT_H_

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Read Medit (GMF) meshes, text and binary of versions 1 to 4. A tet's reference is its region;
// other volume elements are refused, everything else is passed over.
absl::StatusOr<TetMesh> ParseMeditText(absl::string_view bytes);
absl::StatusOr<TetMesh> ParseMeditBinary(absl::string_view bytes);

// Whether the bytes start as a binary Medit mesh does.
bool IsMeditBinary(absl::string_view bytes);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_MEDIT_H_
