#ifndef CLEAVE_CORE_SURFACE_EMBEDDED_MESH_H_
#define CLEAVE_CORE_SURFACE_EMBEDDED_MESH_H_

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "core/damage/named_pieces.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/faces.h"
#include "core/surface/render_mesh.h"
#include "core/surface/surface_topology.h"
#include "core/surface/tet_locator.h"

namespace cleave {

// A render mesh that is bound to a simulated body, follows it and comes apart with its pieces.
//
// Every point goes with the tet that it lies in, or the one of the nearest boundary face, and
// belongs to the node that weighs most there: so the mesh is divided as corner cells divide the
// tets (visible_surface.h, not smooth). Where the nodes of an edge's ends are of different pieces,
// the edge is cut between them, where the two weigh the same; a triangle of three such nodes gets a
// point inside. The cut goes on inwards as crack faces: those of the corner cells, whose points on
// the body's surface (one for each pair and triple of nodes) lie in the middle of the cut of the
// render mesh instead, and fans between these and the cut.
//
// What holds: of a closed render mesh every piece is closed, each directed edge standing against as
// many of its reverse, and rest volumes of the pieces sum to the render mesh's; both but for the
// faults that open_faces() counts. Rigid motions of pieces are followed exactly. What does not:
// cracks that have not cut a piece off do not open, the mesh is stretched across them. Crack faces
// are as coarse as the tets, with fans at the rim, and may reach past the render mesh where it is
// bent inward between nodes. A piece whose corner cells hold no point of the render mesh and lie
// outside of it is not shown.
//
// Triangles are divided before, so that no edge is longer than half the tets' mean edge, and
// further where triples of nodes would be no face of a tet. Not thread-safe.
class EmbeddedMesh {
 public:
  // `mesh`, `incidence` and `faces` must outlive this object. Preconditions: CheckRenderMesh and
  // CheckRenderMeshFits hold.
  EmbeddedMesh(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
               RenderMesh render);

  // Divides the mesh among pieces. Of the topology ids stay empty.
  void Cut(const NamedPieces& pieces);
  const SurfaceTopology& topology() const { return out_; }
  // Of the whole mesh, for the topology: PointMotion wants them.
  void SetMasks(std::vector<EdgeMask> masks) { out_.tet_masks = std::move(masks); }
  // Texture coordinates, a triangle each, 0 inside; empty where the render mesh has none.
  const std::vector<CornerUvs>& uvs() const { return uvs_; }
  // The triangle of the render mesh behind each, -1 inside.
  const std::vector<int32_t>& sources() const { return sources_; }

  // Faces of tets at which the render mesh does not go round the body as its boundary does: where
  // one of them is cut, pieces may have a hole.
  int64_t open_faces() const { return open_faces_; }
  // The render mesh as it is divided; points keep their ids.
  const RenderMesh& divided() const { return render_; }

 private:
  using Pair = std::array<int32_t, 2>;
  using Triple = std::array<int32_t, 3>;
  // The mean of places, for points that several cuts share.
  struct Hub {
    Vec3 sum{0, 0, 0};
    int32_t count = 0;
  };
  struct Corner {
    int32_t point;
    std::array<float, 2> uv;
  };

  void Divide(double longest);
  bool SplitEdges(const std::vector<uint8_t>& split);
  void NumberEdges();
  void Place(size_t first);
  int32_t Label(size_t point) const { return labels_[point]; }
  // 4 * tet + face of the lower tet with these nodes, or -1.
  int64_t FindFace(const Triple& nodes) const;
  bool AreJoined(int32_t a, int32_t b) const;
  void FindHubs();
  void FindInside();
  Vec3 CutAt(size_t edge, double& share) const;

  int32_t Copy(uint64_t kind, uint64_t id, const SurfacePoint& point, int32_t piece);
  int32_t VertexCopy(int32_t point);
  int32_t EdgeCopy(size_t edge, int32_t piece);
  int32_t MiddleCopy(size_t triangle, int32_t piece);
  int32_t PairCopy(int32_t a, int32_t b, int32_t piece);
  int32_t TripleCopy(Triple nodes, int32_t piece);
  int32_t TetCopy(size_t tet, int32_t piece);
  uint8_t OwnersOf(const SurfacePoint& point, int32_t piece) const;
  void AddTriangle(int32_t a, int32_t b, int32_t c, size_t tet, int32_t node, int32_t source);
  void AddOuter(std::span<const Corner> polygon, size_t triangle, int32_t node);
  void CutTriangle(size_t triangle);
  void CutTet(size_t tet);

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const Faces& faces_;
  const TetLocator locator_;
  RenderMesh render_;
  std::vector<int32_t> source_of_;                      // the given triangle of each
  std::vector<PlaceInTet> places_;                      // a point each
  std::vector<int32_t> labels_;                         // a point each: the node that it belongs to
  std::vector<Pair> edges_;                             // points, smaller first; ascending
  std::vector<std::array<int32_t, 3>> triangle_edges_;  // from corner i to the next
  std::map<Pair, Hub> pair_hubs_;
  std::map<Triple, Hub> triple_hubs_;
  std::vector<int32_t> inside_;  // a tet each: how often the render mesh goes round it; 1 or 0
  int64_t open_faces_ = 0;

  const NamedPieces* pieces_ = nullptr;
  SurfaceTopology out_;
  std::vector<CornerUvs> uvs_;
  std::vector<int32_t> sources_;
  std::map<std::array<uint64_t, 3>, int32_t> copies_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_EMBEDDED_MESH_H_
