#ifndef CLEAVE_PROTO_CONVERT_MESH_H_
#define CLEAVE_PROTO_CONVERT_MESH_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// The bytes of an ASSET_KIND_TET_MESH asset: a serialised v1::TetMesh, the same bytes for the same
// mesh. Errors: InvalidArgument above the 2 GiB that a message can hold.
absl::StatusOr<std::string> SerializeMesh(const TetMesh& mesh);

// The mesh that such bytes hold. Node ids beyond 31 bits and lists of wrong length are refused
// (InvalidArgument); everything else about the mesh is for CheckAndOrientMesh to judge.
absl::StatusOr<TetMesh> ParseMesh(absl::string_view bytes);

// The bytes of an ASSET_KIND_RENDER_MESH asset: a serialised v1::RenderMesh. Errors: as of
// SerializeMesh.
absl::StatusOr<std::string> SerializeRenderMesh(const RenderMesh& mesh);

// The render mesh that such bytes hold. Point ids beyond 31 bits and lists of wrong length are
// refused (InvalidArgument); everything else about it is for CheckRenderMesh to judge.
absl::StatusOr<RenderMesh> ParseRenderMesh(absl::string_view bytes);

// Multiplies rest positions by `unit_scale`, metres a unit.
void ScaleMesh(double unit_scale, TetMesh& mesh);
void ScaleMesh(double unit_scale, RenderMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_PROTO_CONVERT_MESH_H_
