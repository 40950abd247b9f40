#ifndef CLEAVE_CORE_MESH_BODY_CENTRED_LATTICE_H_
#define CLEAVE_CORE_MESH_BODY_CENTRED_LATTICE_H_

#include <Eigen/Core>

#include "core/mesh/procedural_shapes.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// A body-centred cubic lattice over at least the box from `low` to `high` (m): nodes at the corners
// and in the middle of cubes, moved at random by the jitter, four tets round every face between two
// middles. Volumes are positive. Preconditions: cell size above 0, jitter in [0, 0.4], so few cells
// that node ids fit.
TetMesh BodyCentredLattice(const Eigen::Vector3d& low, const Eigen::Vector3d& high,
                           const MeshResolution& resolution);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_BODY_CENTRED_LATTICE_H_
