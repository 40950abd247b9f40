#include "client/io/mesh/vtk_cells.h"

#include <cmath>
#include <limits>
#include <string>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"

namespace cleave {
namespace {

// Names of the cell types in vtkCellType.h that have a volume; null for those that have none.
const char* VolumeName(int64_t type) {
  switch (type) {
    case 11:
      return "voxel";
    case 12:
      return "hexahedron";
    case 13:
      return "wedge";
    case 14:
      return "pyramid";
    case 24:
      return "10-node tetrahedron";
    case 25:
    case 29:
    case 33:
      return "quadratic hexahedron";
    case 26:
    case 31:
    case 32:
      return "quadratic wedge";
    case 27:
      return "quadratic pyramid";
    case 42:
      return "polyhedron";
    case 71:
    case 78:
      return "higher-order tetrahedron";
    default:
      return nullptr;
  }
}

bool IsFlat(int64_t type) {
  constexpr int64_t kQuadraticEdgeToQuad[] = {21, 22, 23, 28, 30, 34, 35, 36};
  if (type >= 0 && type <= 9) return true;  // empty, vertices, lines, triangles, quads, polygons
  for (const int64_t flat : kQuadraticEdgeToQuad) {
    if (type == flat) return true;
  }
  return type == 68 || type == 69 || type == 70 || type == 75 || type == 76 || type == 77;
}

}  // namespace

absl::Status VtkCells::Add(int64_t type, std::span<const int64_t> points, int64_t first_point) {
  const int64_t cell = cell_count();
  if (type != 10) {
    if (IsFlat(type)) {
      tet_of_cell_.push_back(-1);
      return absl::OkStatus();
    }
    const char* name = VolumeName(type);
    const std::string unnamed = absl::StrCat("cell of VTK type ", type);
    return RefuseElement(absl::StrCat("cell ", cell), name != nullptr ? name : unnamed.c_str());
  }
  if (points.size() != 4) {
    return absl::InvalidArgumentError(
        absl::StrCat("cell ", cell, " is a tetrahedron of ", points.size(), " points"));
  }
  std::array<int64_t, 4> nodes;
  for (size_t k = 0; k < 4; ++k) {
    if (points[k] < 0 || points[k] > std::numeric_limits<int32_t>::max()) {
      return absl::InvalidArgumentError(
          absl::StrCat("cell ", cell, " names point ", points[k], ", which is not there"));
    }
    nodes[k] = first_point + points[k];
  }
  tet_of_cell_.push_back(builder_.tet_count());
  builder_.AddTet(cell, nodes, 0);
  return absl::OkStatus();
}

absl::Status VtkCells::SetRegion(int64_t cell, double region) {
  if (!(region == std::floor(region) && std::abs(region) <= std::numeric_limits<int32_t>::max())) {
    return absl::InvalidArgumentError(
        absl::StrCat("the region of cell ", cell, " is ", region, ", not a whole number"));
  }
  const int64_t tet = tet_of_cell_[static_cast<size_t>(cell)];
  if (tet >= 0) builder_.SetRegion(tet, static_cast<int32_t>(region));
  return absl::OkStatus();
}

bool IsRegionArray(absl::string_view name) {
  const std::string lower = absl::AsciiStrToLower(name);
  for (const char* known :
       {"region", "regions", "regionid", "region_id", "regionids", "material", "materials",
        "materialid", "material_id", "materialids", "gmsh:physical", "cellentityids", "attribute",
        "physical", "physicalids", "medit:ref", "tetgen:ref"}) {
    if (lower == known) return true;
  }
  return false;
}

}  // namespace cleave
