#ifndef CLEAVE_CORE_SURFACE_VISIBLE_SURFACE_H_
#define CLEAVE_CORE_SURFACE_VISIBLE_SURFACE_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/faces.h"
#include "core/surface/point_copies.h"
#include "core/surface/surface_topology.h"

namespace cleave {

struct SurfaceOptions {
  // Moves the points inside faces and tets to the mean of the midpoints of their separated edges,
  // which makes cuts of one or two vertices flat. Without it they stay at the centroids, where each
  // node's share of a tet is exactly a quarter.
  bool smooth = true;
};

// The visible surface of a mesh whose edges break, with no new elements: each tet whose vertices
// its unbroken edges no longer join is split into corner cells (vertex, edge midpoints, face and
// tet points), and cells of different groups of vertices face each other across quads, one for each
// side. Whatever is not split keeps its plain boundary triangles, with a midpoint where a split
// neighbour has one. Points are copied where cracks run through and not at crack tips.
//
// Source: method note, section 8. The pinch edges that it names (four crack faces round a segment
// whose ends stay whole) are resolved by a point of its own on each side. Crack faces may still
// touch in a point, which fans.h parts, and where the mesh itself is joined only by a node or an
// edge, so is the surface.
//
// Breaking makes anew only what is round edges that some tet has come to part; all else stays in
// its place. Not thread-safe.
class VisibleSurface {
 public:
  // All edges unbroken. `mesh`, `incidence` and `faces`, which is the mesh's, must outlive this
  // object. Time and memory follow the mesh.
  VisibleSurface(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                 const SurfaceOptions& options);
  VisibleSurface(const VisibleSurface&) = delete;
  VisibleSurface& operator=(const VisibleSurface&) = delete;

  // Breaks more edges, ids in range, once each. Returns how many tets and boundary faces were made
  // anew: the work, whatever the size of the mesh.
  int64_t Break(std::span<const int32_t> edges);

  const SurfaceTopology& topology() const { return out_; }

 private:
  // At most: a corner, three midpoints, a face point and the far corners.
  struct Polygon {
    std::array<int32_t, 8> points{};
    std::array<uint8_t, 8> corners{};  // which of a boundary face's, as in surface_id::OfOuter
    size_t size = 0;
    void Add(int32_t point, size_t corner = 0) {
      points[size] = point;
      corners[size++] = static_cast<uint8_t>(corner);
    }
  };

  int32_t NodeOf(size_t tet, size_t vertex) const { return mesh_.tets[tet][vertex]; }
  int32_t EdgeOf(size_t tet, size_t a, size_t b) const;
  size_t BoundaryIndex(size_t face) const;
  int32_t& HeadOf(size_t triangle);

  // Fills `touched_` with the tets round those.
  void FindTouched();
  // What is made between these two takes the triangles of `head`'s list, and then new ones.
  void Begin(int32_t& head);
  void End();
  void AddTriangle(SurfaceId id, int32_t a, int32_t b, int32_t c, size_t tet, int32_t node,
                   bool inside);
  // Triangles from the first point of a polygon of a boundary face to all others.
  void AddFan(const Polygon& polygon, size_t face, int32_t node);
  void AddBoundaryFace(size_t tet, size_t face);
  void AddFaceWithMidpoints(size_t tet, size_t face, const std::array<int32_t, 3>& nodes,
                            const std::array<int32_t, 3>& edges);
  void AddSplitFace(size_t tet, size_t face, const std::array<int32_t, 3>& nodes,
                    const std::array<int32_t, 3>& edges);
  void AddCracks(size_t tet);

  // Fills `pinches_` with the pinch points of touched tets; AddCracks marks those that stay.
  void FindPinches();
  void RemovePoint(SurfaceId id);
  void RemoveTriangle(int32_t triangle);
  // Calls back with every triangle of a tet and its boundary faces.
  template <typename Visit>
  void ForTrianglesOf(size_t tet, const Visit& visit);

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const Faces& faces_;
  SurfaceTopology out_;
  PointCopies copies_;
  std::vector<uint8_t> midpoint_on_boundary_;  // an edge each
  // Lists of triangles: first of each tet's cracks and of each boundary face, and next; or -1.
  std::vector<int32_t> crack_heads_;
  std::vector<int32_t> outer_heads_;
  std::vector<int32_t> next_;

  // Scratch of a call.
  std::vector<int32_t> parted_;      // edges
  std::vector<int32_t> touched_;     // tets, ascending
  std::vector<uint8_t> is_touched_;  // a tet each
  std::vector<SurfaceId> pinches_;   // ascending
  std::vector<uint8_t> pinch_stays_;
  int32_t* head_ = nullptr;
  std::vector<int32_t> old_;  // triangles of the list in work, the last first
  std::vector<int32_t> left_over_;
};

// The surface of a mesh with these edges broken, for whoever needs it once.
SurfaceTopology ExtractSurface(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                               std::span<const int32_t> broken_edges,
                               const SurfaceOptions& options);

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_VISIBLE_SURFACE_H_
