#ifndef CLEAVE_CORE_SURFACE_POINT_COPIES_H_
#define CLEAVE_CORE_SURFACE_POINT_COPIES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
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
// sides. Asking again, after more edges broke, brings a point up to date in its place. All points
// that are made are used: ask only for those of cells that a crack face or split boundary face
// bounds. For VisibleSurface; the source is named there.
class PointCopies {
 public:
  // All arguments must outlive this object; `surface` has the masks and takes what is made.
  PointCopies(const TetMesh& mesh, const Incidence& incidence, const Faces& faces, bool smooth,
              SurfaceTopology& surface);

  // Whether a tet's unbroken edges leave two of its vertices in different groups.
  bool Parts(size_t tet, size_t a, size_t b) const {
    const VertexGroups& groups = kVertexGroups[surface_.tet_masks[tet]];
    return groups.group[a] != groups.group[b];
  }
  // The same for two of its nodes.
  bool PartsNodes(size_t tet, int32_t a, int32_t b) const {
    return Parts(tet, VertexOf(tet, a), VertexOf(tet, b));
  }
  // Whether all tets round an edge part its ends.
  bool Splits(int32_t edge) const { return edge_splits_[static_cast<size_t>(edge)] != 0; }
  FaceState StateOf(size_t tet, size_t face) const;

  // To be called for every edge that a tet has come to part, before points are asked for.
  void UpdateEdge(int32_t edge);

  // A node's own point: one, for all cells round a node hang together.
  int32_t NodePoint(int32_t node);
  // The midpoint of an edge on the side of one of its ends.
  int32_t Midpoint(int32_t edge, int32_t node);
  // The point of a face that some tet parts, on the side of one of its nodes.
  int32_t FacePoint(const FaceState& face, int32_t node) {
    return FacePointOf(face, face.component[face.IndexOf(node)]);
  }
  // The same for a FaceState::component.
  int32_t FacePointOf(const FaceState& face, uint8_t component);
  // The copies of a split tet's own point, one a group of vertices, given for each vertex.
  std::array<int32_t, 4> TetPoints(size_t tet);
  // Where both tets of a face part the ends of one of its edges but neither midpoint nor face point
  // splits, four crack faces meet in the segment between the two: each side gets a point of its own
  // on it. Returns that of `node`'s side, or -1 elsewhere. The edge is parted by `tet`.
  int32_t PinchPoint(size_t tet, size_t face, const FaceState& state, int32_t edge, int32_t node);

  bool has_pinch_points() const { return !pinch_points_.empty(); }

  // Where a point is, or -1.
  int32_t Find(SurfaceId id) const;
  // A point is elsewhere, or nowhere (-1), from now on.
  void Place(SurfaceId id, int32_t point);

 private:
  std::unordered_map<SurfaceId, int32_t>& MapOf(SurfaceId id) {
    return surface_id::KindOf(id) == surface_id::kPinch ? pinch_points_ : other_points_;
  }
  int32_t Put(SurfaceId id, SurfacePoint point);
  size_t VertexOf(size_t tet, int32_t node) const;
  void Apply(size_t tet, FaceState& state) const;
  std::array<double, 4> FaceWeights(const FaceState& state) const;
  std::array<double, 4> TetWeights(size_t tet) const;

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const Faces& faces_;
  const bool smooth_;
  SurfaceTopology& surface_;
  std::vector<uint8_t> edge_splits_;  // an edge each: 1 where every tet parts its ends
  std::vector<int32_t> node_points_;  // a node each, or -1
  std::vector<int32_t> edge_points_;  // an edge each: the first copy, or -1
  std::unordered_map<SurfaceId, int32_t> other_points_;
  std::unordered_map<SurfaceId, int32_t> pinch_points_;  // apart, as few have any
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_POINT_COPIES_H_
