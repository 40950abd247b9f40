#include "core/surface/embedded_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/parallel.h"

namespace cleave {
namespace {

constexpr int kMaxRounds = 8;      // of dividing by length
constexpr int kMaxFaceRounds = 4;  // where nodes of a triangle are no face

// As in visible_surface.cc.
constexpr std::array<std::array<size_t, 2>, 6> kAcrossEdge = {
    {{2, 3}, {3, 1}, {1, 2}, {0, 3}, {2, 0}, {0, 1}}};

// Kinds of points that pieces have copies of.
enum Kind : uint64_t { kVertex, kEdge, kMiddle, kPair, kTriple, kTet };

Vec3 Mix(const Vec3& a, const Vec3& b, double share) {
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])};
}

std::array<float, 2> Mix(const std::array<float, 2>& a, const std::array<float, 2>& b,
                         double share) {
  const auto s = static_cast<float>(share);
  return {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])};
}

Vec3 MeanOf(const std::array<Vec3, 3>& places) {
  Vec3 mean{0, 0, 0};
  for (const Vec3& place : places) {
    for (size_t axis = 0; axis < 3; ++axis) mean[axis] += place[axis] / 3;
  }
  return mean;
}

double Distance(const Vec3& a, const Vec3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

double MeanEdgeLength(const TetMesh& mesh, const Incidence& incidence) {
  double sum = 0;
  for (const auto& [a, b] : incidence.edges)
    sum += Distance(mesh.rest_positions[static_cast<size_t>(a)],
                    mesh.rest_positions[static_cast<size_t>(b)]);
  return sum / static_cast<double>(incidence.edges.size());
}

// Whether three distinct numbers turn as three others, the same ones, do.
bool TurnsAs(const std::array<int32_t, 3>& a, const std::array<int32_t, 3>& b) {
  const auto at = std::find(b.begin(), b.end(), a[0]) - b.begin();
  return b[static_cast<size_t>((at + 1) % 3)] == a[1];
}

}  // namespace

EmbeddedMesh::EmbeddedMesh(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                           RenderMesh render)
    : mesh_(mesh),
      incidence_(incidence),
      faces_(faces),
      locator_(mesh, faces),
      render_(std::move(render)) {
  source_of_.resize(render_.triangles.size());
  for (size_t i = 0; i < source_of_.size(); ++i) source_of_[i] = static_cast<int32_t>(i);
  NumberEdges();
  Place(0);
  Divide(0.5 * MeanEdgeLength(mesh, incidence));
  FindHubs();
  FindInside();
}

void EmbeddedMesh::NumberEdges() {
  edges_.clear();
  for (const auto& triangle : render_.triangles) {
    for (size_t k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
      edges_.push_back({low, high});
    }
  }
  std::sort(edges_.begin(), edges_.end());
  edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  triangle_edges_.resize(render_.triangles.size());
  for (size_t i = 0; i < render_.triangles.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const auto [low, high] =
          std::minmax(render_.triangles[i][k], render_.triangles[i][(k + 1) % 3]);
      const auto found = std::lower_bound(edges_.begin(), edges_.end(), Pair{low, high});
      triangle_edges_[i][k] = static_cast<int32_t>(found - edges_.begin());
    }
  }
}

void EmbeddedMesh::Place(size_t first) {
  places_.resize(render_.points.size());
  labels_.resize(render_.points.size());
  ParallelFor(static_cast<int64_t>(render_.points.size() - first), 256,
              [&](int64_t begin, int64_t end) {
                for (int64_t i = begin; i < end; ++i) {
                  const size_t point = first + static_cast<size_t>(i);
                  places_[point] = locator_.Locate(render_.points[point]);
                  const auto& nodes = mesh_.tets[static_cast<size_t>(places_[point].tet)];
                  size_t most = 0;
                  for (size_t k = 1; k < 4; ++k) {
                    const double more = places_[point].weights[k] - places_[point].weights[most];
                    if (more > 0 || (more == 0 && nodes[k] < nodes[most])) most = k;
                  }
                  labels_[point] = nodes[most];
                }
              });
}

void EmbeddedMesh::Divide(double longest) {
  for (int round = 0; round < kMaxRounds + kMaxFaceRounds; ++round) {
    std::vector<uint8_t> split(edges_.size(), 0);
    for (size_t edge = 0; edge < edges_.size(); ++edge) {
      const auto [a, b] = edges_[edge];
      const bool is_long = Distance(render_.points[static_cast<size_t>(a)],
                                    render_.points[static_cast<size_t>(b)]) > longest;
      split[edge] = is_long && round < kMaxRounds ? 1 : 0;
      if (!AreJoined(Label(static_cast<size_t>(a)), Label(static_cast<size_t>(b)))) split[edge] = 1;
    }
    for (size_t i = 0; i < render_.triangles.size(); ++i) {
      Triple nodes{};
      for (size_t k = 0; k < 3; ++k) nodes[k] = Label(static_cast<size_t>(render_.triangles[i][k]));
      if (nodes[0] == nodes[1] || nodes[1] == nodes[2] || nodes[2] == nodes[0]) continue;
      if (FindFace(nodes) >= 0) continue;
      for (const int32_t edge : triangle_edges_[i]) split[static_cast<size_t>(edge)] = 1;
    }
    if (!SplitEdges(split)) return;
  }
}

bool EmbeddedMesh::SplitEdges(const std::vector<uint8_t>& split) {
  std::vector<int32_t> middles(edges_.size(), -1);
  const size_t first = render_.points.size();
  for (size_t edge = 0; edge < edges_.size(); ++edge) {
    if (split[edge] == 0) continue;
    const auto [a, b] = edges_[edge];
    middles[edge] = static_cast<int32_t>(render_.points.size());
    render_.points.push_back(
        Mix(render_.points[static_cast<size_t>(a)], render_.points[static_cast<size_t>(b)], 0.5));
  }
  if (render_.points.size() == first) return false;
  RenderMesh divided;
  std::vector<int32_t> sources;
  for (size_t i = 0; i < render_.triangles.size(); ++i) {
    const CornerUvs uvs = render_.uvs.empty() ? CornerUvs{} : render_.uvs[i];
    std::array<Corner, 3> corners{};
    std::array<Corner, 3> middle{};
    size_t cuts = 0;
    for (size_t k = 0; k < 3; ++k) {
      corners[k] = {render_.triangles[i][k], uvs[k]};
      middle[k] = {middles[static_cast<size_t>(triangle_edges_[i][k])],
                   Mix(uvs[k], uvs[(k + 1) % 3], 0.5)};
      cuts += middle[k].point >= 0 ? 1 : 0;
    }
    const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
      divided.triangles.push_back({a.point, b.point, c.point});
      if (!render_.uvs.empty()) divided.uvs.push_back({a.uv, b.uv, c.uv});
      sources.push_back(source_of_[i]);
    };
    // Turned so that the first edge is cut, and with two of them the last is not.
    size_t k = 0;
    while (cuts > 0 && cuts < 3 &&
           (middle[k].point < 0 || (cuts == 2 && middle[(k + 2) % 3].point >= 0)))
      ++k;
    const size_t l = (k + 1) % 3;
    const size_t m = (k + 2) % 3;
    if (cuts == 0) {
      add(corners[0], corners[1], corners[2]);
    } else if (cuts == 1) {
      add(corners[k], middle[k], corners[m]);
      add(middle[k], corners[l], corners[m]);
    } else if (cuts == 2) {
      add(middle[k], corners[l], middle[l]);
      add(middle[k], middle[l], corners[k]);
      add(middle[l], corners[m], corners[k]);
    } else {
      for (size_t j = 0; j < 3; ++j) add(middle[(j + 2) % 3], corners[j], middle[j]);
      add(middle[0], middle[1], middle[2]);
    }
  }
  render_.triangles = std::move(divided.triangles);
  render_.uvs = std::move(divided.uvs);
  source_of_ = std::move(sources);
  NumberEdges();
  Place(first);
  return true;
}

int64_t EmbeddedMesh::FindFace(const Triple& nodes) const {
  for (const int32_t tet : incidence_.node_tets[nodes[0]]) {
    const auto& corners = mesh_.tets[static_cast<size_t>(tet)];
    size_t shared = 0;
    size_t opposite = 0;
    for (size_t k = 0; k < 4; ++k) {
      if (std::find(nodes.begin(), nodes.end(), corners[k]) != nodes.end()) {
        ++shared;
      } else {
        opposite = k;
      }
    }
    // Tets of a node ascend: the first that has the face is the lower one.
    if (shared == 3) return 4 * int64_t{tet} + static_cast<int64_t>(opposite);
  }
  return -1;
}

bool EmbeddedMesh::AreJoined(int32_t a, int32_t b) const {
  if (a == b) return true;
  const std::span<const int32_t> edges = incidence_.node_edges[a];
  return std::any_of(edges.begin(), edges.end(), [&](int32_t edge) {
    const auto [low, high] = incidence_.edges[static_cast<size_t>(edge)];
    return low == b || high == b;
  });
}

// Where the nodes of an edge's ends weigh the same, as far as their tets tell.
Vec3 EmbeddedMesh::CutAt(size_t edge, double& share) const {
  const auto from = static_cast<size_t>(edges_[edge][0]);
  const auto to = static_cast<size_t>(edges_[edge][1]);
  const auto lead = [&](size_t point, int32_t over) {
    const auto& nodes = mesh_.tets[static_cast<size_t>(places_[point].tet)];
    double own = 0, other = 0;
    for (size_t k = 0; k < 4; ++k) {
      if (nodes[k] == Label(point)) own = places_[point].weights[k];
      if (nodes[k] == over) other = places_[point].weights[k];
    }
    return own - other;
  };
  const double a = lead(from, Label(to));
  const double b = lead(to, Label(from));
  // Not so near an end that triangles get thin beyond need.
  share = a + b > 0 ? std::clamp(a / (a + b), 0.02, 0.98) : 0.5;
  return Mix(render_.points[from], render_.points[to], share);
}

void EmbeddedMesh::FindHubs() {
  const auto add = [](Hub& hub, const Vec3& place) {
    for (size_t axis = 0; axis < 3; ++axis) hub.sum[axis] += place[axis];
    ++hub.count;
  };
  std::vector<Vec3> cuts(edges_.size());
  for (size_t edge = 0; edge < edges_.size(); ++edge) {
    const int32_t from = Label(static_cast<size_t>(edges_[edge][0]));
    const int32_t to = Label(static_cast<size_t>(edges_[edge][1]));
    const auto [low, high] = std::minmax(from, to);  // refers to them
    if (low == high) continue;
    double share = 0;
    cuts[edge] = CutAt(edge, share);
    add(pair_hubs_[{low, high}], cuts[edge]);
  }
  for (size_t i = 0; i < render_.triangles.size(); ++i) {
    Triple nodes{};
    std::array<Vec3, 3> places{};
    for (size_t k = 0; k < 3; ++k) {
      nodes[k] = Label(static_cast<size_t>(render_.triangles[i][k]));
      places[k] = cuts[static_cast<size_t>(triangle_edges_[i][k])];
    }
    std::sort(nodes.begin(), nodes.end());
    if (nodes[0] != nodes[1] && nodes[1] != nodes[2]) add(triple_hubs_[nodes], MeanOf(places));
  }
}

// The render mesh goes round some tets: those from which one cannot leave through faces at whose
// nodes it has a triangle. As it is closed, so is what its triangles are of faces.
void EmbeddedMesh::FindInside() {
  std::map<int64_t, int32_t> crossings;  // outward of the lower tet, by face
  for (const auto& triangle : render_.triangles) {
    Triple nodes{};
    for (size_t k = 0; k < 3; ++k) nodes[k] = Label(static_cast<size_t>(triangle[k]));
    if (nodes[0] == nodes[1] || nodes[1] == nodes[2] || nodes[2] == nodes[0]) continue;
    const int64_t face = FindFace(nodes);
    if (face < 0) {
      ++open_faces_;
      continue;
    }
    Triple outward{};
    for (size_t i = 0; i < 3; ++i) {
      const auto vertex = static_cast<size_t>(kTetFaces[static_cast<size_t>(face % 4)][i]);
      outward[i] = mesh_.tets[static_cast<size_t>(face / 4)][vertex];
    }
    crossings[face] += TurnsAs(nodes, outward) ? 1 : -1;
  }
  const auto crossing_of = [&](int64_t face) {
    const auto found = crossings.find(face);
    return found == crossings.end() ? 0 : found->second;
  };
  inside_.assign(mesh_.tets.size(), 0);
  std::vector<uint8_t> known(mesh_.tets.size(), 0);
  std::vector<int32_t> queue;
  for (const TetFace& side : faces_.boundary) {
    const int32_t crossing = crossing_of(4 * int64_t{side.tet} + side.face);
    if (known[static_cast<size_t>(side.tet)] != 0) {
      open_faces_ += inside_[static_cast<size_t>(side.tet)] != crossing ? 1 : 0;
      continue;
    }
    known[static_cast<size_t>(side.tet)] = 1;
    inside_[static_cast<size_t>(side.tet)] = crossing;
    queue.push_back(side.tet);
    while (!queue.empty()) {
      const int32_t tet = queue.back();
      queue.pop_back();
      for (size_t face = 0; face < 4; ++face) {
        const int32_t across = faces_.neighbors[static_cast<size_t>(tet)][face];
        if (across < 0) continue;
        const int64_t own = 4 * int64_t{tet} + static_cast<int64_t>(face);
        // Of the lower tet less that of the upper one.
        const int32_t step = own < across ? -crossing_of(own) : crossing_of(across);
        const auto other = static_cast<size_t>(across / 4);
        const int32_t wanted = inside_[static_cast<size_t>(tet)] + step;
        if (known[other] != 0) {
          open_faces_ += own < across && inside_[other] != wanted ? 1 : 0;
          continue;
        }
        known[other] = 1;
        inside_[other] = wanted;
        queue.push_back(across / 4);
      }
    }
  }
}

uint8_t EmbeddedMesh::OwnersOf(const SurfacePoint& point, int32_t piece) const {
  uint8_t owners = 0;
  for (size_t k = 0; k < point.node_count; ++k) {
    if (pieces_->piece_of(point.nodes[k]) == piece) owners |= static_cast<uint8_t>(1u << k);
  }
  return owners;
}

int32_t EmbeddedMesh::Copy(uint64_t kind, uint64_t id, const SurfacePoint& point, int32_t piece) {
  const auto [entry, is_new] = copies_.try_emplace({kind, id, static_cast<uint64_t>(piece)},
                                                   static_cast<int32_t>(out_.points.size()));
  if (is_new) {
    out_.points.push_back(point);
    out_.points.back().owners = OwnersOf(point, piece);
  }
  return entry->second;
}

int32_t EmbeddedMesh::VertexCopy(int32_t point) {
  const auto p = static_cast<size_t>(point);
  const PlaceInTet& place = places_[p];
  return Copy(kVertex, p,
              {render_.points[p], mesh_.tets[static_cast<size_t>(place.tet)], place.weights, 4, 0},
              pieces_->piece_of(Label(p)));
}

int32_t EmbeddedMesh::EdgeCopy(size_t edge, int32_t piece) {
  double share = 0;
  const Vec3 rest = CutAt(edge, share);
  const int32_t a = Label(static_cast<size_t>(edges_[edge][0]));
  const int32_t b = Label(static_cast<size_t>(edges_[edge][1]));
  return Copy(kEdge, edge, {rest, {a, b, -1, -1}, {0.5, 0.5, 0, 0}, 2, 0}, piece);
}

int32_t EmbeddedMesh::MiddleCopy(size_t triangle, int32_t piece) {
  std::array<Vec3, 3> places{};
  SurfacePoint point{{}, {-1, -1, -1, -1}, {1 / 3.0, 1 / 3.0, 1 / 3.0, 0}, 3, 0};
  for (size_t k = 0; k < 3; ++k) {
    double share = 0;
    places[k] = CutAt(static_cast<size_t>(triangle_edges_[triangle][k]), share);
    point.nodes[k] = Label(static_cast<size_t>(render_.triangles[triangle][k]));
  }
  point.rest = MeanOf(places);
  return Copy(kMiddle, triangle, point, piece);
}

int32_t EmbeddedMesh::PairCopy(int32_t a, int32_t b, int32_t piece) {
  const auto [low, high] = std::minmax(a, b);
  SurfacePoint point{{}, {low, high, -1, -1}, {0.5, 0.5, 0, 0}, 2, 0};
  const auto hub = pair_hubs_.find({low, high});
  if (hub == pair_hubs_.end()) {
    point.rest = Mix(mesh_.rest_positions[static_cast<size_t>(low)],
                     mesh_.rest_positions[static_cast<size_t>(high)], 0.5);
  } else {
    for (size_t axis = 0; axis < 3; ++axis)
      point.rest[axis] = hub->second.sum[axis] / hub->second.count;
  }
  return Copy(kPair, static_cast<uint64_t>(low) << 32 | static_cast<uint64_t>(high), point, piece);
}

int32_t EmbeddedMesh::TripleCopy(Triple nodes, int32_t piece) {
  std::sort(nodes.begin(), nodes.end());
  SurfacePoint point{{}, {nodes[0], nodes[1], nodes[2], -1}, {1 / 3.0, 1 / 3.0, 1 / 3.0, 0}, 3, 0};
  const auto hub = triple_hubs_.find(nodes);
  std::array<Vec3, 3> places{};
  for (size_t k = 0; k < 3; ++k) places[k] = mesh_.rest_positions[static_cast<size_t>(nodes[k])];
  point.rest = MeanOf(places);
  for (size_t axis = 0; hub != triple_hubs_.end() && axis < 3; ++axis)
    point.rest[axis] = hub->second.sum[axis] / hub->second.count;
  // Three node ids have up to 93 bits: faces are few enough to be found again by their lower tet.
  const int64_t face = FindFace(nodes);
  const uint64_t id =
      face >= 0
          ? static_cast<uint64_t>(face)
          : uint64_t{1} << 63 | static_cast<uint64_t>(std::distance(triple_hubs_.begin(), hub));
  return Copy(kTriple, id, point, piece);
}

int32_t EmbeddedMesh::TetCopy(size_t tet, int32_t piece) {
  SurfacePoint point{{}, mesh_.tets[tet], {0.25, 0.25, 0.25, 0.25}, 4, 0};
  for (const int32_t node : point.nodes) {
    for (size_t axis = 0; axis < 3; ++axis)
      point.rest[axis] += 0.25 * mesh_.rest_positions[static_cast<size_t>(node)][axis];
  }
  return Copy(kTet, tet, point, piece);
}

void EmbeddedMesh::AddTriangle(int32_t a, int32_t b, int32_t c, size_t tet, int32_t node,
                               int32_t source) {
  out_.triangles.push_back({a, b, c});
  out_.nodes.push_back(node);
  out_.tets.push_back(static_cast<int32_t>(tet));
  out_.inside.push_back(source < 0 ? 1 : 0);
  sources_.push_back(source);
  if (!render_.uvs.empty()) uvs_.push_back({});
}

void EmbeddedMesh::AddOuter(std::span<const Corner> polygon, size_t triangle, int32_t node) {
  const auto point = static_cast<size_t>(render_.triangles[triangle][0]);
  for (size_t i = 1; i + 1 < polygon.size(); ++i) {
    AddTriangle(polygon[0].point, polygon[i].point, polygon[i + 1].point,
                static_cast<size_t>(places_[point].tet), node, source_of_[triangle]);
    if (!render_.uvs.empty()) uvs_.back() = {polygon[0].uv, polygon[i].uv, polygon[i + 1].uv};
  }
}

void EmbeddedMesh::CutTriangle(size_t triangle) {
  Triple nodes{};
  std::array<int32_t, 3> pieces{};
  const CornerUvs uvs = render_.uvs.empty() ? CornerUvs{} : render_.uvs[triangle];
  for (size_t k = 0; k < 3; ++k) {
    nodes[k] = Label(static_cast<size_t>(render_.triangles[triangle][k]));
    pieces[k] = pieces_->piece_of(nodes[k]);
  }
  const auto vertex = [&](size_t k) {
    return Corner{VertexCopy(render_.triangles[triangle][k]), uvs[k]};
  };
  if (pieces[0] == pieces[1] && pieces[1] == pieces[2]) {
    const std::array<Corner, 3> whole{vertex(0), vertex(1), vertex(2)};
    AddOuter(whole, triangle, nodes[0]);
    return;
  }
  const auto edge_of = [&](size_t k) { return static_cast<size_t>(triangle_edges_[triangle][k]); };
  std::array<std::array<float, 2>, 3> edge_uvs{};
  for (size_t k = 0; k < 3; ++k) {
    double share = 0;
    CutAt(edge_of(k), share);
    const bool runs_on = edges_[edge_of(k)][0] == render_.triangles[triangle][k];
    edge_uvs[k] = Mix(uvs[k], uvs[(k + 1) % 3], runs_on ? share : 1 - share);
  }
  const auto cut = [&](size_t k, int32_t piece) {
    return Corner{EdgeCopy(edge_of(k), piece), edge_uvs[k]};
  };
  const auto tet =
      static_cast<size_t>(places_[static_cast<size_t>(render_.triangles[triangle][0])].tet);
  const bool three = nodes[0] != nodes[1] && nodes[1] != nodes[2] && nodes[2] != nodes[0];
  std::array<float, 2> middle_uv{};
  for (size_t k = 0; k < 3; ++k) {
    for (size_t i = 0; i < 2; ++i) middle_uv[i] += edge_uvs[k][i] / 3;
  }
  // A polygon for each run of corners of one piece.
  for (size_t i = 0; i < 3; ++i) {
    const size_t before = (i + 2) % 3;
    if (pieces[before] == pieces[i]) continue;
    std::array<Corner, 5> polygon{};
    size_t size = 0;
    polygon[size++] = cut(before, pieces[i]);
    size_t at = i;
    polygon[size++] = vertex(at);
    for (; pieces[(at + 1) % 3] == pieces[i]; polygon[size++] = vertex(at)) at = (at + 1) % 3;
    polygon[size++] = cut(at, pieces[i]);
    if (three) polygon[size++] = {MiddleCopy(triangle, pieces[i]), middle_uv};
    AddOuter(std::span(polygon).first(size), triangle, nodes[i]);
    if (three) continue;
    // Towards the middle of all cuts between these two nodes.
    AddTriangle(polygon[0].point, polygon[size - 1].point,
                PairCopy(nodes[i], nodes[before], pieces[i]), tet, nodes[i], -1);
  }
  if (!three) return;
  for (size_t k = 0; k < 3; ++k) {
    const size_t next = (k + 1) % 3;
    if (pieces[k] == pieces[next]) continue;
    for (const size_t side : {k, next}) {
      const int32_t piece = pieces[side];
      const int32_t middle = MiddleCopy(triangle, piece);
      const int32_t edge = EdgeCopy(edge_of(k), piece);
      const int32_t pair = PairCopy(nodes[k], nodes[next], piece);
      const int32_t triple = TripleCopy(nodes, piece);
      if (side == k) {
        AddTriangle(middle, edge, pair, tet, nodes[side], -1);
        AddTriangle(middle, pair, triple, tet, nodes[side], -1);
      } else {
        AddTriangle(edge, middle, pair, tet, nodes[side], -1);
        AddTriangle(pair, middle, triple, tet, nodes[side], -1);
      }
    }
  }
}

void EmbeddedMesh::CutTet(size_t tet) {
  const auto& nodes = mesh_.tets[tet];
  const auto triple = [&](size_t face, int32_t piece) {
    const auto& corners = kTetFaces[face];
    return TripleCopy(
        {nodes[static_cast<size_t>(corners[0])], nodes[static_cast<size_t>(corners[1])],
         nodes[static_cast<size_t>(corners[2])]},
        piece);
  };
  for (size_t k = 0; k < 6; ++k) {
    const std::array<int32_t, 2> ends{nodes[static_cast<size_t>(kTetEdges[k][0])],
                                      nodes[static_cast<size_t>(kTetEdges[k][1])]};
    if (pieces_->piece_of(ends[0]) == pieces_->piece_of(ends[1])) continue;
    for (size_t side = 0; side < 2; ++side) {
      const int32_t piece = pieces_->piece_of(ends[side]);
      const int32_t center = TetCopy(tet, piece);
      const int32_t middle = PairCopy(ends[0], ends[1], piece);
      int32_t second = triple(kAcrossEdge[k][side], piece);
      int32_t first = triple(kAcrossEdge[k][1 - side], piece);
      if (inside_[tet] < 0) std::swap(first, second);
      for (int32_t time = 0; time < std::abs(inside_[tet]); ++time) {
        AddTriangle(center, second, middle, tet, ends[side], -1);
        AddTriangle(center, middle, first, tet, ends[side], -1);
      }
    }
  }
}

void EmbeddedMesh::Cut(const NamedPieces& pieces) {
  pieces_ = &pieces;
  out_.points.clear();
  out_.triangles.clear();
  out_.nodes.clear();
  out_.tets.clear();
  out_.inside.clear();
  uvs_.clear();
  sources_.clear();
  copies_.clear();
  for (size_t triangle = 0; triangle < render_.triangles.size(); ++triangle) CutTriangle(triangle);
  for (size_t tet = 0; tet < mesh_.tets.size(); ++tet) {
    if (inside_[tet] == 0) continue;
    const auto& nodes = mesh_.tets[tet];
    const int32_t piece = pieces.piece_of(nodes[0]);
    const bool is_whole = std::all_of(nodes.begin(), nodes.end(),
                                      [&](int32_t node) { return pieces.piece_of(node) == piece; });
    if (!is_whole) CutTet(tet);
  }
}

}  // namespace cleave
