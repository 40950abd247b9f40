#ifndef CLEAVE_CORE_SURFACE_DIVIDED_MESH_H_
#define CLEAVE_CORE_SURFACE_DIVIDED_MESH_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/faces.h"
#include "core/surface/tet_locator.h"

namespace cleave {

// A render mesh divided so that it can come apart as a body does. Every point goes with the tet
// that it lies in, or one of the nearest boundary face (tet_locator.h), and belongs to the node
// that weighs most there, the smallest of those that weigh at most TetLocator::kWeightSlack less.
// No edge is longer than half the tets' mean edge, and, but for what some rounds do not reach,
// nodes of an edge's two points are joined by an edge of the body or the same, and three nodes of a
// triangle are a face.
//
// Depends on mesh and render mesh alone. Given points keep their ids. Thread-safe once made.
class DividedMesh {
 public:
  using Pair = std::array<int32_t, 2>;
  using Triple = std::array<int32_t, 3>;

  // `mesh`, `incidence` and `faces` must outlive this object. Preconditions: CheckRenderMesh and
  // CheckRenderMeshFits hold.
  DividedMesh(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
              RenderMesh render);

  const RenderMesh& mesh() const { return render_; }
  int32_t source(size_t triangle) const { return sources_[triangle]; }  // of the given ones
  const PlaceInTet& place(size_t point) const { return places_[point]; }
  int32_t label(size_t point) const { return labels_[point]; }  // the node that it belongs to

  // Its edges by their points, smaller first; ascending.
  const std::vector<Pair>& edges() const { return edges_; }
  // Of a triangle, edge i from corner i to the next.
  const Triple& triangle_edges(size_t triangle) const { return triangle_edges_[triangle]; }
  // Labels of a triangle's corners.
  Triple LabelsOf(size_t triangle) const;
  // Where the labels of an edge's ends weigh the same, as far as their tets tell: the share of the
  // way from its first point, in [0.02, 0.98].
  double CutShare(size_t edge) const;
  Vec3 CutAt(size_t edge) const;

  // The body's edge between two nodes, or -1.
  int32_t FindEdge(int32_t a, int32_t b) const;
  // 4 * tet + face of the lower tet with these nodes, or -1.
  int64_t FindFace(const Triple& nodes) const;

 private:
  void Divide(double longest);
  bool SplitEdges(const std::vector<uint8_t>& split);
  void NumberEdges();
  void Place(size_t first);

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const TetLocator locator_;
  RenderMesh render_;
  std::vector<int32_t> sources_;
  std::vector<PlaceInTet> places_;
  std::vector<int32_t> labels_;
  std::vector<Pair> edges_;
  std::vector<Triple> triangle_edges_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SURFACE_DIVIDED_MESH_H_
