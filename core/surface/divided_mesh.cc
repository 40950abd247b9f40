#include "core/surface/divided_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "core/base/parallel.h"

namespace cleave {
namespace {

constexpr int kMaxRounds = 8;      // of dividing by length
constexpr int kMaxFaceRounds = 4;  // where nodes of a triangle are no face

// A corner of a triangle.
struct Corner {
  int32_t point;
  std::array<float, 2> uv;
};

Vec3 Mix(const Vec3& a, const Vec3& b, double share) {
  return {a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1]), a[2] + share * (b[2] - a[2])};
}

std::array<float, 2> Middle(const std::array<float, 2>& a, const std::array<float, 2>& b) {
  return {a[0] + 0.5f * (b[0] - a[0]), a[1] + 0.5f * (b[1] - a[1])};
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

}  // namespace

DividedMesh::DividedMesh(const TetMesh& mesh, const Incidence& incidence, const Faces& faces,
                         RenderMesh render)
    : mesh_(mesh), incidence_(incidence), locator_(mesh, faces), render_(std::move(render)) {
  sources_.resize(render_.triangles.size());
  for (size_t i = 0; i < sources_.size(); ++i) sources_[i] = static_cast<int32_t>(i);
  NumberEdges();
  Place(0);
  Divide(0.5 * MeanEdgeLength(mesh, incidence));
}

DividedMesh::Triple DividedMesh::LabelsOf(size_t triangle) const {
  const auto& [a, b, c] = render_.triangles[triangle];
  return {label(static_cast<size_t>(a)), label(static_cast<size_t>(b)),
          label(static_cast<size_t>(c))};
}

void DividedMesh::NumberEdges() {
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

void DividedMesh::Place(size_t first) {
  places_.resize(render_.points.size());
  labels_.resize(render_.points.size());
  ParallelFor(static_cast<int64_t>(render_.points.size() - first), 256,
              [&](int64_t begin, int64_t end) {
                for (int64_t i = begin; i < end; ++i) {
                  const size_t point = first + static_cast<size_t>(i);
                  places_[point] = locator_.Locate(render_.points[point]);
                  const auto& nodes = mesh_.tets[static_cast<size_t>(places_[point].tet)];
                  const std::array<double, 4>& weights = places_[point].weights;
                  const double enough =
                      *std::max_element(weights.begin(), weights.end()) - TetLocator::kWeightSlack;
                  labels_[point] = std::numeric_limits<int32_t>::max();
                  for (size_t k = 0; k < 4; ++k) {
                    if (weights[k] >= enough) labels_[point] = std::min(labels_[point], nodes[k]);
                  }
                }
              });
}

void DividedMesh::Divide(double longest) {
  for (int round = 0; round < kMaxRounds + kMaxFaceRounds; ++round) {
    std::vector<uint8_t> split(edges_.size(), 0);
    for (size_t edge = 0; edge < edges_.size(); ++edge) {
      const auto [a, b] = edges_[edge];
      const bool is_long = Distance(render_.points[static_cast<size_t>(a)],
                                    render_.points[static_cast<size_t>(b)]) > longest;
      split[edge] = is_long && round < kMaxRounds ? 1 : 0;
      const int32_t from = label(static_cast<size_t>(a));
      const int32_t to = label(static_cast<size_t>(b));
      if (from != to && FindEdge(from, to) < 0) split[edge] = 1;
    }
    for (size_t i = 0; i < render_.triangles.size(); ++i) {
      const Triple nodes = LabelsOf(i);
      if (nodes[0] == nodes[1] || nodes[1] == nodes[2] || nodes[2] == nodes[0]) continue;
      if (FindFace(nodes) >= 0) continue;
      for (const int32_t edge : triangle_edges_[i]) split[static_cast<size_t>(edge)] = 1;
    }
    if (!SplitEdges(split)) return;
  }
}

bool DividedMesh::SplitEdges(const std::vector<uint8_t>& split) {
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
                   Middle(uvs[k], uvs[(k + 1) % 3])};
      cuts += middle[k].point >= 0 ? 1 : 0;
    }
    const auto add = [&](const Corner& a, const Corner& b, const Corner& c) {
      divided.triangles.push_back({a.point, b.point, c.point});
      if (!render_.uvs.empty()) divided.uvs.push_back({a.uv, b.uv, c.uv});
      sources.push_back(sources_[i]);
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
  sources_ = std::move(sources);
  NumberEdges();
  Place(first);
  return true;
}

int64_t DividedMesh::FindFace(const Triple& nodes) const {
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

int32_t DividedMesh::FindEdge(int32_t a, int32_t b) const {
  for (const int32_t edge : incidence_.node_edges[a]) {
    const auto [low, high] = incidence_.edges[static_cast<size_t>(edge)];
    if (low == b || high == b) return edge;
  }
  return -1;
}

double DividedMesh::CutShare(size_t edge) const {
  const auto from = static_cast<size_t>(edges_[edge][0]);
  const auto to = static_cast<size_t>(edges_[edge][1]);
  const auto lead = [&](size_t point, int32_t over) {
    const auto& nodes = mesh_.tets[static_cast<size_t>(places_[point].tet)];
    double own = 0, other = 0;
    for (size_t k = 0; k < 4; ++k) {
      if (nodes[k] == label(point)) own = places_[point].weights[k];
      if (nodes[k] == over) other = places_[point].weights[k];
    }
    return own - other;
  };
  const double a = lead(from, label(to));
  const double b = lead(to, label(from));
  // Not so near an end that triangles get thin beyond need.
  return a + b > 0 ? std::clamp(a / (a + b), 0.02, 0.98) : 0.5;
}

Vec3 DividedMesh::CutAt(size_t edge) const {
  return Mix(render_.points[static_cast<size_t>(edges_[edge][0])],
             render_.points[static_cast<size_t>(edges_[edge][1])], CutShare(edge));
}

}  // namespace cleave
