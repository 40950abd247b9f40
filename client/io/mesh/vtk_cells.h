#ifndef CLEAVE_CLIENT_IO_MESH_VTK_CELLS_H_
#define CLEAVE_CLIENT_IO_MESH_VTK_CELLS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "client/io/mesh/mesh_builder.h"

namespace cleave {

// Feeds the cells of VTK files, legacy or XML, to a builder.
class VtkCells {
 public:
  explicit VtkCells(MeshBuilder& builder) : builder_(builder) {}

  // Takes one cell of the given VTK type whose points have numbers from `first_point` on: keeps
  // tets, passes over cells of lower dimension, refuses the rest by name.
  absl::Status Add(int64_t type, std::span<const int64_t> points, int64_t first_point);
  // Sets the region of a cell, counted from 0 over all cells added. Regions that are not whole
  // numbers of 32 bits are refused.
  absl::Status SetRegion(int64_t cell, double region);

  int64_t cell_count() const { return static_cast<int64_t>(tet_of_cell_.size()); }

 private:
  MeshBuilder& builder_;
  std::vector<int64_t> tet_of_cell_;  // or -1
};

// Whether a cell array of this name tells regions: region, material, gmsh:physical and the like.
bool IsRegionArray(absl::string_view name);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_VTK_CELLS_H_
