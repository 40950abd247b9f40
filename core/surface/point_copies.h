#ifndef CLEAVE_CORE_SURFACE_POINT_COPIES_H_
#define CLEAVE_CORE_SURFACE_POINT_COPIES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/damage/edge_mask.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/faces.h"
#include "core/surface/surface_topology.h"

namespace cleave {

// A face as both of its tets see it.
struct FaceState {
  size_t slot = 0;                            // 4 * tet + face, of the tet with the lower id
  std::array<int32_t, 3> nodes{};             // as that tet lists them in kTetFaces
  std::array<uint8_t, 3> component{0, 1, 2};  // of each node: the first that some tet joins to it
  std::array<bool, 3> parted{};               // edge i, from node i to the next: by some tet

  size_t IndexOf(int32_t node) const;
};

// Makes the points of a visible surface as they are asked for, a copy for each side of the cracks
// that run through a point; crack tips close because a copy ends where some tet still joins its
// sides. All points that are made are used: ask only for those of cells that a crack face or split
// boundary face bounds. For ExtractSurface; the source is named there.
class PointCopies {
 public:
  // All arguments must outlive this object; `points` takes what is made.
  PointCopies(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
              std::span<const EdgeMask> tet_masks, bool smooth, std::vector<SurfacePoint>& points);

  // Whether a tet's unbroken edges leave two of its vertices in different groups.
  bool Parts(size_t tet, size_t a, size_t b) const {
    const VertexGroups& groups = kVertexGroups[tet_masks_[tet]];
    return groups.group[a] != groups.group[b];
  }
  FaceState StateOf(size_t tet, size_t face) const;

  // A node's own point: one, for all cells round a node hang together.
  int32_t NodePoint(int32_t node);
  // The midpoint of an edge on the side of one of its ends.
  int32_t Midpoint(int32_t edge, int32_t node);
  // The point of a face that some tet parts, on the side of one of its nodes.
  int32_t FacePoint(const FaceState& face, int32_t node);
  // The copies of a split tet's own point, one a group of vertices, given for each vertex.
  std::array<int32_t, 4> TetPoints(size_t tet);
  // Where both tets of a face part the ends of one of its edges but neither midpoint nor face point
  // splits, four crack faces meet in the segment between the two: each side gets a point of its own
  // on it. Returns that of `node`'s side, or -1 elsewhere. The edge is parted by `tet`, and has
  // these two points at hand.
  int32_t PinchPoint(size_t tet, size_t face, const FaceState& state, int32_t edge, int32_t node,
                     int32_t midpoint, int32_t face_point);

 private:
  int32_t Add(SurfacePoint point);
  size_t VertexOf(size_t tet, int32_t node) const;
  bool PartsNodes(size_t tet, int32_t a, int32_t b) const {
    return Parts(tet, VertexOf(tet, a), VertexOf(tet, b));
  }
  void Apply(size_t tet, FaceState& state) const;
  std::array<double, 4> FaceWeights(const FaceState& state) const;
  std::array<double, 4> TetWeights(size_t tet) const;

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const Faces& faces_;
  const std::span<const EdgeMask> tet_masks_;
  const bool smooth_;
  std::vector<SurfacePoint>& points_;
  // The first copy, or -1 before it is asked for; copies lie one after the other.
  std::vector<int32_t> node_points_;
  std::vector<int32_t> edge_points_;
  std::vector<int32_t> face_points_;  // at FaceState::slot
  std::unordered_map<uint64_t, int32_t> pinch_points_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_POINT_COPIES_H_
