#include "core/surface/extract_surface.h"

#include <utility>
#include <vector>

#include "core/damage/components.h"
#include "core/surface/point_copies.h"

namespace cleave {
namespace {

// For edge k of a tet, the other two vertices, so that (ends of k, these) is an even permutation:
// seen along the edge, they turn clockwise.
constexpr std::array<std::array<size_t, 2>, 6> kAcrossEdge = {
    {{2, 3}, {3, 1}, {1, 2}, {0, 3}, {2, 0}, {0, 1}}};

// The edge between two vertices of a tet.
constexpr std::array<std::array<size_t, 4>, 4> kEdgeBetween = {
    {{6, 0, 1, 2}, {0, 6, 3, 4}, {1, 3, 6, 5}, {2, 4, 5, 6}}};

// At most: a corner, three midpoints, a face point and the far corners.
struct Polygon {
  std::array<int32_t, 8> points{};
  size_t size = 0;
  void Add(int32_t point) { points[size++] = point; }
};

// What a surface tells of the whole mesh.
SurfaceTopology WithoutTriangles(const Incidence& incidence,
                                 std::span<const int32_t> broken_edges) {
  SurfaceTopology surface;
  surface.tet_masks = TetEdgeMasks(incidence, broken_edges);
  std::vector<uint8_t> broken(incidence.edges.size(), 0);
  for (const int32_t edge : broken_edges) broken[static_cast<size_t>(edge)] = 1;
  surface.fragment_count = LabelComponents(incidence, broken, surface.node_fragments);
  return surface;
}

class Extraction {
 public:
  Extraction(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
             std::span<const int32_t> broken_edges, const SurfaceOptions& options)
      : mesh_(mesh),
        incidence_(incidence),
        faces_(faces),
        out_(WithoutTriangles(incidence, broken_edges)),
        copies_(mesh, incidence, faces, out_.tet_masks, options.smooth, out_.points),
        midpoint_on_boundary_(incidence.edges.size(), 0) {}

  SurfaceTopology Run() {
    MarkSplitBoundaryEdges();
    for (const TetFace& side : faces_.boundary) AddBoundaryFace(side);
    for (size_t tet = 0; tet < mesh_.tets.size(); ++tet) {
      if (Separated(out_.tet_masks[tet])) AddCracks(tet);
    }
    return std::move(out_);
  }

 private:
  int32_t NodeOf(size_t tet, size_t vertex) const { return mesh_.tets[tet][vertex]; }
  int32_t EdgeOf(size_t tet, size_t a, size_t b) const {
    return incidence_.tet_edges[tet][kEdgeBetween[a][b]];
  }

  // Boundary edges whose ends are parted on some boundary face: all boundary faces there need the
  // midpoint, lest an unsplit one meet a split one in a T-junction.
  void MarkSplitBoundaryEdges() {
    for (const TetFace& side : faces_.boundary) {
      const auto tet = static_cast<size_t>(side.tet);
      if (!Separated(out_.tet_masks[tet])) continue;
      const std::array<int, 3>& corners = kTetFaces[static_cast<size_t>(side.face)];
      for (size_t i = 0; i < 3; ++i) {
        const auto a = static_cast<size_t>(corners[i]);
        const auto b = static_cast<size_t>(corners[(i + 1) % 3]);
        if (copies_.Parts(tet, a, b))
          midpoint_on_boundary_[static_cast<size_t>(EdgeOf(tet, a, b))] = 1;
      }
    }
  }

  void AddTriangle(int32_t a, int32_t b, int32_t c, size_t tet, int32_t node, bool inside) {
    out_.triangles.push_back({a, b, c});
    out_.fragments.push_back(out_.node_fragments[static_cast<size_t>(node)]);
    out_.tets.push_back(static_cast<int32_t>(tet));
    out_.inside.push_back(inside ? 1 : 0);
  }
  // Triangles from the first point of a polygon to all others.
  void AddFan(const Polygon& polygon, size_t tet, int32_t node, bool inside) {
    for (size_t i = 1; i + 1 < polygon.size; ++i) {
      AddTriangle(polygon.points[0], polygon.points[i], polygon.points[i + 1], tet, node, inside);
    }
  }

  void AddBoundaryFace(const TetFace& side) {
    const auto tet = static_cast<size_t>(side.tet);
    const auto face = static_cast<size_t>(side.face);
    std::array<size_t, 3> corners{};
    std::array<int32_t, 3> nodes{};
    std::array<int32_t, 3> edges{};  // edge i: from corner i to the next
    for (size_t i = 0; i < 3; ++i) {
      corners[i] = static_cast<size_t>(kTetFaces[face][i]);
      nodes[i] = NodeOf(tet, corners[i]);
    }
    size_t midpoints = 0;
    bool split = false;
    for (size_t i = 0; i < 3; ++i) {
      edges[i] = EdgeOf(tet, corners[i], corners[(i + 1) % 3]);
      midpoints += midpoint_on_boundary_[static_cast<size_t>(edges[i])];
      split |= copies_.Parts(tet, corners[i], corners[(i + 1) % 3]);
    }
    if (midpoints == 0) {
      AddTriangle(copies_.NodePoint(nodes[0]), copies_.NodePoint(nodes[1]),
                  copies_.NodePoint(nodes[2]), tet, nodes[0], false);
    } else if (split) {
      AddSplitFace(tet, face, corners, nodes, edges);
    } else {
      AddFaceWithMidpoints(tet, nodes, edges);
    }
  }

  // A boundary face whose corners are all joined but some of whose neighbours are split.
  void AddFaceWithMidpoints(size_t tet, const std::array<int32_t, 3>& nodes,
                            const std::array<int32_t, 3>& edges) {
    // Beginning at a midpoint, no triangle of the fan is flat but where two corners frame another
    // midpoint: those are cut off first.
    std::array<int32_t, 3> middle{};
    size_t first = 3;
    for (size_t i = 0; i < 3; ++i) {
      const bool has = midpoint_on_boundary_[static_cast<size_t>(edges[i])] != 0;
      middle[i] = has ? copies_.Midpoint(edges[i], nodes[i]) : -1;
      if (has && first == 3) first = i;
    }
    Polygon polygon;
    polygon.Add(middle[first]);
    for (size_t step = 1; step <= 3; ++step) {
      const size_t i = (first + step) % 3;
      const int32_t corner = copies_.NodePoint(nodes[i]);
      const int32_t before = middle[(i + 2) % 3];
      const int32_t after = middle[i];
      if (before >= 0 && after >= 0) {
        AddTriangle(before, corner, after, tet, nodes[0], false);
      } else {
        polygon.Add(corner);
      }
      if (step < 3 && after >= 0) polygon.Add(after);
    }
    AddFan(polygon, tet, nodes[0], false);
  }

  // A boundary face with parted corners: a polygon for each group of them, round the face point.
  void AddSplitFace(size_t tet, size_t face, const std::array<size_t, 3>& corners,
                    const std::array<int32_t, 3>& nodes, const std::array<int32_t, 3>& edges) {
    const FaceState state = copies_.StateOf(tet, face);
    for (size_t i = 0; i < 3; ++i) {
      const size_t before = (i + 2) % 3;
      if (!copies_.Parts(tet, corners[before], corners[i])) continue;
      // Corner i begins a group; walk on until the next parted edge.
      Polygon polygon;
      polygon.Add(copies_.FacePoint(state, nodes[i]));
      polygon.Add(copies_.Midpoint(edges[before], nodes[i]));
      for (size_t at = i;; at = (at + 1) % 3) {
        polygon.Add(copies_.NodePoint(nodes[at]));
        const bool parted = copies_.Parts(tet, corners[at], corners[(at + 1) % 3]);
        if (parted || midpoint_on_boundary_[static_cast<size_t>(edges[at])] != 0)
          polygon.Add(copies_.Midpoint(edges[at], nodes[at]));
        if (parted) break;
      }
      AddFan(polygon, tet, nodes[i], false);
    }
  }

  // The crack faces inside a split tet: across each parted edge, one towards either end.
  void AddCracks(size_t tet) {
    const std::array<int32_t, 4> tet_points = copies_.TetPoints(tet);
    std::array<FaceState, 4> states{};
    for (size_t face = 0; face < 4; ++face) states[face] = copies_.StateOf(tet, face);
    for (size_t k = 0; k < 6; ++k) {
      const std::array<size_t, 2> ends{static_cast<size_t>(kTetEdges[k][0]),
                                       static_cast<size_t>(kTetEdges[k][1])};
      if (!copies_.Parts(tet, ends[0], ends[1])) continue;
      const int32_t edge = incidence_.tet_edges[tet][k];
      for (size_t side = 0; side < 2; ++side) {
        const int32_t node = NodeOf(tet, ends[side]);
        const int32_t midpoint = copies_.Midpoint(edge, node);
        // Midpoint, first face, tet point and second face turn anticlockwise seen from the other
        // end of the edge, which is outside of this one's cell.
        const size_t first_face = kAcrossEdge[k][side == 0 ? 1 : 0];
        const size_t second_face = kAcrossEdge[k][side == 0 ? 0 : 1];
        const int32_t first = copies_.FacePoint(states[first_face], node);
        const int32_t second = copies_.FacePoint(states[second_face], node);
        const int32_t first_pinch =
            copies_.PinchPoint(tet, first_face, states[first_face], edge, node, midpoint, first);
        const int32_t second_pinch =
            copies_.PinchPoint(tet, second_face, states[second_face], edge, node, midpoint, second);
        Polygon polygon;
        polygon.Add(tet_points[ends[side]]);
        polygon.Add(second);
        if (second_pinch >= 0) polygon.Add(second_pinch);
        polygon.Add(midpoint);
        if (first_pinch >= 0) polygon.Add(first_pinch);
        polygon.Add(first);
        AddFan(polygon, tet, node, true);
      }
    }
  }

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const Faces& faces_;
  SurfaceTopology out_;
  PointCopies copies_;
  std::vector<uint8_t> midpoint_on_boundary_;  // an edge each
};

}  // namespace

SurfaceTopology ExtractSurface(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                               std::span<const int32_t> broken_edges,
                               const SurfaceOptions& options) {
  return Extraction(mesh, incidence, faces, broken_edges, options).Run();
}

}  // namespace cleave
