#include "core/mesh/tet_improver.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/counter_rng.h"

namespace cleave {
namespace {

using Cell = TetComplex::Cell;
constexpr int32_t kOutside = TetComplex::kOutside;
constexpr size_t kMostRingNodes = TetComplex::kMostRingNodes;

}  // namespace

TetImprover::TetImprover(PlacedPoints points, const std::vector<std::array<int32_t, 4>>& tets)
    : points_(std::move(points)), complex_(points_.positions.size(), tets) {}

// The smallest sine of a dihedral angle, with the sign of the volume: sin = 3 V l / (2 A B) for an
// edge of length l between faces of areas A and B.
double TetImprover::QualityOf(const std::array<int32_t, 4>& nodes) const {
  std::array<Eigen::Vector3d, 4> x;
  for (size_t k = 0; k < 4; ++k) {
    x[k] =
        Eigen::Map<const Eigen::Vector3d>(points_.positions[static_cast<size_t>(nodes[k])].data());
  }
  const Eigen::Vector3d e01 = x[1] - x[0], e02 = x[2] - x[0], e03 = x[3] - x[0];
  const Eigen::Vector3d e12 = x[2] - x[1], e13 = x[3] - x[1], e23 = x[3] - x[2];
  const Eigen::Vector3d n3 = e01.cross(e02);
  const double volume = n3.dot(e03);  // six times
  // Squared doubled areas, each opposite to its node.
  const double s0 = e12.cross(e13).squaredNorm();
  const double s1 = e02.cross(e03).squaredNorm();
  const double s2 = e01.cross(e03).squaredNorm();
  const double s3 = n3.squaredNorm();
  const double smallest = std::min({e01.squaredNorm() / (s2 * s3), e02.squaredNorm() / (s1 * s3),
                                    e03.squaredNorm() / (s1 * s2), e12.squaredNorm() / (s0 * s3),
                                    e13.squaredNorm() / (s0 * s2), e23.squaredNorm() / (s0 * s1)});
  const double quality = volume * std::sqrt(smallest);
  return std::isfinite(quality) ? quality : -1;
}

double TetImprover::Distance(int32_t a, int32_t b) const {
  const Vec3& p = points_.positions[static_cast<size_t>(a)];
  const Vec3& q = points_.positions[static_cast<size_t>(b)];
  return std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
}

// Two tets at a face become three round the edge between their apexes.
bool TetImprover::TurnFace(int32_t cell, size_t slot) {
  const int32_t other = CellAt(cell).neighbours[slot];
  if (other == kOutside) return false;
  const std::array<int32_t, 3> face = FaceOf(CellAt(cell).nodes, slot);
  const int32_t below = CellAt(cell).nodes[slot];
  int32_t above = kOutside;
  for (const int32_t node : CellAt(other).nodes) {
    if (std::find(face.begin(), face.end(), node) == face.end()) above = node;
  }
  const double before = std::min(QualityOf(cell), QualityOf(other));
  std::vector<std::array<int32_t, 4>> fresh;
  for (size_t i = 0; i < 3; ++i) {
    fresh.push_back({below, above, face[i], face[(i + 1) % 3]});
    if (QualityOf(fresh.back()) <= before) return false;
  }
  complex_.Replace({cell, other}, fresh);
  return true;
}

// The tets round an edge become two for each triangle of the best filling of their ring. On the
// surface the ring is open, and closing it turns the edge between two surface triangles.
bool TetImprover::RemoveEdge(int32_t cell, size_t slot_a, size_t slot_b) {
  if (!complex_.CollectRing(cell, CellAt(cell).nodes[slot_a], CellAt(cell).nodes[slot_b], ring_))
    return false;
  const size_t count = ring_.nodes.size();
  if (count < 3) return false;
  if (!ring_.closed) {
    // Only between triangles of one side may a surface edge turn, on a round one to be shorter.
    const Binding& a = points_.bindings[static_cast<size_t>(ring_.a)];
    const Binding& b = points_.bindings[static_cast<size_t>(ring_.b)];
    const int32_t u_node = ring_.nodes.front();
    const int32_t v_node = ring_.nodes.back();
    const Binding& u = points_.bindings[static_cast<size_t>(u_node)];
    const Binding& v = points_.bindings[static_cast<size_t>(v_node)];
    const bool flat =
        (a.fixed_axes & b.fixed_axes & u.fixed_axes & v.fixed_axes) != 0 &&
        std::abs(QualityOf({ring_.a, ring_.b, ring_.nodes.front(), ring_.nodes.back()})) < 1e-6;
    const bool round =
        a.radius > 0 && a.radius == b.radius && a.radius == u.radius && a.radius == v.radius;
    if (!flat && !(round && Distance(u_node, v_node) < Distance(ring_.a, ring_.b))) return false;
    if (complex_.HasEdge(u_node, v_node)) return false;
  }
  double before = std::numeric_limits<double>::infinity();
  for (const int32_t id : ring_.cells) before = std::min(before, QualityOf(id));

  // best[i][j]: the best smallest quality of a filling of the ring from node i to node j.
  std::array<std::array<double, kMostRingNodes + 1>, kMostRingNodes + 1> best;
  std::array<std::array<size_t, kMostRingNodes + 1>, kMostRingNodes + 1> choice{};
  const auto tets_of = [&](size_t i, size_t k, size_t j) {
    return std::array<std::array<int32_t, 4>, 2>{
        {{ring_.nodes[i], ring_.nodes[k], ring_.nodes[j], ring_.b},
         {ring_.nodes[i], ring_.nodes[j], ring_.nodes[k], ring_.a}}};
  };
  for (size_t span = 1; span < count; ++span) {
    for (size_t i = 0; i + span < count; ++i) {
      const size_t j = i + span;
      best[i][j] = span == 1 ? std::numeric_limits<double>::infinity() : -1;
      for (size_t k = i + 1; k < j; ++k) {
        const auto pair = tets_of(i, k, j);
        const double quality =
            std::min({best[i][k], best[k][j], QualityOf(pair[0]), QualityOf(pair[1])});
        if (quality > best[i][j]) {
          best[i][j] = quality;
          choice[i][j] = k;
        }
      }
      // Nothing that holds this part can do better than what there was.
    }
  }
  if (best[0][count - 1] <= before) return false;
  std::vector<std::array<int32_t, 4>> fresh;
  std::vector<std::pair<size_t, size_t>> parts = {{0, count - 1}};
  while (!parts.empty()) {
    const auto [i, j] = parts.back();
    parts.pop_back();
    if (j - i < 2) continue;
    const size_t k = choice[i][j];
    for (const auto& nodes : tets_of(i, k, j)) fresh.push_back(nodes);
    parts.push_back({i, k});
    parts.push_back({k, j});
  }
  complex_.Replace(ring_.cells, fresh);
  return true;
}

// Looks for a better place for a node, first towards the middle of its neighbours, then in random
// directions with ever smaller steps.
bool TetImprover::MoveNode(int32_t node) {
  const auto index = static_cast<size_t>(node);
  const Binding& binding = points_.bindings[index];
  if (binding.fixed_axes == 7) return false;
  const std::vector<int32_t>& star = complex_.StarOf(node);
  const auto worst = [&] {
    double quality = std::numeric_limits<double>::infinity();
    for (const int32_t id : star) quality = std::min(quality, QualityOf(id));
    return quality;
  };
  Vec3& position = points_.positions[index];
  const double before = worst();
  double quality = before;
  Vec3 best = position;
  const auto consider = [&](const Vec3& to) {
    const Vec3 from = position;
    position = Bound(binding, best, to);
    const double its = worst();
    if (its > quality) {
      quality = its;
      best = position;
    }
    position = from;
  };

  Vec3 middle{0, 0, 0};
  double size = 0;
  for (const int32_t id : star) {
    for (const int32_t other : CellAt(id).nodes) {
      const Vec3& p = points_.positions[static_cast<size_t>(other)];
      for (size_t axis = 0; axis < 3; ++axis) middle[axis] += p[axis];
      size += std::hypot(p[0] - position[0], p[1] - position[1], p[2] - position[2]);
    }
  }
  const auto corners = static_cast<double>(4 * star.size());
  for (double& coordinate : middle) coordinate /= corners;
  size /= corners;
  consider(middle);
  for (const double step : {0.3, 0.15, 0.08, 0.04}) {
    for (int direction = 0; direction < 8; ++direction) {
      Vec3 to = best;
      for (size_t axis = 0; axis < 3; ++axis) {
        const double draw = UniformDraw(0, RandomStream::kMeshJitter, draws_, 5 + axis);
        to[axis] += step * size * (2 * draw - 1);
      }
      ++draws_;
      consider(to);
    }
  }
  position = best;
  return quality > before;
}

void TetImprover::PeelRoundSide(double radius, double depth) {
  constexpr int kMostRounds = 20;
  const auto bridges = [&](const Cell& cell) {
    double x = 0;
    double y = 0;
    for (const int32_t node : cell.nodes) {
      const auto index = static_cast<size_t>(node);
      if (points_.bindings[index].radius != radius) return false;
      x += points_.positions[index][0] / 4;
      y += points_.positions[index][1] / 4;
    }
    return std::hypot(x, y) > radius - depth;
  };
  for (int round = 0; round < kMostRounds; ++round) {
    bool any = false;
    for (int32_t id = 0; id < complex_.cell_count(); ++id) {
      const Cell& cell = CellAt(id);
      if (!cell.alive || !bridges(cell)) continue;
      std::vector<size_t> bare;
      for (size_t slot = 0; slot < 4; ++slot) {
        if (cell.neighbours[slot] == kOutside) bare.push_back(slot);
      }
      // One bare face bridges a node of the side; two stand for the two triangles behind them.
      // Other tets hold the surface together.
      bool peel = false;
      if (bare.size() == 1) {
        peel = !complex_.OnSurface(cell.nodes[bare[0]]);
      } else if (bare.size() == 2) {
        peel = !complex_.CollectRing(id, cell.nodes[bare[0]], cell.nodes[bare[1]], ring_) ||
               ring_.closed;
      }
      if (!peel) continue;
      complex_.Remove(id);
      any = true;
    }
    if (!any) return;
  }
}

double TetImprover::Improve(double wanted, int passes) {
  double smallest = 0;
  for (int pass = 0; pass < passes; ++pass) {
    std::vector<std::pair<double, int32_t>> bad;
    smallest = std::numeric_limits<double>::infinity();
    for (int32_t id = 0; id < complex_.cell_count(); ++id) {
      if (!CellAt(id).alive) continue;
      const double quality = QualityOf(id);
      smallest = std::min(smallest, quality);
      if (quality < wanted) bad.push_back({quality, id});
    }
    std::sort(bad.begin(), bad.end());
    bool any = false;
    for (const auto& [quality, id] : bad) {
      // Work on another may have changed or taken this one.
      if (!CellAt(id).alive || QualityOf(id) >= wanted) continue;
      bool changed = false;
      for (size_t k = 0; k < 6 && !changed; ++k) {
        changed = RemoveEdge(id, static_cast<size_t>(kTetEdges[k][0]),
                             static_cast<size_t>(kTetEdges[k][1]));
      }
      for (size_t slot = 0; slot < 4 && !changed; ++slot) changed = TurnFace(id, slot);
      if (!changed) {
        const std::array<int32_t, 4> nodes = CellAt(id).nodes;
        for (const int32_t node : nodes) changed = MoveNode(node) || changed;
      }
      any = any || changed;
    }
    if (!any) break;
  }
  return smallest;
}

TetMesh TetImprover::Take() {
  TetMesh mesh;
  std::vector<int32_t> ids(points_.positions.size(), kOutside);
  for (int32_t cell_id = 0; cell_id < complex_.cell_count(); ++cell_id) {
    const Cell& cell = CellAt(cell_id);
    if (!cell.alive) continue;
    std::array<int32_t, 4> nodes = cell.nodes;
    for (int32_t& node : nodes) {
      int32_t& id = ids[static_cast<size_t>(node)];
      if (id == kOutside) {
        id = static_cast<int32_t>(mesh.rest_positions.size());
        mesh.rest_positions.push_back(points_.positions[static_cast<size_t>(node)]);
      }
      node = id;
    }
    mesh.tets.push_back(nodes);
  }
  return mesh;
}

}  // namespace cleave
