#include "core/surface/extract_surface.h"

#include <algorithm>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/damage/components.h"

namespace cleave {
namespace {

// For edge k of a tet, the other two vertices, so that (ends of k, these) is an even permutation:
// seen along the edge, they turn clockwise.
constexpr std::array<std::array<size_t, 2>, 6> kAcrossEdge = {
    {{2, 3}, {3, 1}, {1, 2}, {0, 3}, {2, 0}, {0, 1}}};

// The edge between two vertices of a tet.
constexpr std::array<std::array<size_t, 4>, 4> kEdgeBetween = {
    {{6, 0, 1, 2}, {0, 6, 3, 4}, {1, 3, 6, 5}, {2, 4, 5, 6}}};

constexpr int32_t kNone = -1;

// At most: a corner, three midpoints, a face point and the far corners.
struct Polygon {
  std::array<int32_t, 8> points{};
  size_t size = 0;
  void Add(int32_t point) { points[size++] = point; }
};

class Extraction {
 public:
  Extraction(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
             std::span<const int32_t> broken_edges, const SurfaceOptions& options)
      : mesh_(mesh), incidence_(incidence), faces_(faces), options_(options) {
    out_.tet_masks = TetEdgeMasks(incidence, broken_edges);
    std::vector<uint8_t> broken(incidence.edges.size(), 0);
    for (const int32_t edge : broken_edges) broken[static_cast<size_t>(edge)] = 1;
    out_.fragment_count = LabelComponents(incidence, broken, out_.node_fragments);
    node_points_.assign(mesh.rest_positions.size(), kNone);
    edge_points_.assign(incidence.edges.size(), kNone);
    face_points_.assign(4 * mesh.tets.size(), kNone);
    midpoint_on_boundary_.assign(incidence.edges.size(), 0);
  }

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
  bool SeparatedIn(size_t tet, size_t a, size_t b) const {
    const VertexGroups& groups = kVertexGroups[out_.tet_masks[tet]];
    return groups.group[a] != groups.group[b];
  }
  size_t VertexOf(size_t tet, int32_t node) const {
    const std::array<int32_t, 4>& nodes = mesh_.tets[tet];
    return static_cast<size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
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
        if (SeparatedIn(tet, a, b))
          midpoint_on_boundary_[static_cast<size_t>(EdgeOf(tet, a, b))] = 1;
      }
    }
  }

  // --- Points ---

  int32_t NewPoint(SurfacePoint point) {
    for (size_t i = 0; i < point.node_count; ++i) {
      const Vec3& position = mesh_.rest_positions[static_cast<size_t>(point.nodes[i])];
      for (size_t axis = 0; axis < 3; ++axis) point.rest[axis] += point.weights[i] * position[axis];
    }
    out_.points.push_back(point);
    return static_cast<int32_t>(out_.points.size()) - 1;
  }

  int32_t NodePoint(int32_t node) {
    int32_t& point = node_points_[static_cast<size_t>(node)];
    if (point == kNone) point = NewPoint({{}, {node, -1, -1, -1}, {1, 0, 0, 0}, 1, 1});
    return point;
  }

  // Whether every tet round an edge parts its ends, so that its midpoint has a copy for each.
  bool MidpointSplits(int32_t edge) const {
    const std::span<const int32_t> tets = incidence_.edge_tets[edge];
    const auto [a, b] = incidence_.edges[static_cast<size_t>(edge)];
    return std::all_of(tets.begin(), tets.end(), [&, a = a, b = b](int32_t tet) {
      const auto t = static_cast<size_t>(tet);
      return SeparatedIn(t, VertexOf(t, a), VertexOf(t, b));
    });
  }

  // The midpoint of an edge on the side of one of its ends.
  int32_t Midpoint(int32_t edge, int32_t node) {
    const auto e = static_cast<size_t>(edge);
    const auto [a, b] = incidence_.edges[e];
    if (edge_points_[e] == kNone) {
      SurfacePoint point{{}, {a, b, -1, -1}, {0.5, 0.5, 0, 0}, 2, 0b11};
      if (MidpointSplits(edge)) {
        point.owners = 0b01;
        edge_points_[e] = NewPoint(point);
        point.owners = 0b10;
        NewPoint(point);
      } else {
        edge_points_[e] = NewPoint(point);
      }
    }
    const bool split = !out_.points[static_cast<size_t>(edge_points_[e])].owned_by_all();
    return edge_points_[e] + (split && node == b ? 1 : 0);
  }

  // A face's nodes as the tet with the lower id lists them, and which of them the tets on both
  // sides join or part.
  struct FaceState {
    size_t slot;                       // 4 * tet + face, of the lower tet
    std::array<int32_t, 3> nodes;      // in the order of kTetFaces
    std::array<uint8_t, 3> component;  // of each node: the first node joined to it, in any tet
    std::array<bool, 3> parted;        // edge i, from node i to the next: in any tet
  };
  FaceState StateOf(size_t tet, size_t face) const {
    const int32_t across = faces_.neighbors[tet][face];
    const bool lower = across < 0 || tet < static_cast<size_t>(across / 4);
    FaceState state{lower ? 4 * tet + face : static_cast<size_t>(across), {}, {0, 1, 2}, {}};
    for (size_t i = 0; i < 3; ++i)
      state.nodes[i] = NodeOf(state.slot / 4, static_cast<size_t>(kTetFaces[state.slot % 4][i]));
    ApplyTet(tet, state);
    if (across >= 0) ApplyTet(static_cast<size_t>(across / 4), state);
    return state;
  }
  void ApplyTet(size_t tet, FaceState& state) const {
    for (size_t i = 0; i < 3; ++i) {
      const size_t j = (i + 1) % 3;
      if (SeparatedIn(tet, VertexOf(tet, state.nodes[i]), VertexOf(tet, state.nodes[j]))) {
        state.parted[i] = true;
        continue;
      }
      const uint8_t low = std::min(state.component[i], state.component[j]);
      const uint8_t high = std::max(state.component[i], state.component[j]);
      for (uint8_t& component : state.component) {
        if (component == high) component = low;
      }
    }
  }

  // The point of a face on the side of one of its nodes. Copies lie one after the other, in the
  // order of their first node.
  int32_t FacePoint(const FaceState& state, int32_t node) {
    if (face_points_[state.slot] == kNone) {
      SurfacePoint point{{}, {state.nodes[0], state.nodes[1], state.nodes[2], -1}, {}, 3, 0};
      point.weights = FaceWeights(state);
      face_points_[state.slot] = static_cast<int32_t>(out_.points.size());
      for (uint8_t component = 0; component < 3; ++component) {
        point.owners = 0;
        for (size_t i = 0; i < 3; ++i) {
          if (state.component[i] == component) point.owners |= static_cast<uint8_t>(1u << i);
        }
        if (point.owners != 0) NewPoint(point);
      }
    }
    const size_t i = FaceIndex(state, node);
    int32_t copies_before = 0;
    for (uint8_t other = 0; other < state.component[i]; ++other)
      copies_before += state.component[other] == other ? 1 : 0;
    return face_points_[state.slot] + copies_before;
  }
  static size_t FaceIndex(const FaceState& state, int32_t node) {
    return static_cast<size_t>(std::find(state.nodes.begin(), state.nodes.end(), node) -
                               state.nodes.begin());
  }
  std::array<double, 4> FaceWeights(const FaceState& state) const {
    if (!options_.smooth) return {1 / 3.0, 1 / 3.0, 1 / 3.0, 0};
    const double share =
        0.5 / static_cast<double>(std::count(state.parted.begin(), state.parted.end(), true));
    std::array<double, 4> weights{};
    for (size_t i = 0; i < 3; ++i) {
      if (!state.parted[i]) continue;
      weights[i] += share;
      weights[(i + 1) % 3] += share;
    }
    return weights;
  }

  // The copies of a split tet's own point: one a group of vertices, given for each vertex.
  std::array<int32_t, 4> TetPoints(size_t tet) {
    const VertexGroups& groups = kVertexGroups[out_.tet_masks[tet]];
    SurfacePoint point{{}, mesh_.tets[tet], {0.25, 0.25, 0.25, 0.25}, 4, 0};
    if (options_.smooth) {
      point.weights = {};
      int parted = 0;
      for (const auto& [a, b] : kTetEdges) {
        if (!SeparatedIn(tet, static_cast<size_t>(a), static_cast<size_t>(b))) continue;
        point.weights[static_cast<size_t>(a)] += 0.5;
        point.weights[static_cast<size_t>(b)] += 0.5;
        ++parted;
      }
      for (double& weight : point.weights) weight /= parted;
    }
    std::array<int32_t, 4> points{};
    for (size_t vertex = 0; vertex < 4; ++vertex) {
      const auto first = static_cast<size_t>(groups.group[vertex]);
      if (first != vertex) {
        points[vertex] = points[first];
        continue;
      }
      point.owners = 0;
      for (size_t other = 0; other < 4; ++other) {
        if (groups.group[other] == groups.group[vertex])
          point.owners |= static_cast<uint8_t>(1u << other);
      }
      points[vertex] = NewPoint(point);
    }
    return points;
  }

  // Where both tets of a face part the ends of one of its edges but neither midpoint nor face point
  // splits, four crack faces meet in the segment between the two: each side gets a point of its own
  // on it. Returns that of `node`'s side, or kNone elsewhere.
  int32_t PinchPoint(int32_t edge, int32_t midpoint, const FaceState& state, int32_t face_point,
                     size_t tet, size_t face, int32_t node) {
    if (!out_.points[static_cast<size_t>(midpoint)].owned_by_all()) return kNone;
    const auto [a, b] = incidence_.edges[static_cast<size_t>(edge)];
    const size_t i = FaceIndex(state, a);
    const size_t j = FaceIndex(state, b);
    const int32_t across = faces_.neighbors[tet][face];
    if (state.component[i] != state.component[j] || across < 0) return kNone;
    const auto other = static_cast<size_t>(across / 4);
    if (!SeparatedIn(other, VertexOf(other, a), VertexOf(other, b))) return kNone;

    const uint64_t key = 3 * state.slot + (3 - i - j);  // the face, and which of its edges
    const auto [entry, is_new] = pinch_points_.try_emplace(key, 0);
    if (is_new) {
      SurfacePoint point = out_.points[static_cast<size_t>(face_point)];
      point.rest = {};
      for (double& weight : point.weights) weight /= 2;
      point.weights[i] += 0.25;
      point.weights[j] += 0.25;
      entry->second = NewPoint(point);
      NewPoint(point);
    }
    return entry->second + (node == b ? 1 : 0);
  }

  // --- Triangles ---

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
      split |= SeparatedIn(tet, corners[i], corners[(i + 1) % 3]);
    }
    if (midpoints == 0) {
      AddTriangle(NodePoint(nodes[0]), NodePoint(nodes[1]), NodePoint(nodes[2]), tet, nodes[0],
                  false);
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
      middle[i] = has ? Midpoint(edges[i], nodes[i]) : kNone;
      if (has && first == 3) first = i;
    }
    Polygon polygon;
    polygon.Add(middle[first]);
    for (size_t step = 1; step <= 3; ++step) {
      const size_t i = (first + step) % 3;
      const int32_t corner = NodePoint(nodes[i]);
      const int32_t before = middle[(i + 2) % 3];
      const int32_t after = middle[i];
      if (before != kNone && after != kNone) {
        AddTriangle(before, corner, after, tet, nodes[0], false);
      } else {
        polygon.Add(corner);
      }
      if (step < 3 && after != kNone) polygon.Add(after);
    }
    AddFan(polygon, tet, nodes[0], false);
  }

  // A boundary face with parted corners: a polygon for each group of them, round the face point.
  void AddSplitFace(size_t tet, size_t face, const std::array<size_t, 3>& corners,
                    const std::array<int32_t, 3>& nodes, const std::array<int32_t, 3>& edges) {
    const FaceState state = StateOf(tet, face);
    for (size_t i = 0; i < 3; ++i) {
      const size_t before = (i + 2) % 3;
      if (!SeparatedIn(tet, corners[before], corners[i])) continue;
      // Corner i begins a group; walk on until the next parted edge.
      Polygon polygon;
      polygon.Add(FacePoint(state, nodes[i]));
      polygon.Add(Midpoint(edges[before], nodes[i]));
      for (size_t at = i;; at = (at + 1) % 3) {
        polygon.Add(NodePoint(nodes[at]));
        const bool parted = SeparatedIn(tet, corners[at], corners[(at + 1) % 3]);
        if (parted || midpoint_on_boundary_[static_cast<size_t>(edges[at])] != 0)
          polygon.Add(Midpoint(edges[at], nodes[at]));
        if (parted) break;
      }
      AddFan(polygon, tet, nodes[i], false);
    }
  }

  // The crack faces inside a split tet: across each parted edge, one towards either end.
  void AddCracks(size_t tet) {
    const std::array<int32_t, 4> tet_points = TetPoints(tet);
    std::array<FaceState, 4> states{};
    for (size_t face = 0; face < 4; ++face) states[face] = StateOf(tet, face);
    for (size_t k = 0; k < 6; ++k) {
      const std::array<size_t, 2> ends{static_cast<size_t>(kTetEdges[k][0]),
                                       static_cast<size_t>(kTetEdges[k][1])};
      if (!SeparatedIn(tet, ends[0], ends[1])) continue;
      const int32_t edge = incidence_.tet_edges[tet][k];
      for (size_t side = 0; side < 2; ++side) {
        const int32_t node = NodeOf(tet, ends[side]);
        const int32_t midpoint = Midpoint(edge, node);
        // Midpoint, first face, tet point and second face turn anticlockwise seen from the other
        // end of the edge, which is outside of this one's cell.
        const size_t first_face = kAcrossEdge[k][side == 0 ? 1 : 0];
        const size_t second_face = kAcrossEdge[k][side == 0 ? 0 : 1];
        const int32_t first = FacePoint(states[first_face], node);
        const int32_t second = FacePoint(states[second_face], node);
        const int32_t first_pinch =
            PinchPoint(edge, midpoint, states[first_face], first, tet, first_face, node);
        const int32_t second_pinch =
            PinchPoint(edge, midpoint, states[second_face], second, tet, second_face, node);
        Polygon polygon;
        polygon.Add(tet_points[ends[side]]);
        polygon.Add(second);
        if (second_pinch != kNone) polygon.Add(second_pinch);
        polygon.Add(midpoint);
        if (first_pinch != kNone) polygon.Add(first_pinch);
        polygon.Add(first);
        AddFan(polygon, tet, node, true);
      }
    }
  }

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const Faces& faces_;
  const SurfaceOptions options_;
  SurfaceTopology out_;
  std::vector<int32_t> node_points_;           // a node each
  std::vector<int32_t> edge_points_;           // the first copy, an edge each
  std::vector<int32_t> face_points_;           // the first copy, at the lower tet's 4 * tet + face
  std::vector<uint8_t> midpoint_on_boundary_;  // an edge each
  std::unordered_map<uint64_t, int32_t> pinch_points_;
};

}  // namespace

SurfaceTopology ExtractSurface(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                               std::span<const int32_t> broken_edges,
                               const SurfaceOptions& options) {
  return Extraction(mesh, incidence, faces, broken_edges, options).Run();
}

}  // namespace cleave
