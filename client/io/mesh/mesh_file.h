#ifndef CLEAVE_CLIENT_IO_MESH_MESH_FILE_H_
#define CLEAVE_CLIENT_IO_MESH_MESH_FILE_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Reads a tetrahedral mesh from a file: Gmsh 2.2 and 4.1. The format is told by the content, by the
// name's ending only where the content leaves it open; a Zstandard-compressed file of any of them
// is read as it is. Positions are as in the file: the scene's unit_scale has not been applied.
//
// Element ids are positions among the file's tets, node ids positions among its nodes. The mesh is
// what the file says and has not been checked: CheckAndOrientMesh follows.
//
// Errors name the path, the line or byte, and what was expected; surfaces, higher-order and
// non-tetrahedral elements are refused with the way out.
absl::StatusOr<TetMesh> ReadMeshFile(const std::string& path);

// The same for the bytes of a file that was called `name`; not for TetGen, which is two files.
absl::StatusOr<TetMesh> ParseMeshFile(absl::string_view bytes, absl::string_view name);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_MESH_FILE_H_
