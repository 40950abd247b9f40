#ifndef CLEAVE_CORE_MESH_TET_GEOMETRY_H_
#define CLEAVE_CORE_MESH_TET_GEOMETRY_H_

#include <Eigen/Core>
#include <array>

#include "core/mesh/tet_mesh.h"

namespace cleave {

// The corners of one tet, m.
using TetCorners = std::array<Eigen::Vector3d, 4>;

// Precondition: every node id of the tet is in range.
TetCorners CornersOf(const TetMesh& mesh, int64_t tet);

// m^3; positive when corners 1, 2, 3 turn anticlockwise seen from outside opposite corner 0.
double SignedVolume(const TetCorners& corners);

// Shortest and longest edge, m.
std::array<double, 2> EdgeRange(const TetCorners& corners);

// Longest edge over the diameter of the inscribed sphere, scaled so that the regular tet has 1;
// infinity for a flat one.
double Aspect(const TetCorners& corners);

// Smallest and largest angle between two faces, rad; 0 and pi for a flat tet.
std::array<double, 2> DihedralRange(const TetCorners& corners);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_TET_GEOMETRY_H_
