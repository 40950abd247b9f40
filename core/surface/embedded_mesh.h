#ifndef CLEAVE_CORE_SURFACE_EMBEDDED_MESH_H_
#define CLEAVE_CORE_SURFACE_EMBEDDED_MESH_H_

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "core/damage/named_pieces.h"
#include "core/mesh/incidence.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/divided_mesh.h"
#include "core/surface/faces.h"
#include "core/surface/point_copies.h"
#include "core/surface/render_hubs.h"
#include "core/surface/surface_topology.h"

namespace cleave {

// A render mesh that is bound to a simulated body, follows it, and breaks where its edges break.
//
// It is divided (divided_mesh.h) as corner cells divide the tets (visible_surface.h, not smooth).
// Where all tets of an edge part the nodes of a render edge's ends, that is cut between them, where
// the two weigh the same; a triangle between three such nodes gets a point inside, whose copies are
// those of the face's point. The cut goes on inwards as crack faces: those of the corner cells,
// whose points on the body's surface (one for each pair and triple of nodes) lie in the middle of
// the cut of the render mesh instead, and fans between these and the cut. So cracks open as those
// of the body's own surface do, whether they cut a piece off or not, and tips close by themselves.
//
// Where the render mesh does not follow the body's faces, as where it bridges a crease of it, there
// are gaps between what the cuts of both go round (render_hubs.h). Cracks there are closed by caps:
// cones from the rim of a group of gaps to one point, a copy of it for each side.
//
// What holds: of a closed render mesh every piece is closed, each directed edge standing against as
// many of its reverse, and rest volumes of the pieces sum to the render mesh's. Rigid motions of
// pieces are followed exactly. Ids and records follow from the broken edges alone, as those of a
// visible surface do. What does not: crack faces are as coarse as the tets, with fans at the rim,
// may touch along edges, which shared_edges.h parts, and may reach past the render mesh where it is
// bent inward between nodes. A piece whose corner cells hold no point of the render mesh and lie
// outside of it is not shown.
//
// Breaking makes anew only what is round edges that some tet has come to part. Not thread-safe.
class EmbeddedMesh {
 public:
  // All edges unbroken. `mesh`, `incidence` and `faces` must outlive this object. Preconditions:
  // CheckRenderMesh and CheckRenderMeshFits hold.
  EmbeddedMesh(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
               RenderMesh render);
  EmbeddedMesh(const EmbeddedMesh&) = delete;
  EmbeddedMesh& operator=(const EmbeddedMesh&) = delete;

  // Breaks more edges, ids in range, once each. `pieces` has them broken; what the body does not
  // join, like two of its parts, comes apart by it. Returns how many triangles of the divided mesh
  // and tets were made anew: the work, whatever the size of the mesh. Called once, if with no
  // edges, before the first use.
  int64_t Break(std::span<const int32_t> edges, const NamedPieces& pieces);

  const SurfaceTopology& topology() const { return out_; }
  // Texture coordinates, a triangle each, 0 inside; empty where the render mesh has none.
  const std::vector<CornerUvs>& uvs() const { return uvs_; }
  // The triangle of the render mesh behind each, -1 inside.
  const std::vector<int32_t>& sources() const { return sources_; }

  // Where the render mesh does not follow the body's faces: cracks there are closed by caps.
  int64_t gaps() const { return static_cast<int64_t>(hubs_.gaps().size()); }
  // The render mesh as it is divided; points keep their ids.
  const RenderMesh& divided() const { return divided_.mesh(); }

 private:
  struct Corner {
    int32_t point = -1;
    std::array<float, 2> uv{};
    unsigned place = 0;  // in a triangle: a corner, 3 + an edge, or 6 in the middle
  };
  // How a triangle, or a gap, between three nodes comes apart.
  struct Parting {
    std::array<uint8_t, 3> component{0, 1, 2};  // of each corner: numbers of the face's nodes
    std::array<bool, 3> open{};  // between corner i and the next, a crack goes inwards
  };
  using Triple = DividedMesh::Triple;
  // A node of a group of gaps.
  struct RimNode {
    int32_t group = 0;
    int32_t node = 0;
    int32_t joined = 0;  // the first of the group's that unbroken edges of its gaps join to it
  };
  // In place of an edge of the body between two nodes.
  static constexpr int32_t kSameNode = -1;
  static constexpr int32_t kNoEdge = -2;

  static bool AreThree(const std::array<int32_t, 3>& nodes) {
    return nodes[0] != nodes[1] && nodes[1] != nodes[2] && nodes[2] != nodes[0];
  }
  void BindTriangles();
  int32_t NodeAt(size_t triangle, size_t k) const;
  size_t EdgeAt(size_t triangle, size_t k) const;
  bool IsCut(size_t edge) const;    // has a point where its nodes meet
  bool IsSplit(size_t edge) const;  // and that has two copies
  // The same for nodes with that edge of the body, or none.
  bool IsSplit(int32_t body_edge, int32_t a, int32_t b) const;
  Parting PartingOf(size_t triangle) const;
  Parting PartingOf(const Triple& nodes, const Triple& body_edges, int64_t face) const;

  int32_t Put(SurfaceId id, const SurfacePoint& point);
  int32_t EdgePoint(size_t edge, int32_t node);
  int32_t MiddlePoint(size_t triangle, const Parting& parting, size_t corner);
  // Of nodes with that edge of the body, or none, on the side of `node`.
  int32_t PairPoint(int32_t body_edge, int32_t node, int32_t other);
  int32_t PairPointOf(int32_t body_edge, int32_t node);
  int32_t TriplePoint(const Triple& nodes, int64_t face, const Parting& parting, size_t corner);
  int32_t FacePointOf(const FaceState& state, int32_t node);

  // What is made after this takes the places in `slots`, and then new ones.
  void Begin(std::vector<int32_t>& slots);
  void AddTriangle(SurfaceId id, int32_t a, int32_t b, int32_t c, size_t tet, int32_t node,
                   int32_t source);
  void AddFan(std::span<const Corner> polygon, size_t triangle, int32_t node);
  void CutTriangle(size_t triangle);
  void CutAcross(size_t triangle, std::span<const Corner, 3> corners,
                 const std::array<std::array<float, 2>, 3>& cut_uvs);
  void CutBetween(size_t triangle, std::span<const Corner, 3> corners,
                  const std::array<std::array<float, 2>, 3>& cut_uvs);
  void AddWings(size_t triangle, const Parting& parting);
  void CutTet(size_t tet);

  // embedded_caps.cc.
  void BindGaps();
  size_t RimIndex(int32_t group, int32_t node) const;
  void JoinRims();
  int32_t ApexPoint(int32_t group, int32_t node);
  int64_t CapGaps();

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const Faces& faces_;
  const DividedMesh divided_;
  const RenderHubs hubs_;
  std::vector<int32_t> body_edges_;      // of each divided edge: kSameNode, kNoEdge or the edge
  std::vector<int64_t> triangle_faces_;  // of each divided triangle: 4 * tet + face, or -1
  std::vector<int32_t> loose_;           // triangles whose nodes the body does not join so
  // Edges of the body and the triangles between their nodes, ascending.
  std::vector<std::array<int32_t, 2>> edge_triangles_;
  Csr tet_points_;                  // points of the divided mesh that go with each tet
  std::vector<uint8_t> is_parted_;  // an edge of the body each: by some tet
  std::vector<Triple> gap_edges_;   // of the body, of each gap's edges, or kNoEdge
  std::vector<Vec3> apexes_;        // m at rest, a group of gaps each
  std::vector<RimNode> rim_;        // ascending

  const NamedPieces* pieces_ = nullptr;  // in a call
  SurfaceTopology out_;
  PointCopies copies_;
  std::vector<CornerUvs> uvs_;
  std::vector<int32_t> sources_;
  std::unordered_map<SurfaceId, int32_t> points_;  // those that copies_ does not know
  // Places in the topology of what was made of cut triangles and tets.
  std::unordered_map<int32_t, std::vector<int32_t>> triangle_slots_;
  std::unordered_map<int32_t, std::vector<int32_t>> tet_slots_;
  std::vector<int32_t> cap_slots_;

  // Scratch of a call.
  std::vector<int32_t> parted_;
  std::vector<int32_t> touched_;
  std::vector<int32_t>* slots_ = nullptr;
  size_t used_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_EMBEDDED_MESH_H_
