#include "core/surface/embedded_mesh.h"

#include <algorithm>
#include <utility>

#include "core/surface/parted_edges.h"

namespace cleave {
namespace {

void SortUnique(std::vector<int32_t>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

}  // namespace

EmbeddedMesh::EmbeddedMesh(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                           RenderMesh render)
    : mesh_(mesh),
      incidence_(incidence),
      faces_(faces),
      divided_(mesh, incidence, faces, std::move(render)),
      hubs_(mesh, faces, divided_),
      is_parted_(incidence.edges.size(), 0),
      copies_(mesh, incidence, faces, false, out_) {
  BindTriangles();
  BindGaps();
  out_.tet_masks.assign(mesh.tets.size(), 0);
  const RenderMesh& whole = divided_.mesh();
  for (size_t point = 0; point < whole.points.size(); ++point) {
    const PlaceInTet& place = divided_.place(point);
    out_.points.push_back(
        {whole.points[point], mesh.tets[static_cast<size_t>(place.tet)], place.weights, 4, 0b1111});
    out_.point_ids.push_back(surface_id::OfRenderPoint(point));
  }
  out_.triangles = whole.triangles;
  uvs_ = whole.uvs;
  for (size_t i = 0; i < whole.triangles.size(); ++i) {
    const auto first = static_cast<size_t>(whole.triangles[i][0]);
    out_.triangle_ids.push_back(surface_id::OfRenderOuter(i, 0b111));
    out_.nodes.push_back(divided_.label(first));
    out_.tets.push_back(divided_.place(first).tet);
    out_.inside.push_back(0);
    sources_.push_back(divided_.source(i));
  }
}

void EmbeddedMesh::BindTriangles() {
  for (const auto& [from, to] : divided_.edges()) {
    const int32_t a = divided_.label(static_cast<size_t>(from));
    const int32_t b = divided_.label(static_cast<size_t>(to));
    const int32_t found = a == b ? kSameNode : divided_.FindEdge(a, b);
    body_edges_.push_back(a != b && found < 0 ? kNoEdge : found);
  }
  for (size_t i = 0; i < divided_.mesh().triangles.size(); ++i) {
    const Triple nodes = divided_.LabelsOf(i);
    const bool are_three = AreThree(nodes);
    triangle_faces_.push_back(are_three ? divided_.FindFace(nodes) : -1);
    bool is_loose = are_three && triangle_faces_.back() < 0;
    for (size_t k = 0; k < 3; ++k) {
      const int32_t edge = body_edges_[EdgeAt(i, k)];
      is_loose |= edge == kNoEdge;
      if (edge >= 0) edge_triangles_.push_back({edge, static_cast<int32_t>(i)});
    }
    if (is_loose) loose_.push_back(static_cast<int32_t>(i));
  }
  std::sort(edge_triangles_.begin(), edge_triangles_.end());
  const size_t points = divided_.mesh().points.size();
  std::vector<int32_t>& offsets = tet_points_.offsets;
  offsets.assign(mesh_.tets.size() + 1, 0);
  for (size_t point = 0; point < points; ++point)
    ++offsets[static_cast<size_t>(divided_.place(point).tet) + 1];
  for (size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  std::vector<int32_t> next(offsets.begin(), offsets.end() - 1);
  tet_points_.items.resize(points);
  for (size_t point = 0; point < points; ++point) {
    int32_t& at = next[static_cast<size_t>(divided_.place(point).tet)];
    tet_points_.items[static_cast<size_t>(at++)] = static_cast<int32_t>(point);
  }
}

int32_t EmbeddedMesh::NodeAt(size_t triangle, size_t k) const {
  return divided_.label(static_cast<size_t>(divided_.mesh().triangles[triangle][k]));
}

size_t EmbeddedMesh::EdgeAt(size_t triangle, size_t k) const {
  return static_cast<size_t>(divided_.triangle_edges(triangle)[k]);
}

bool EmbeddedMesh::IsCut(size_t edge) const {
  const int32_t of_body = body_edges_[edge];
  return of_body >= 0 ? is_parted_[static_cast<size_t>(of_body)] != 0 : IsSplit(edge);
}

bool EmbeddedMesh::IsSplit(size_t edge) const {
  const auto [from, to] = divided_.edges()[edge];
  return IsSplit(body_edges_[edge], divided_.label(static_cast<size_t>(from)),
                 divided_.label(static_cast<size_t>(to)));
}

bool EmbeddedMesh::IsSplit(int32_t body_edge, int32_t a, int32_t b) const {
  if (body_edge == kSameNode) return false;
  if (body_edge != kNoEdge) return copies_.Splits(body_edge);
  return pieces_->piece_of(a) != pieces_->piece_of(b);
}

EmbeddedMesh::Parting EmbeddedMesh::PartingOf(size_t triangle) const {
  const Triple& edges = divided_.triangle_edges(triangle);
  Triple body_edges{};
  for (size_t k = 0; k < 3; ++k) body_edges[k] = body_edges_[static_cast<size_t>(edges[k])];
  return PartingOf(divided_.LabelsOf(triangle), body_edges, triangle_faces_[triangle]);
}

EmbeddedMesh::Parting EmbeddedMesh::PartingOf(const Triple& nodes, const Triple& body_edges,
                                              int64_t face) const {
  Parting parting;
  const auto splits = [&](size_t k) {
    return IsSplit(body_edges[k], nodes[k], nodes[(k + 1) % 3]);
  };
  if (face < 0) {
    for (size_t k = 0; k < 3; ++k) {
      parting.open[k] = splits(k);
      if (parting.open[k]) continue;
      const auto [low, high] = std::minmax({parting.component[k], parting.component[(k + 1) % 3]});
      for (uint8_t& component : parting.component) {
        if (component == high) component = low;
      }
    }
    return parting;
  }
  const auto tet = static_cast<size_t>(face / 4);
  const int32_t across = faces_.neighbors[tet][static_cast<size_t>(face % 4)];
  const FaceState state = copies_.StateOf(tet, static_cast<size_t>(face % 4));
  for (size_t k = 0; k < 3; ++k) parting.component[k] = state.component[state.IndexOf(nodes[k])];
  for (size_t k = 0; k < 3; ++k) {
    const size_t next = (k + 1) % 3;
    const int32_t a = nodes[k];
    const int32_t b = nodes[next];
    parting.open[k] = copies_.PartsNodes(tet, a, b) &&
                      (across < 0 || copies_.PartsNodes(static_cast<size_t>(across / 4), a, b)) &&
                      // Else all of its points are whole: two faces on each other.
                      (parting.component[k] != parting.component[next] || splits(k));
  }
  return parting;
}

int32_t EmbeddedMesh::Put(SurfaceId id, const SurfacePoint& point) {
  const auto [entry, is_new] = points_.try_emplace(id, static_cast<int32_t>(out_.points.size()));
  if (is_new) {
    out_.points.emplace_back();
    out_.point_ids.push_back(id);
  }
  out_.points[static_cast<size_t>(entry->second)] = point;
  return entry->second;
}

int32_t EmbeddedMesh::EdgePoint(size_t edge, int32_t node) {
  const int32_t a = divided_.label(static_cast<size_t>(divided_.edges()[edge][0]));
  const int32_t b = divided_.label(static_cast<size_t>(divided_.edges()[edge][1]));
  const bool splits = IsSplit(edge);
  const size_t side = splits && node == b ? 1 : 0;
  const auto owners = static_cast<uint8_t>(splits ? 1u << side : 0b11u);
  return Put(surface_id::OfRenderEdge(edge, side),
             {divided_.CutAt(edge), {a, b, -1, -1}, {0.5, 0.5, 0, 0}, 2, owners, true});
}

int32_t EmbeddedMesh::MiddlePoint(size_t triangle, const Parting& parting, size_t corner) {
  SurfacePoint point{{}, {-1, -1, -1, -1}, {1 / 3.0, 1 / 3.0, 1 / 3.0, 0}, 3, 0, true};
  for (size_t k = 0; k < 3; ++k) {
    const Vec3 cut = divided_.CutAt(EdgeAt(triangle, k));
    for (size_t axis = 0; axis < 3; ++axis) point.rest[axis] += cut[axis] / 3;
    point.nodes[k] = NodeAt(triangle, k);
    if (parting.component[k] == parting.component[corner])
      point.owners |= static_cast<uint8_t>(1u << k);
  }
  return Put(surface_id::OfRenderMiddle(triangle, parting.component[corner]), point);
}

int32_t EmbeddedMesh::PairPointOf(int32_t body_edge, int32_t node) {
  const int32_t at = copies_.Midpoint(body_edge, node);
  const auto [a, b] = incidence_.edges[static_cast<size_t>(body_edge)];
  if (const RenderHubs::Hub* hub = hubs_.Find(a, b)) {
    out_.points[static_cast<size_t>(at)].rest = hub->place();
    out_.points[static_cast<size_t>(at)].off_nodes = true;
  }
  return at;
}

int32_t EmbeddedMesh::PairPoint(int32_t body_edge, int32_t node, int32_t other) {
  if (body_edge >= 0) return PairPointOf(body_edge, node);
  const auto [low, high] = std::minmax({node, other});
  const size_t side = node == high ? 1 : 0;
  return Put(surface_id::OfLoosePair(static_cast<size_t>(hubs_.IndexOf(low, high)), side),
             {hubs_.Find(low, high)->place(),
              {low, high, -1, -1},
              {0.5, 0.5, 0, 0},
              2,
              static_cast<uint8_t>(1u << side),
              true});
}

int32_t EmbeddedMesh::FacePointOf(const FaceState& state, int32_t node) {
  const int32_t at = copies_.FacePoint(state, node);
  if (const RenderHubs::Hub* hub = hubs_.Find(state.nodes)) {
    out_.points[static_cast<size_t>(at)].rest = hub->place();
    out_.points[static_cast<size_t>(at)].off_nodes = true;
  }
  return at;
}

int32_t EmbeddedMesh::TriplePoint(const Triple& turned, int64_t face, const Parting& parting,
                                  size_t corner) {
  if (face >= 0) {
    return FacePointOf(
        copies_.StateOf(static_cast<size_t>(face / 4), static_cast<size_t>(face % 4)),
        turned[corner]);
  }
  Triple nodes = turned;
  std::sort(nodes.begin(), nodes.end());
  SurfacePoint point{hubs_.Find(nodes)->place(),
                     {nodes[0], nodes[1], nodes[2], -1},
                     {1 / 3.0, 1 / 3.0, 1 / 3.0, 0},
                     3,
                     0,
                     true};
  size_t first = 3;
  for (size_t k = 0; k < 3; ++k) {
    if (parting.component[k] != parting.component[corner]) continue;
    const auto place =
        static_cast<size_t>(std::find(nodes.begin(), nodes.end(), turned[k]) - nodes.begin());
    point.owners |= static_cast<uint8_t>(1u << place);
    first = std::min(first, place);
  }
  return Put(surface_id::OfLooseTriple(static_cast<size_t>(hubs_.IndexOf(nodes)), first), point);
}

int64_t EmbeddedMesh::Break(std::span<const int32_t> edges, const NamedPieces& pieces) {
  pieces_ = &pieces;
  BreakInTets(incidence_, edges, out_.tet_masks, parted_);
  for (const int32_t edge : parted_) {
    copies_.UpdateEdge(edge);
    is_parted_[static_cast<size_t>(edge)] = 1;
  }
  touched_ = loose_;
  for (const int32_t edge : parted_) {
    auto at = std::lower_bound(edge_triangles_.begin(), edge_triangles_.end(),
                               std::array<int32_t, 2>{edge, 0});
    for (; at != edge_triangles_.end() && (*at)[0] == edge; ++at) touched_.push_back((*at)[1]);
  }
  SortUnique(touched_);
  for (const int32_t triangle : touched_) CutTriangle(static_cast<size_t>(triangle));
  auto made = static_cast<int64_t>(touched_.size());
  touched_.clear();
  for (const int32_t edge : parted_) {
    const std::span<const int32_t> tets = incidence_.edge_tets[edge];
    touched_.insert(touched_.end(), tets.begin(), tets.end());
  }
  SortUnique(touched_);
  for (const int32_t touched : touched_) {
    const auto tet = static_cast<size_t>(touched);
    const EdgeMask mask = out_.tet_masks[tet];
    const std::array<int32_t, 4>& nodes = mesh_.tets[tet];
    for (const int32_t point : tet_points_[touched]) {
      const int32_t own = divided_.label(static_cast<size_t>(point));
      const auto vertex =
          static_cast<size_t>(std::find(nodes.begin(), nodes.end(), own) - nodes.begin());
      uint8_t& owners = out_.points[static_cast<size_t>(point)].owners;
      owners = 0;
      for (size_t k = 0; k < 4; ++k) {
        if (kVertexGroups[mask].group[k] == kVertexGroups[mask].group[vertex])
          owners |= static_cast<uint8_t>(1u << k);
      }
    }
    if (hubs_.inside(tet) != 0 && Separated(mask)) CutTet(tet);
  }
  made += static_cast<int64_t>(touched_.size()) + CapGaps();
  pieces_ = nullptr;
  return made;
}

}  // namespace cleave
