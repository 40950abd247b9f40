#ifndef CLEAVE_CORE_MESH_PROCEDURAL_H_
#define CLEAVE_CORE_MESH_PROCEDURAL_H_

#include "absl/status/statusor.h"
#include "core/base/faults.h"
#include "core/mesh/procedural_shapes.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Everything that keeps a shape from being meshed, fields named as in the struct: sizes that are
// not positive and finite, jitter outside [0, 0.4], cells too coarse for the shape's thinnest part
// or roundest edge, or more tets than limits::kMaxTets.
Faults CheckShape(const BoxMesh& shape);
Faults CheckShape(const CylinderMesh& shape);
Faults CheckShape(const TubeMesh& shape);
Faults CheckShape(const DiscMesh& shape);

// About how many tets BuildMesh makes; exact for lattices of boxes. Precondition: CheckShape
// finds no error.
double EstimateTets(const BoxMesh& shape);
double EstimateTets(const CylinderMesh& shape);
double EstimateTets(const TubeMesh& shape);
double EstimateTets(const DiscMesh& shape);

// Meshes a shape. Every result passes CheckAndOrientMesh without a fault or a warning; all surface
// nodes lie on the shape, so round sides are inscribed polygons. The same shape gives the same bits
// on every run. InvalidArgument when CheckShape finds an error.
//
// Jittered lattice of a box: n = max(1, round(size / cell_size)) cells along each axis, node id
// (i * (ny + 1) + j) * (nz + 1) + k, each cell cut into the six tets round its main diagonal
// (Kuhn). Nodes move by up to `jitter` cells along each axis; those on the surface slide within
// their face or edge. Where a tet would lose 70 % of its volume, its nodes move less.
// Round shapes: layers of concentric rings, 6 k nodes on ring k of a solid one, so that no cell
// degenerates at the axis; each prism is cut into three tets.
//
// Unstructured: Delaunay tets of random well-spaced points, smoothed, then improved until no
// dihedral angle is small.
absl::StatusOr<TetMesh> BuildMesh(const BoxMesh& shape);
absl::StatusOr<TetMesh> BuildMesh(const CylinderMesh& shape);
absl::StatusOr<TetMesh> BuildMesh(const TubeMesh& shape);
absl::StatusOr<TetMesh> BuildMesh(const DiscMesh& shape);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_PROCEDURAL_H_
