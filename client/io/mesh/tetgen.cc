#include "client/io/mesh/tetgen.h"

#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "client/io/mesh/mesh_builder.h"
#include "client/io/mesh/scanner.h"
#include "core/base/status.h"

namespace cleave {
namespace {

void ReadNodes(Scanner& scan, MeshBuilder& builder) {
  const int64_t count = scan.Count("the number of nodes");
  const int64_t dimension = scan.Count("the dimension");
  const int64_t attributes = scan.Count("the number of attributes");
  const int64_t markers = scan.Count("0 or 1 boundary markers");
  if (scan.ok() && dimension != 3)
    scan.Fail(absl::StrCat("the dimension is ", dimension, "; tetrahedra need 3"));
  if (scan.ok() && count == 0) scan.Fail("there are no nodes");
  if (scan.ok() && markers > 1) scan.Fail(absl::StrCat(markers, " boundary markers a node"));
  for (int64_t i = 0; i < count && scan.ok(); ++i) {
    const int64_t number = scan.Integer("the number of a node");
    Vec3 position;
    for (double& coordinate : position) coordinate = scan.Number("a coordinate");
    for (int64_t k = 0; k < attributes && scan.ok(); ++k) scan.Number("an attribute");
    if (markers == 1) scan.Number("a boundary marker");
    if (scan.ok()) builder.AddNode(number, position);
  }
}

absl::Status ReadTets(Scanner& scan, MeshBuilder& builder) {
  const int64_t count = scan.Count("the number of tetrahedra");
  const int64_t corners = scan.Count("the number of nodes of a tetrahedron");
  const int64_t attributes = scan.Count("the number of attributes");
  CLEAVE_RETURN_IF_ERROR(scan.status());
  if (corners != 4)
    return RefuseElement("every element", absl::StrCat(corners, "-node tetrahedron"));
  for (int64_t i = 0; i < count && scan.ok(); ++i) {
    const int64_t number = scan.Integer("the number of a tetrahedron");
    std::array<int64_t, 4> nodes;
    for (int64_t& node : nodes) node = scan.Integer("a node of a tetrahedron");
    double region = 0;
    for (int64_t k = 0; k < attributes && scan.ok(); ++k) {
      const double attribute = scan.Number("an attribute");
      if (k == 0) region = attribute;
    }
    if (!(region == std::floor(region) &&
          std::abs(region) <= std::numeric_limits<int32_t>::max())) {
      scan.Fail(absl::StrCat("the region is ", region, ", not a whole number"));
    }
    if (scan.ok()) builder.AddTet(number, nodes, static_cast<int32_t>(region));
  }
  return scan.status();
}

absl::Status In(absl::string_view file, const absl::Status& status) {
  if (status.ok()) return status;
  return absl::Status(status.code(), absl::StrCat(file, " file, ", status.message()));
}

}  // namespace

absl::StatusOr<TetMesh> ParseTetGen(absl::string_view node_bytes, absl::string_view ele_bytes) {
  MeshBuilder builder;
  Scanner nodes(node_bytes);
  nodes.SetComment('#');
  ReadNodes(nodes, builder);
  CLEAVE_RETURN_IF_ERROR(In(".node", nodes.status()));
  Scanner tets(ele_bytes);
  tets.SetComment('#');
  CLEAVE_RETURN_IF_ERROR(In(".ele", ReadTets(tets, builder)));
  return builder.Finish();
}

}  // namespace cleave
