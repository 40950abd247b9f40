#include "core/surface/point_copies.h"

#include <algorithm>

namespace cleave {

size_t FaceState::IndexOf(int32_t node) const {
  return static_cast<size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

PointCopies::PointCopies(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                         std::span<const EdgeMask> tet_masks, bool smooth,
                         std::vector<SurfacePoint>& points)
    : mesh_(mesh),
      incidence_(incidence),
      faces_(faces),
      tet_masks_(tet_masks),
      smooth_(smooth),
      points_(points),
      node_points_(mesh.rest_positions.size(), -1),
      edge_points_(incidence.edges.size(), -1),
      face_points_(4 * mesh.tets.size(), -1) {}

int32_t PointCopies::Add(SurfacePoint point) {
  for (size_t i = 0; i < point.node_count; ++i) {
    const Vec3& position = mesh_.rest_positions[static_cast<size_t>(point.nodes[i])];
    for (size_t axis = 0; axis < 3; ++axis) point.rest[axis] += point.weights[i] * position[axis];
  }
  points_.push_back(point);
  return static_cast<int32_t>(points_.size()) - 1;
}

size_t PointCopies::VertexOf(size_t tet, int32_t node) const {
  const std::array<int32_t, 4>& nodes = mesh_.tets[tet];
  return static_cast<size_t>(std::find(nodes.begin(), nodes.end(), node) - nodes.begin());
}

int32_t PointCopies::NodePoint(int32_t node) {
  int32_t& point = node_points_[static_cast<size_t>(node)];
  if (point < 0) point = Add({{}, {node, -1, -1, -1}, {1, 0, 0, 0}, 1, 0b1});
  return point;
}

int32_t PointCopies::Midpoint(int32_t edge, int32_t node) {
  const auto [a, b] = incidence_.edges[static_cast<size_t>(edge)];
  int32_t& first = edge_points_[static_cast<size_t>(edge)];
  if (first < 0) {
    const std::span<const int32_t> tets = incidence_.edge_tets[edge];
    const bool splits = std::all_of(tets.begin(), tets.end(), [&, a = a, b = b](int32_t tet) {
      return PartsNodes(static_cast<size_t>(tet), a, b);
    });
    SurfacePoint point{{}, {a, b, -1, -1}, {0.5, 0.5, 0, 0}, 2, 0b11};
    if (splits) point.owners = 0b01;
    first = Add(point);
    if (splits) {
      point.owners = 0b10;
      Add(point);
    }
  }
  const bool split = !points_[static_cast<size_t>(first)].owned_by_all();
  return first + (split && node == b ? 1 : 0);
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

int32_t PointCopies::FacePoint(const FaceState& face, int32_t node) {
  int32_t& first = face_points_[face.slot];
  if (first < 0) {
    first = static_cast<int32_t>(points_.size());
    SurfacePoint point{{}, {face.nodes[0], face.nodes[1], face.nodes[2], -1}, {}, 3, 0};
    point.weights = FaceWeights(face);
    for (uint8_t component = 0; component < 3; ++component) {
      point.owners = 0;
      for (size_t i = 0; i < 3; ++i) {
        if (face.component[i] == component) point.owners |= static_cast<uint8_t>(1u << i);
      }
      if (point.owners != 0) Add(point);
    }
  }
  // Copies lie in the order of their first node.
  int32_t copy = first;
  for (uint8_t other = 0; other < face.component[face.IndexOf(node)]; ++other)
    copy += face.component[other] == other ? 1 : 0;
  return copy;
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
  const VertexGroups& groups = kVertexGroups[tet_masks_[tet]];
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
    points[vertex] = Add(point);
  }
  return points;
}

int32_t PointCopies::PinchPoint(size_t tet, size_t face, const FaceState& state, int32_t edge,
                                int32_t node, int32_t midpoint, int32_t face_point) {
  if (!points_[static_cast<size_t>(midpoint)].owned_by_all()) return -1;
  const auto [a, b] = incidence_.edges[static_cast<size_t>(edge)];
  const size_t i = state.IndexOf(a);
  const size_t j = state.IndexOf(b);
  const int32_t across = faces_.neighbors[tet][face];
  if (state.component[i] != state.component[j] || across < 0) return -1;
  if (!PartsNodes(static_cast<size_t>(across / 4), a, b)) return -1;

  const uint64_t key = 3 * state.slot + (3 - i - j);  // the face, and which of its edges
  const auto [entry, is_new] = pinch_points_.try_emplace(key, 0);
  if (is_new) {
    SurfacePoint point = points_[static_cast<size_t>(face_point)];
    point.rest = {};
    for (double& weight : point.weights) weight /= 2;
    point.weights[i] += 0.25;
    point.weights[j] += 0.25;
    entry->second = Add(point);
    Add(point);
  }
  return entry->second + (node == b ? 1 : 0);
}

}  // namespace cleave
