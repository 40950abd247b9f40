#ifndef CLEAVE_CORE_MESH_MESH_CHECK_H_
#define CLEAVE_CORE_MESH_MESH_CHECK_H_

#include <cstdint>

#include "core/base/faults.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Finds everything that keeps a mesh from being simulated, and swaps the last two nodes of tets of
// negative orientation so that every tet has positive volume. Takes any mesh: ids out of range, NaN
// and arrays of inconsistent length become faults. Positions in metres; tolerances are relative but
// for the absolute range of lengths (mesh_limits.h).
//
// Errors (method note, section 12): no tets (item 13); too many nodes or tets (17); coordinates not
// finite or out of range (5); node ids out of range or repeated in a tet (9); flat tets (10); faces
// in over two tets (11); two tets on one side of a face (12); duplicate tets (16); region arrays
// that do not fit. Each names its node or tet.
//
// Warnings, one of each kind with a count and the first id: swapped orientation (18), unreferenced
// nodes, which are kept (19), coincident unwelded nodes (20), slivers (21). Parts that only touch
// at nodes or edges, and several bodies, are fine.
//
// When it returns with ok(), the mesh meets the preconditions of BuildIncidence and the solver.
Faults CheckAndOrientMesh(TetMesh& mesh);

// The part that needs no mesh: no tets (13), or more nodes or tets than can be held (17).
Faults CheckMeshCounts(int64_t node_count, int64_t tet_count);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_MESH_CHECK_H_
