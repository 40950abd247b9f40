#ifndef CLEAVE_CLIENT_CLI_MESH_TEXT_H_
#define CLEAVE_CLIENT_CLI_MESH_TEXT_H_

#include <string>
#include <vector>

#include "client/cli/json_line.h"
#include "client/io/export/vtu.h"
#include "core/base/faults.h"
#include "core/mesh/quality.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// What a person reads of a mesh, a line each without the last line's end.
std::string MeshReportText(const MeshReport& report);

// The same as JSON, to which more may be added.
JsonLine MeshReportJson(const MeshReport& report, const std::vector<Fault>& warnings);

// The tets of a mesh, with their regions where it has any.
VtuGrid TetGrid(const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_MESH_TEXT_H_
