#ifndef CLEAVE_CORE_SURFACE_SURFACE_TOPOLOGY_H_
#define CLEAVE_CORE_SURFACE_SURFACE_TOPOLOGY_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/damage/edge_mask.h"
#include "core/surface/surface_ids.h"

namespace cleave {

// A point of the visible surface: where it lies in the rest shape, and which nodes carry it.
struct SurfacePoint {
  Vec3 rest{};                                   // m: the weighted mean of its nodes, unless it is
                                                 // `off_nodes`
  std::array<int32_t, 4> nodes{-1, -1, -1, -1};  // the first `node_count` count
  std::array<double, 4> weights{};               // of the nodes; they sum to 1
  uint8_t node_count = 0;
  uint8_t owners = 0;  // bit i: nodes[i] is on this copy's side of the cracks through the point

  bool off_nodes = false;  // only near its nodes: weights are for values, not for places

  bool owned_by_all() const { return owners == (1u << node_count) - 1; }
};

// The visible surface of a broken mesh, independent of the motion of its nodes: closed, oriented,
// every edge between exactly two triangles but where shared_edges.h has work, pieces sharing no
// points. What it holds depends on the
// mesh and its broken edges only, so client and server derive the same one, and so do those who
// followed a run and those who join it: the same ids with the same records. Only places in the
// arrays follow from how the edges came to break.
struct SurfaceTopology {
  // One a point.
  std::vector<SurfacePoint> points;
  std::vector<SurfaceId> point_ids;  // surface_ids.h

  // One a triangle.
  std::vector<std::array<int32_t, 3>>
      triangles;                        // indices of points, counter-clockwise from outside
  std::vector<SurfaceId> triangle_ids;  // surface_ids.h
  std::vector<int32_t> nodes;           // one on its side, which knows its piece
  std::vector<int32_t> tets;            // the tet behind it, which knows its region
  std::vector<uint8_t> inside;          // 1: opened by a crack; 0: the body's own surface

  std::vector<EdgeMask> tet_masks;  // of the whole mesh
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_SURFACE_TOPOLOGY_H_
