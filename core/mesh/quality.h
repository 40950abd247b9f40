#ifndef CLEAVE_CORE_MESH_QUALITY_H_
#define CLEAVE_CORE_MESH_QUALITY_H_

#include <cstdint>
#include <string>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Least, mean and greatest of something.
struct Range {
  double min = 0;
  double mean = 0;
  double max = 0;
};

// One region's share of a mesh.
struct RegionReport {
  int32_t id = 0;
  std::string name;  // empty where the mesh names none
  int64_t tet_count = 0;
  double volume = 0;  // m^3
};

// One tet that drags a mesh down.
struct WorstTet {
  int64_t tet = 0;
  double min_dihedral = 0;  // rad
  double aspect = 0;        // 1 for a regular tet
};

// What a person wants to know of a mesh before a run.
struct MeshReport {
  int64_t node_count = 0;
  int64_t tet_count = 0;
  int64_t edge_count = 0;
  int64_t boundary_face_count = 0;  // faces of exactly one tet
  int64_t component_count = 0;      // parts joined through faces, edges or nodes
  int64_t unreferenced_node_count = 0;
  Vec3 min_corner{0, 0, 0};           // m, of the nodes in tets
  Vec3 max_corner{0, 0, 0};           // m
  double volume = 0;                  // m^3
  double surface_area = 0;            // m^2, of the boundary faces
  Range edge_length;                  // m
  Range aspect;                       // 1 for a regular tet
  double min_dihedral = 0;            // rad; a regular tet has 1.23 everywhere
  double max_dihedral = 0;            // rad
  std::vector<RegionReport> regions;  // by ascending id; one of id 0 where the mesh has none
  std::vector<WorstTet> worst;        // the 10 of smallest dihedral angle, the worst first
};

// Preconditions: the mesh passed CheckAndOrientMesh; `incidence` is its own.
MeshReport ReportMesh(const TetMesh& mesh, const Incidence& incidence);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_QUALITY_H_
