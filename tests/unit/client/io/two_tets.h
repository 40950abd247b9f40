#ifndef CLEAVE_TESTS_UNIT_CLIENT_IO_TWO_TETS_H_
#define CLEAVE_TESTS_UNIT_CLIENT_IO_TWO_TETS_H_

#include "core/mesh/tet_mesh.h"

namespace cleave {

// Two tets on a common face: nodes 0 and 4 are the tips.
inline TetMesh TwoTets() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, -1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{1, 3, 2, 0}, {1, 2, 3, 4}};
  mesh.tet_regions = {5, 6};
  return mesh;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CLIENT_IO_TWO_TETS_H_
