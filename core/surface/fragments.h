#ifndef CLEAVE_CORE_SURFACE_FRAGMENTS_H_
#define CLEAVE_CORE_SURFACE_FRAGMENTS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// The pieces of a mesh: components of its nodes through unbroken edges. Fragment ids count from 0
// in the order of each fragment's smallest node; they are not stable from frame to frame.
struct Fragments {
  std::vector<int32_t> node_fragments;  // a node each; -1 for a node of no tet
  std::vector<double> volumes;       // m^3 at rest, a fragment each: a quarter of each tet a node
  std::vector<int32_t> node_counts;  // a fragment each

  int32_t count() const { return static_cast<int32_t>(volumes.size()); }
};

// Precondition: edge ids are in range.
Fragments FindFragments(const TetMesh& mesh, const Incidence& incidence,
                        std::span<const int32_t> broken_edges);

// How many of `sizes` (volumes or masses of fragments) are at least `smallest_share` of their sum:
// pieces worth naming, the rest being dust.
int32_t CountPieces(std::span<const double> sizes, double smallest_share);

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_FRAGMENTS_H_
