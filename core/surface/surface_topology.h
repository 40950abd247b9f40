#ifndef CLEAVE_CORE_SURFACE_SURFACE_TOPOLOGY_H_
#define CLEAVE_CORE_SURFACE_SURFACE_TOPOLOGY_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/damage/edge_mask.h"

namespace cleave {

// A point of the visible surface: where it lies in the rest shape, and which nodes carry it.
struct SurfacePoint {
  Vec3 rest{};                                   // m: the weighted mean of its nodes
  std::array<int32_t, 4> nodes{-1, -1, -1, -1};  // the first `node_count` count
  std::array<double, 4> weights{};               // of the nodes; they sum to 1
  uint8_t node_count = 0;
  uint8_t owners = 0;  // bit i: nodes[i] is on this copy's side of the cracks through the point

  bool owned_by_all() const { return owners == (1u << node_count) - 1; }
};

// The visible surface of a broken mesh, independent of the motion of its nodes: closed, oriented,
// every edge between exactly two triangles, pieces sharing no points. It depends on the mesh and
// its broken edges only, so client and server derive the same one.
struct SurfaceTopology {
  std::vector<SurfacePoint> points;
  std::vector<std::array<int32_t, 3>> triangles;  // point ids, counter-clockwise from outside

  // One a triangle.
  std::vector<int32_t> fragments;  // fragments.h
  std::vector<int32_t> tets;       // the tet behind it, which knows its region
  std::vector<uint8_t> inside;     // 1: opened by a crack; 0: the body's own surface

  std::vector<EdgeMask> tet_masks;      // of the whole mesh
  std::vector<int32_t> node_fragments;  // of the whole mesh; -1 for a node of no tet
  int32_t fragment_count = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_SURFACE_TOPOLOGY_H_
