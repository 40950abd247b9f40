#include "core/surface/point_copies.h"

#include <algorithm>

namespace cleave {

size_t FaceState::IndexOf(int32_t node) const {
  return static_cast<size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

PointCopies::PointCopies(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                         bool smooth, SurfaceTopology& surface)
    : mesh_(mesh),
      incidence_(incidence),
      faces_(faces),
      smooth_(smooth),
      surface_(surface),
      edge_splits_(incidence.edges.size(), 0),
      node_points_(mesh.rest_positions.size(), -1),
      edge_points_(incidence.edges.size(), -1) {}

int32_t PointCopies::Find(SurfaceId id) const {
  const auto part = static_cast<size_t>(surface_id::PartOf(id));
  switch (surface_id::KindOf(id)) {
    case surface_id::kNode:
      return node_points_[part];
    case surface_id::kEdge:
      if (surface_id::LowOf(id) == 0) return edge_points_[part];
      break;
    default:
      break;
  }
  const auto& points = surface_id::KindOf(id) == surface_id::kPinch ? pinch_points_ : other_points_;
  const auto found = points.find(id);
  return found == points.end() ? -1 : found->second;
}

void PointCopies::Place(SurfaceId id, int32_t point) {
  const auto part = static_cast<size_t>(surface_id::PartOf(id));
  if (surface_id::KindOf(id) == surface_id::kNode) {
    node_points_[part] = point;
  } else if (surface_id::KindOf(id) == surface_id::kEdge && surface_id::LowOf(id) == 0) {
    edge_points_[part] = point;
  } else if (point < 0) {
    MapOf(id).erase(id);
  } else {
    MapOf(id)[id] = point;
  }
}

int32_t PointCopies::Put(SurfaceId id, SurfacePoint point) {
  point.rest = {};
  for (size_t i = 0; i < point.node_count; ++i) {
    const Vec3& position = mesh_.rest_positions[static_cast<size_t>(point.nodes[i])];
    for (size_t axis = 0; axis < 3; ++axis) point.rest[axis] += point.weights[i] * position[axis];
  }
  int32_t at = Find(id);
  if (at >= 0) {
    surface_.points[static_cast<size_t>(at)] = point;
    return at;
  }
  at = static_cast<int32_t>(surface_.points.size());
  surface_.points.push_back(point);
  surface_.point_ids.push_back(id);
  Place(id, at);
  return at;
}

size_t PointCopies::VertexOf(size_t tet, int32_t node) const {
  const std::array<int32_t, 4>& nodes = mesh_.tets[tet];
  return static_cast<size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

void PointCopies::UpdateEdge(int32_t edge) {
  const auto [a, b] = incidence_.edges[static_cast<size_t>(edge)];
  const std::span<const int32_t> tets = incidence_.edge_tets[edge];
  const bool splits = std::all_of(tets.begin(), tets.end(), [&, a = a, b = b](int32_t tet) {
    return PartsNodes(static_cast<size_t>(tet), a, b);
  });
  edge_splits_[static_cast<size_t>(edge)] = splits ? 1 : 0;
}

int32_t PointCopies::NodePoint(int32_t node) {
  const int32_t point = node_points_[static_cast<size_t>(node)];
  if (point >= 0) return point;
  return Put(surface_id::OfNode(node), {{}, {node, -1, -1, -1}, {1, 0, 0, 0}, 1, 0b1});
}

int32_t PointCopies::Midpoint(int32_t edge, int32_t node) {
  const auto [a, b] = incidence_.edges[static_cast<size_t>(edge)];
  const bool splits = edge_splits_[static_cast<size_t>(edge)] != 0;
  const size_t copy = splits && node == b ? 1 : 0;
  SurfacePoint point{{}, {a, b, -1, -1}, {0.5, 0.5, 0, 0}, 2, 0b11};
  if (splits) point.owners = static_cast<uint8_t>(1u << copy);
  return Put(surface_id::OfEdge(edge, copy), point);
}

FaceState PointCopies::StateOf(size_t tet, size_t face) const {
  const int32_t across = faces_.neighbors[tet][face];
  FaceState state;
  state.slot = 4 * tet + face;
  if (across >= 0) state.slot = std::min(state.slot, static_cast<size_t>(across));
  for (size_t i = 0; i < 3; ++i) {
    const auto vertex = static_cast<size_t>(kTetFaces[state.slot % 4][i]);
    state.nodes[i] = mesh_.tets[state.slot / 4][vertex];
  }
  Apply(tet, state);
  if (across >= 0) Apply(static_cast<size_t>(across / 4), state);
  return state;
}

void PointCopies::Apply(size_t tet, FaceState& state) const {
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3;
    if (PartsNodes(tet, state.nodes[i], state.nodes[j])) {
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

int32_t PointCopies::FacePointOf(const FaceState& face, uint8_t component) {
  SurfacePoint point{
      {}, {face.nodes[0], face.nodes[1], face.nodes[2], -1}, FaceWeights(face), 3, 0};
  for (size_t i = 0; i < 3; ++i) {
    if (face.component[i] == component) point.owners |= static_cast<uint8_t>(1u << i);
  }
  return Put(surface_id::OfFace(face.slot, component), point);
}

std::array<double, 4> PointCopies::FaceWeights(const FaceState& face) const {
  if (!smooth_) return {1 / 3.0, 1 / 3.0, 1 / 3.0, 0};
  const double share =
      0.5 / static_cast<double>(std::count(face.parted.begin(), face.parted.end(), true));
  std::array<double, 4> weights{};
  for (size_t i = 0; i < 3; ++i) {
    if (!face.parted[i]) continue;
    weights[i] += share;
    weights[(i + 1) % 3] += share;
  }
  return weights;
}

std::array<double, 4> PointCopies::TetWeights(size_t tet) const {
  if (!smooth_) return {0.25, 0.25, 0.25, 0.25};
  std::array<double, 4> weights{};
  int parted = 0;
  for (const auto& [a, b] : kTetEdges) {
    if (!Parts(tet, static_cast<size_t>(a), static_cast<size_t>(b))) continue;
    weights[static_cast<size_t>(a)] += 0.5;
    weights[static_cast<size_t>(b)] += 0.5;
    ++parted;
  }
  for (double& weight : weights) weight /= parted;
  return weights;
}

std::array<int32_t, 4> PointCopies::TetPoints(size_t tet) {
  const VertexGroups& groups = kVertexGroups[surface_.tet_masks[tet]];
  SurfacePoint point{{}, mesh_.tets[tet], TetWeights(tet), 4, 0};
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
    points[vertex] = Put(surface_id::OfTet(tet, vertex), point);
  }
  return points;
}

int32_t PointCopies::PinchPoint(size_t tet, size_t face, const FaceState& state, int32_t edge,
                                int32_t node) {
  if (edge_splits_[static_cast<size_t>(edge)] != 0) return -1;
  const auto [a, b] = incidence_.edges[static_cast<size_t>(edge)];
  const size_t i = state.IndexOf(a);
  const size_t j = state.IndexOf(b);
  const int32_t across = faces_.neighbors[tet][face];
  if (state.component[i] != state.component[j] || across < 0) return -1;
  if (!PartsNodes(static_cast<size_t>(across / 4), a, b)) return -1;

  SurfacePoint point{
      {}, {state.nodes[0], state.nodes[1], state.nodes[2], -1}, FaceWeights(state), 3, 0};
  for (size_t k = 0; k < 3; ++k) {
    if (state.component[k] == state.component[i]) point.owners |= static_cast<uint8_t>(1u << k);
  }
  for (double& weight : point.weights) weight /= 2;
  point.weights[i] += 0.25;
  point.weights[j] += 0.25;
  const size_t opposite = 3 - i - j;  // corner, whose edge starts at the next
  return Put(surface_id::OfPinch(state.slot, (opposite + 1) % 3, node == b ? 1 : 0), point);
}

}  // namespace cleave
