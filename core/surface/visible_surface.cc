#include "core/surface/visible_surface.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "core/surface/parted_edges.h"

namespace cleave {
namespace {

// The edge between two vertices of a tet.
constexpr std::array<std::array<size_t, 4>, 4> kEdgeBetween = {
    {{6, 0, 1, 2}, {0, 6, 3, 4}, {1, 3, 6, 5}, {2, 4, 5, 6}}};

// Corners of a boundary face, as in surface_id::OfOuter.
constexpr size_t kMiddle = 3;
constexpr size_t kFacePoint = 6;

}  // namespace

VisibleSurface::VisibleSurface(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                               const SurfaceOptions& options)
    : mesh_(mesh),
      incidence_(incidence),
      faces_(faces),
      copies_(mesh, incidence, faces, options.smooth, out_),
      midpoint_on_boundary_(incidence.edges.size(), 0),
      crack_heads_(mesh.tets.size(), -1),
      outer_heads_(faces.boundary.size(), -1),
      is_touched_(mesh.tets.size(), 0) {
  out_.tet_masks.assign(mesh.tets.size(), 0);
  for (const TetFace& side : faces.boundary)
    AddBoundaryFace(static_cast<size_t>(side.tet), static_cast<size_t>(side.face));
}

int32_t VisibleSurface::EdgeOf(size_t tet, size_t a, size_t b) const {
  return incidence_.tet_edges[tet][kEdgeBetween[a][b]];
}

size_t VisibleSurface::BoundaryIndex(size_t face) const {
  const auto found = std::lower_bound(
      faces_.boundary.begin(), faces_.boundary.end(), face, [](const TetFace& side, size_t wanted) {
        return 4 * static_cast<size_t>(side.tet) + static_cast<size_t>(side.face) < wanted;
      });
  return static_cast<size_t>(found - faces_.boundary.begin());
}

int32_t& VisibleSurface::HeadOf(size_t triangle) {
  if (out_.inside[triangle] != 0) return crack_heads_[static_cast<size_t>(out_.tets[triangle])];
  return outer_heads_[BoundaryIndex(surface_id::PartOf(out_.triangle_ids[triangle]))];
}

int64_t VisibleSurface::Break(std::span<const int32_t> edges) {
  BreakInTets(incidence_, edges, out_.tet_masks, parted_);
  if (parted_.empty()) return 0;
  for (const int32_t edge : parted_) copies_.UpdateEdge(edge);
  FindTouched();
  FindPinches();
  pinch_stays_.assign(pinches_.size(), 0);
  int64_t made = 0;
  for (const int32_t touched : touched_) {
    const auto tet = static_cast<size_t>(touched);
    for (size_t face = 0; face < 4; ++face) {
      if (faces_.neighbors[tet][face] >= 0) continue;
      AddBoundaryFace(tet, face);
      ++made;
    }
    if (!Separated(out_.tet_masks[tet])) continue;
    AddCracks(tet);
    ++made;
  }
  // The last first, so that what moves into a gap stays.
  std::sort(left_over_.begin(), left_over_.end());
  for (; !left_over_.empty(); left_over_.pop_back()) RemoveTriangle(left_over_.back());
  for (size_t i = 0; i < pinches_.size(); ++i) {
    if (pinch_stays_[i] == 0) RemovePoint(pinches_[i]);
  }
  return made;
}

void VisibleSurface::FindTouched() {
  touched_.clear();
  for (const int32_t edge : parted_) {
    const auto [a, b] = incidence_.edges[static_cast<size_t>(edge)];
    for (const int32_t around : incidence_.edge_tets[edge]) {
      const auto tet = static_cast<size_t>(around);
      if (is_touched_[tet] == 0) touched_.push_back(around);
      is_touched_[tet] = 1;
      // A boundary edge whose ends are parted on some boundary face: all boundary faces there need
      // the midpoint, lest an unsplit one meet a split one in a T-junction.
      for (size_t face = 0; face < 4; ++face) {
        const bool has_edge = NodeOf(tet, face) != a && NodeOf(tet, face) != b;
        if (!has_edge || faces_.neighbors[tet][face] >= 0) continue;
        for (size_t k = 0; k < 6; ++k) {
          if (incidence_.tet_edges[tet][k] == edge && PartsEdge(out_.tet_masks[tet], k))
            midpoint_on_boundary_[static_cast<size_t>(edge)] = 1;
        }
      }
    }
  }
  std::sort(touched_.begin(), touched_.end());
  for (const int32_t tet : touched_) is_touched_[static_cast<size_t>(tet)] = 0;
}

void VisibleSurface::FindPinches() {
  pinches_.clear();
  if (!copies_.has_pinch_points()) return;
  for (const int32_t touched : touched_) {
    const auto tet = static_cast<size_t>(touched);
    if (crack_heads_[tet] < 0) continue;
    for (size_t face = 0; face < 4; ++face) {
      const int32_t across = faces_.neighbors[tet][face];
      if (across < 0) continue;
      const size_t slot = std::min(4 * tet + face, static_cast<size_t>(across));
      for (size_t i = 0; i < 3; ++i) {
        for (size_t side = 0; side < 2; ++side) {
          const SurfaceId id = surface_id::OfPinch(slot, i, side);
          if (copies_.Find(id) >= 0) pinches_.push_back(id);
        }
      }
    }
  }
  std::sort(pinches_.begin(), pinches_.end());
  pinches_.erase(std::unique(pinches_.begin(), pinches_.end()), pinches_.end());
}

void VisibleSurface::Begin(int32_t& head) {
  head_ = &head;
  old_.clear();
  for (int32_t at = head; at >= 0; at = next_[static_cast<size_t>(at)]) old_.push_back(at);
  // The lowest place is taken first, so that what does not change stays.
  std::sort(old_.begin(), old_.end(), std::greater<>());
  head = -1;
}

void VisibleSurface::End() {
  left_over_.insert(left_over_.end(), old_.begin(), old_.end());
  old_.clear();
}

void VisibleSurface::AddTriangle(SurfaceId id, int32_t a, int32_t b, int32_t c, size_t tet,
                                 int32_t node, bool inside) {
  size_t at = out_.triangles.size();
  if (old_.empty()) {
    out_.triangles.emplace_back();
    out_.triangle_ids.emplace_back();
    out_.nodes.emplace_back();
    out_.tets.emplace_back();
    out_.inside.emplace_back();
    next_.emplace_back();
  } else {
    at = static_cast<size_t>(old_.back());
    old_.pop_back();
  }
  out_.triangles[at] = {a, b, c};
  out_.triangle_ids[at] = id;
  out_.nodes[at] = node;
  out_.tets[at] = static_cast<int32_t>(tet);
  out_.inside[at] = inside ? 1 : 0;
  next_[at] = *head_;
  *head_ = static_cast<int32_t>(at);
}

void VisibleSurface::AddFan(const Polygon& polygon, size_t face, int32_t node) {
  for (size_t i = 1; i + 1 < polygon.size; ++i) {
    const unsigned corners =
        1u << polygon.corners[0] | 1u << polygon.corners[i] | 1u << polygon.corners[i + 1];
    AddTriangle(surface_id::OfOuter(face, corners), polygon.points[0], polygon.points[i],
                polygon.points[i + 1], face / 4, node, false);
  }
}

void VisibleSurface::AddBoundaryFace(size_t tet, size_t face) {
  std::array<int32_t, 3> nodes{};
  std::array<int32_t, 3> edges{};  // edge i: from corner i to the next
  size_t midpoints = 0;
  bool split = false;
  for (size_t i = 0; i < 3; ++i) {
    const auto a = static_cast<size_t>(kTetFaces[face][i]);
    const auto b = static_cast<size_t>(kTetFaces[face][(i + 1) % 3]);
    nodes[i] = NodeOf(tet, a);
    edges[i] = EdgeOf(tet, a, b);
    midpoints += midpoint_on_boundary_[static_cast<size_t>(edges[i])];
    split |= copies_.Parts(tet, a, b);
  }
  Begin(outer_heads_[BoundaryIndex(4 * tet + face)]);
  if (midpoints == 0) {
    AddTriangle(surface_id::OfOuter(4 * tet + face, 0b111), copies_.NodePoint(nodes[0]),
                copies_.NodePoint(nodes[1]), copies_.NodePoint(nodes[2]), tet, nodes[0], false);
  } else if (split) {
    AddSplitFace(tet, face, nodes, edges);
  } else {
    AddFaceWithMidpoints(tet, face, nodes, edges);
  }
  End();
}

// A boundary face whose corners are all joined but some of whose neighbours are split.
void VisibleSurface::AddFaceWithMidpoints(size_t tet, size_t face,
                                          const std::array<int32_t, 3>& nodes,
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
  polygon.Add(middle[first], kMiddle + first);
  for (size_t step = 1; step <= 3; ++step) {
    const size_t i = (first + step) % 3;
    const size_t last = (i + 2) % 3;
    const int32_t corner = copies_.NodePoint(nodes[i]);
    if (middle[last] >= 0 && middle[i] >= 0) {
      const unsigned corners = 1u << (kMiddle + last) | 1u << i | 1u << (kMiddle + i);
      AddTriangle(surface_id::OfOuter(4 * tet + face, corners), middle[last], corner, middle[i],
                  tet, nodes[0], false);
    } else {
      polygon.Add(corner, i);
    }
    if (step < 3 && middle[i] >= 0) polygon.Add(middle[i], kMiddle + i);
  }
  AddFan(polygon, 4 * tet + face, nodes[0]);
}

// A boundary face with parted corners: a polygon for each group of them, round the face point.
void VisibleSurface::AddSplitFace(size_t tet, size_t face, const std::array<int32_t, 3>& nodes,
                                  const std::array<int32_t, 3>& edges) {
  const FaceState state = copies_.StateOf(tet, face);
  for (size_t i = 0; i < 3; ++i) {
    const size_t before = (i + 2) % 3;
    if (!state.parted[before]) continue;
    // Corner i begins a group; walk on until the next parted edge.
    Polygon polygon;
    polygon.Add(copies_.FacePoint(state, nodes[i]), kFacePoint);
    polygon.Add(copies_.Midpoint(edges[before], nodes[i]), kMiddle + before);
    for (size_t at = i;; at = (at + 1) % 3) {
      polygon.Add(copies_.NodePoint(nodes[at]), at);
      const bool parted = state.parted[at];
      if (parted || midpoint_on_boundary_[static_cast<size_t>(edges[at])] != 0)
        polygon.Add(copies_.Midpoint(edges[at], nodes[at]), kMiddle + at);
      if (parted) break;
    }
    AddFan(polygon, 4 * tet + face, nodes[i]);
  }
}

// The crack faces inside a split tet: across each parted edge, one towards either end.
void VisibleSurface::AddCracks(size_t tet) {
  const std::array<int32_t, 4> tet_points = copies_.TetPoints(tet);
  std::array<FaceState, 4> states{};
  for (size_t face = 0; face < 4; ++face) states[face] = copies_.StateOf(tet, face);
  std::array<std::array<int32_t, 3>, 4> face_points{};  // by face and component
  for (auto& points : face_points) points.fill(-1);
  Begin(crack_heads_[tet]);
  for (size_t k = 0; k < 6; ++k) {
    if (!PartsEdge(out_.tet_masks[tet], k)) continue;
    const int32_t edge = incidence_.tet_edges[tet][k];
    for (size_t side = 0; side < 2; ++side) {
      const auto end = static_cast<size_t>(kTetEdges[k][side]);
      const int32_t node = NodeOf(tet, end);
      const int32_t middle = copies_.Midpoint(edge, node);
      // Tet point, second face, midpoint and first face turn anticlockwise seen from the other end
      // of the edge, which is outside of this one's cell.
      for (size_t half = 0; half < 2; ++half) {
        const size_t face = kAcrossEdge[k][half == side ? 0 : 1];
        const uint8_t component = states[face].component[states[face].IndexOf(node)];
        int32_t& face_point = face_points[face][component];
        if (face_point < 0) face_point = copies_.FacePointOf(states[face], component);
        const int32_t pinch = copies_.PinchPoint(tet, face, states[face], edge, node);
        const auto add = [&](size_t share, int32_t from, int32_t to) {
          if (half != 0) std::swap(from, to);
          AddTriangle(surface_id::OfCrack(tet, k, side, half, share), tet_points[end], from, to,
                      tet, node, true);
        };
        if (pinch < 0) {
          add(0, face_point, middle);
          continue;
        }
        add(1, face_point, pinch);
        add(2, pinch, middle);
        const auto known = std::lower_bound(pinches_.begin(), pinches_.end(),
                                            out_.point_ids[static_cast<size_t>(pinch)]);
        if (known != pinches_.end() && *known == out_.point_ids[static_cast<size_t>(pinch)])
          pinch_stays_[static_cast<size_t>(known - pinches_.begin())] = 1;
      }
    }
  }
  End();
}

void VisibleSurface::RemoveTriangle(int32_t triangle) {
  const auto gap = static_cast<size_t>(triangle);
  const size_t last = out_.triangles.size() - 1;
  if (gap != last) {
    int32_t* link = &HeadOf(last);
    while (*link != static_cast<int32_t>(last)) link = &next_[static_cast<size_t>(*link)];
    *link = triangle;
    out_.triangles[gap] = out_.triangles[last];
    out_.triangle_ids[gap] = out_.triangle_ids[last];
    out_.nodes[gap] = out_.nodes[last];
    out_.tets[gap] = out_.tets[last];
    out_.inside[gap] = out_.inside[last];
    next_[gap] = next_[last];
  }
  out_.triangles.pop_back();
  out_.triangle_ids.pop_back();
  out_.nodes.pop_back();
  out_.tets.pop_back();
  out_.inside.pop_back();
  next_.pop_back();
}

template <typename Visit>
void VisibleSurface::ForTrianglesOf(size_t tet, const Visit& visit) {
  for (int32_t at = crack_heads_[tet]; at >= 0; at = next_[static_cast<size_t>(at)])
    visit(static_cast<size_t>(at));
  for (size_t face = 0; face < 4; ++face) {
    if (faces_.neighbors[tet][face] >= 0) continue;
    const int32_t head = outer_heads_[BoundaryIndex(4 * tet + face)];
    for (int32_t at = head; at >= 0; at = next_[static_cast<size_t>(at)])
      visit(static_cast<size_t>(at));
  }
}

void VisibleSurface::RemovePoint(SurfaceId id) {
  const int32_t gap = copies_.Find(id);
  const auto last = static_cast<int32_t>(out_.points.size()) - 1;
  copies_.Place(id, -1);
  if (gap != last) {
    const SurfaceId moved = out_.point_ids.back();
    out_.points[static_cast<size_t>(gap)] = out_.points.back();
    out_.point_ids[static_cast<size_t>(gap)] = moved;
    copies_.Place(moved, gap);
    const auto renumber = [&](size_t triangle) {
      for (int32_t& point : out_.triangles[triangle]) {
        if (point == last) point = gap;
      }
    };
    const auto part = static_cast<size_t>(surface_id::PartOf(moved));
    switch (surface_id::KindOf(moved)) {
      case surface_id::kNode:
        for (const int32_t tet : incidence_.node_tets[static_cast<int64_t>(part)])
          ForTrianglesOf(static_cast<size_t>(tet), renumber);
        break;
      case surface_id::kEdge:
        for (const int32_t tet : incidence_.edge_tets[static_cast<int64_t>(part)])
          ForTrianglesOf(static_cast<size_t>(tet), renumber);
        break;
      case surface_id::kTet:
        ForTrianglesOf(part, renumber);
        break;
      default: {  // on a face
        ForTrianglesOf(part / 4, renumber);
        const int32_t across = faces_.neighbors[part / 4][part % 4];
        if (across >= 0) ForTrianglesOf(static_cast<size_t>(across / 4), renumber);
        break;
      }
    }
  }
  out_.points.pop_back();
  out_.point_ids.pop_back();
}

SurfaceTopology ExtractSurface(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                               std::span<const int32_t> broken_edges,
                               const SurfaceOptions& options) {
  VisibleSurface surface(mesh, incidence, faces, options);
  surface.Break(broken_edges);
  return surface.topology();
}

}  // namespace cleave
