#ifndef CLEAVE_CORE_MESH_UNSTRUCTURED_H_
#define CLEAVE_CORE_MESH_UNSTRUCTURED_H_

#include "absl/status/statusor.h"
#include "core/mesh/body.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// The unstructured mesh of a body, as procedural.h describes it. A body thinner than a cell (two
// for a disc) along an axis or across its wall is meshed stretched to that and pressed back.
// Preconditions: those that CheckShape holds a shape to. Internal when no sound mesh was found,
// which no shape is known to cause.
absl::StatusOr<TetMesh> UnstructuredMesh(const Body& body, const MeshResolution& resolution);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_UNSTRUCTURED_H_
