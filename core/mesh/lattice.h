#ifndef CLEAVE_CORE_MESH_LATTICE_H_
#define CLEAVE_CORE_MESH_LATTICE_H_

#include "core/mesh/body.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// The jittered lattice of a box or of a round body, as procedural.h describes it. Preconditions:
// those that CheckShape holds a shape to.
TetMesh BoxLattice(const Body& body, const MeshResolution& resolution);
TetMesh RingLattice(const Body& body, const MeshResolution& resolution);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_LATTICE_H_
