// What EmbeddedMesh draws of triangles and tets that are cut.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "core/surface/embedded_mesh.h"
#include "core/surface/parted_edges.h"

namespace cleave {
namespace {

// Corner::place.
constexpr unsigned kCut = 3;
constexpr unsigned kMiddle = 6;

std::array<float, 2> Mix(const std::array<float, 2>& a, const std::array<float, 2>& b,
                         double share) {
  const auto s = static_cast<float>(share);
  return {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])};
}

}  // namespace

void EmbeddedMesh::Begin(std::vector<int32_t>& slots) {
  slots_ = &slots;
  used_ = 0;
}

// What a triangle or tet is made of only grows, so places are never left over.
void EmbeddedMesh::AddTriangle(SurfaceId id, int32_t a, int32_t b, int32_t c, size_t tet,
                               int32_t node, int32_t source) {
  if (used_ == slots_->size()) {
    slots_->push_back(static_cast<int32_t>(out_.triangles.size()));
    out_.triangles.emplace_back();
    out_.triangle_ids.emplace_back();
    out_.nodes.emplace_back();
    out_.tets.emplace_back();
    out_.inside.emplace_back();
    sources_.emplace_back();
    if (!divided_.mesh().uvs.empty()) uvs_.emplace_back();
  }
  const auto at = static_cast<size_t>((*slots_)[used_++]);
  out_.triangles[at] = {a, b, c};
  out_.triangle_ids[at] = id;
  out_.nodes[at] = node;
  out_.tets[at] = static_cast<int32_t>(tet);
  out_.inside[at] = source < 0 ? 1 : 0;
  sources_[at] = source;
  if (!uvs_.empty()) uvs_[at] = {};
}

void EmbeddedMesh::AddFan(std::span<const Corner> polygon, size_t triangle, int32_t node) {
  const auto first = static_cast<size_t>(divided_.mesh().triangles[triangle][0]);
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    const unsigned places =
        1u << polygon[0].place | 1u << polygon[i].place | 1u << polygon[i + 1].place;
    AddTriangle(surface_id::OfRenderOuter(triangle, places), polygon[0].point, polygon[i].point,
                polygon[i + 1].point, static_cast<size_t>(divided_.place(first).tet), node,
                divided_.source(triangle));
    if (uvs_.empty()) continue;
    uvs_[static_cast<size_t>((*slots_)[used_ - 1])] = {polygon[0].uv, polygon[i].uv,
                                                       polygon[i + 1].uv};
  }
}

void EmbeddedMesh::CutTriangle(size_t triangle) {
  const RenderMesh& whole = divided_.mesh();
  bool is_cut = false;
  for (size_t k = 0; k < 3; ++k) is_cut |= IsCut(EdgeAt(triangle, k));
  if (!is_cut) return;
  const auto own = static_cast<int32_t>(triangle);
  Begin(triangle_slots_.try_emplace(own, std::vector<int32_t>{own}).first->second);
  const CornerUvs uvs = whole.uvs.empty() ? CornerUvs{} : whole.uvs[triangle];
  std::array<Corner, 3> corners{};
  std::array<std::array<float, 2>, 3> cut_uvs{};
  for (size_t k = 0; k < 3; ++k) {
    corners[k] = {whole.triangles[triangle][k], uvs[k], static_cast<unsigned>(k)};
    const size_t edge = EdgeAt(triangle, k);
    const double share = divided_.CutShare(edge);
    const bool runs_on = divided_.edges()[edge][0] == corners[k].point;
    cut_uvs[k] = Mix(uvs[k], uvs[(k + 1) % 3], runs_on ? share : 1 - share);
  }
  if (AreThree(divided_.LabelsOf(triangle))) {
    CutBetween(triangle, corners, cut_uvs);
  } else {
    CutAcross(triangle, corners, cut_uvs);
  }
}

// A triangle one of whose corners is of another node than the two others.
void EmbeddedMesh::CutAcross(size_t triangle, std::span<const Corner, 3> corners,
                             const std::array<std::array<float, 2>, 3>& cut_uvs) {
  size_t apart = 0;
  while (NodeAt(triangle, apart) == NodeAt(triangle, (apart + 1) % 3) ||
         NodeAt(triangle, apart) == NodeAt(triangle, (apart + 2) % 3))
    ++apart;
  const size_t next = (apart + 1) % 3;
  const size_t last = (apart + 2) % 3;
  const auto cut = [&](size_t k, int32_t node) {
    return Corner{EdgePoint(EdgeAt(triangle, k), node), cut_uvs[k],
                  kCut + static_cast<unsigned>(k)};
  };
  const int32_t own = NodeAt(triangle, apart);
  const int32_t other = NodeAt(triangle, next);
  const std::array<Corner, 3> tip{cut(last, own), corners[apart], cut(apart, own)};
  const std::array<Corner, 4> rest{cut(apart, other), corners[next], corners[last],
                                   cut(last, other)};
  AddFan(tip, triangle, own);
  AddFan(rest, triangle, other);
  if (!IsSplit(EdgeAt(triangle, apart))) return;
  // Towards the middle of all cuts between these two nodes.
  const int32_t body_edge = body_edges_[EdgeAt(triangle, apart)];
  const auto tet = static_cast<size_t>(divided_.place(static_cast<size_t>(corners[0].point)).tet);
  AddTriangle(surface_id::OfRenderCrack(triangle, 3, apart, 0), tip.front().point, tip.back().point,
              PairPoint(body_edge, own, other), tet, own, -1);
  AddTriangle(surface_id::OfRenderCrack(triangle, 3, next, 0), rest.front().point,
              rest.back().point, PairPoint(body_edge, other, own), tet, other, -1);
}

void EmbeddedMesh::CutBetween(size_t triangle, std::span<const Corner, 3> corners,
                              const std::array<std::array<float, 2>, 3>& cut_uvs) {
  const Parting parting = PartingOf(triangle);
  const auto cut = [&](size_t k, size_t side) {
    return Corner{EdgePoint(EdgeAt(triangle, k), NodeAt(triangle, side)), cut_uvs[k],
                  kCut + static_cast<unsigned>(k)};
  };
  std::array<Corner, 8> polygon{};
  size_t size = 0;
  if (!parting.open[0] && !parting.open[1] && !parting.open[2]) {
    // Beginning at a cut, no triangle of the fan is flat but where two corners frame another cut:
    // those are cut off first.
    std::array<Corner, 3> cuts{};
    size_t first = 3;
    for (size_t k = 0; k < 3; ++k) {
      if (!IsCut(EdgeAt(triangle, k))) continue;
      cuts[k] = cut(k, k);
      if (first == 3) first = k;
    }
    polygon[size++] = cuts[first];
    for (size_t step = 1; step <= 3; ++step) {
      const size_t k = (first + step) % 3;
      const size_t before = (k + 2) % 3;
      if (cuts[before].point >= 0 && cuts[k].point >= 0) {
        const std::array<Corner, 3> ear{cuts[before], corners[k], cuts[k]};
        AddFan(ear, triangle, NodeAt(triangle, k));
      } else {
        polygon[size++] = corners[k];
      }
      if (step < 3 && cuts[k].point >= 0) polygon[size++] = cuts[k];
    }
    AddFan(std::span(polygon).first(size), triangle, NodeAt(triangle, first));
    return;
  }
  std::array<float, 2> middle_uv{};
  for (size_t k = 0; k < 3; ++k) {
    for (size_t i = 0; i < 2; ++i) middle_uv[i] += cut_uvs[k][i] / 3;
  }
  // A polygon for each run of corners without a crack, round the point in the middle.
  for (size_t i = 0; i < 3; ++i) {
    const size_t before = (i + 2) % 3;
    if (!parting.open[before]) continue;
    size = 0;
    polygon[size++] = {MiddlePoint(triangle, parting, i), middle_uv, kMiddle};
    polygon[size++] = cut(before, i);
    for (size_t at = i;; at = (at + 1) % 3) {
      polygon[size++] = corners[at];
      if (IsCut(EdgeAt(triangle, at))) polygon[size++] = cut(at, at);
      if (parting.open[at]) break;
    }
    AddFan(std::span(polygon).first(size), triangle, NodeAt(triangle, i));
  }
  AddWings(triangle, parting);
}

// Crack faces from the cuts of a triangle between three nodes towards its face.
void EmbeddedMesh::AddWings(size_t triangle, const Parting& parting) {
  const auto first = static_cast<size_t>(divided_.mesh().triangles[triangle][0]);
  const auto tet = static_cast<size_t>(divided_.place(first).tet);
  const Triple nodes = divided_.LabelsOf(triangle);
  for (size_t k = 0; k < 3; ++k) {
    if (!parting.open[k]) continue;
    for (const size_t side : {k, (k + 1) % 3}) {
      const int32_t node = nodes[side];
      const int32_t other = nodes[side == k ? (k + 1) % 3 : k];
      int32_t from = MiddlePoint(triangle, parting, side);
      int32_t to = EdgePoint(EdgeAt(triangle, k), node);
      const int32_t pair = PairPoint(body_edges_[EdgeAt(triangle, k)], node, other);
      const int32_t triple = TriplePoint(nodes, triangle_faces_[triangle], parting, side);
      const SurfaceId outer = surface_id::OfRenderCrack(triangle, k, side, 0);
      const SurfaceId inner = surface_id::OfRenderCrack(triangle, k, side, 1);
      if (side == k) {
        AddTriangle(outer, from, to, pair, tet, node, -1);
        AddTriangle(inner, from, pair, triple, tet, node, -1);
      } else {
        AddTriangle(outer, to, from, pair, tet, node, -1);
        AddTriangle(inner, pair, from, triple, tet, node, -1);
      }
    }
  }
}

void EmbeddedMesh::CutTet(size_t tet) {
  const int32_t turns = hubs_.inside(tet);
  Begin(tet_slots_[static_cast<int32_t>(tet)]);
  const std::array<int32_t, 4> centers = copies_.TetPoints(tet);
  std::array<FaceState, 4> states{};
  for (size_t face = 0; face < 4; ++face) states[face] = copies_.StateOf(tet, face);
  for (size_t k = 0; k < 6; ++k) {
    if (!PartsEdge(out_.tet_masks[tet], k)) continue;
    for (size_t side = 0; side < 2; ++side) {
      const auto end = static_cast<size_t>(kTetEdges[k][side]);
      const int32_t node = mesh_.tets[tet][end];
      const int32_t middle = PairPointOf(incidence_.tet_edges[tet][k], node);
      int32_t second = FacePointOf(states[kAcrossEdge[k][side]], node);
      int32_t first = FacePointOf(states[kAcrossEdge[k][1 - side]], node);
      if (turns < 0) std::swap(first, second);
      for (size_t turn = 0; turn < static_cast<size_t>(std::abs(turns)); ++turn) {
        AddTriangle(surface_id::OfCrack(tet, k, side, 0, turn), centers[end], second, middle, tet,
                    node, -1);
        AddTriangle(surface_id::OfCrack(tet, k, side, 1, turn), centers[end], middle, first, tet,
                    node, -1);
      }
    }
  }
}

}  // namespace cleave
