#include "core/surface/shared_edges.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <span>
#include <tuple>
#include <utility>

namespace cleave {
namespace {

using Eigen::Vector3d;

constexpr double kFlat = 1e-6;  // rad

// Side `k` of a triangle: from its corner k to the next.
struct Side {
  int32_t triangle = 0;
  uint8_t k = 0;
};

struct SidedEdge {
  int32_t to = 0;
  Side side;
};

class EdgeParting {
 public:
  EdgeParting(SurfaceTopology& topology, std::vector<CornerUvs>& uvs, std::vector<int32_t>& sources)
      : topology_(topology), uvs_(uvs), sources_(sources) {}

  void Run() {
    FindShared();
    for (auto& [edge, sides] : shared_) Part(edge[0], edge[1], sides);
    for (const auto& [triangle, middles] : middles_) Divide(triangle, middles);
  }

 private:
  using Edge = std::array<int32_t, 2>;
  // Sides that run along an edge, and those that run back.
  using Sides = std::array<std::vector<Side>, 2>;

  int32_t CornerOf(const Side& side, size_t offset) const {
    return topology_.triangles[static_cast<size_t>(side.triangle)][(side.k + offset) % 3];
  }
  Vector3d At(int32_t point) const {
    return Vector3d(topology_.points[static_cast<size_t>(point)].rest.data());
  }
  SurfaceId IdOf(const Side& side) const {
    return topology_.triangle_ids[static_cast<size_t>(side.triangle)];
  }

  SurfaceId PointIdOf(int32_t point) const {
    return topology_.point_ids[static_cast<size_t>(point)];
  }

  void FindShared() {
    const size_t point_count = topology_.points.size();
    std::vector<size_t> offsets(point_count + 1, 0);
    for (const auto& triangle : topology_.triangles) {
      for (const int32_t point : triangle) ++offsets[static_cast<size_t>(point) + 1];
    }
    for (size_t i = 0; i < point_count; ++i) offsets[i + 1] += offsets[i];
    std::vector<SidedEdge> items(offsets.back());
    std::vector<size_t> ends(offsets.begin(), offsets.end() - 1);
    for (size_t t = 0; t < topology_.triangles.size(); ++t) {
      for (uint8_t k = 0; k < 3; ++k) {
        const Side side{static_cast<int32_t>(t), k};
        items[ends[static_cast<size_t>(CornerOf(side, 0))]++] = {CornerOf(side, 1), side};
      }
    }
    std::vector<Edge> found;
    for (size_t p = 0; p < point_count; ++p) {
      const std::span<SidedEdge> from(items.data() + offsets[p], offsets[p + 1] - offsets[p]);
      std::sort(from.begin(), from.end(),
                [](const SidedEdge& a, const SidedEdge& b) { return a.to < b.to; });
      for (size_t i = 1; i < from.size(); ++i) {
        if (from[i].to != from[i - 1].to) continue;
        const auto own = static_cast<int32_t>(p);
        const bool is_first = topology_.point_ids[p] < PointIdOf(from[i].to);
        found.push_back(is_first ? Edge{own, from[i].to} : Edge{from[i].to, own});
      }
    }
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    for (const Edge& edge : found) {
      for (size_t way = 0; way < 2; ++way) {
        const auto begin = static_cast<size_t>(edge[way]);
        const std::span<SidedEdge> from(items.data() + offsets[begin],
                                        offsets[begin + 1] - offsets[begin]);
        for (const SidedEdge& at : from) {
          if (at.to == edge[1 - way]) shared_[edge][way].push_back(at.side);
        }
      }
    }
  }

  // How far to turn, through what is solid, from a triangle whose side runs from a to b to one
  // whose side runs back, in (0, 2 pi]: two that lie on each other are of a crack that has not
  // opened.
  double SolidAngle(int32_t a, int32_t b, const Side& forward, const Side& back) const {
    const Vector3d along = (At(b) - At(a)).normalized();
    const Vector3d first = At(CornerOf(forward, 2)) - At(a);
    const Vector3d second = At(CornerOf(back, 2)) - At(a);
    const Vector3d u = first - first.dot(along) * along;
    const Vector3d w =
        u.cross(along);  // into the solid: a triangle turns anticlockwise from outside
    const double angle = std::atan2(second.dot(w), second.dot(u));
    return angle < kFlat ? angle + 2 * M_PI : angle;
  }

  void Part(int32_t a, int32_t b, Sides& sides) {
    for (std::vector<Side>& way : sides) {
      std::sort(way.begin(), way.end(), [&](const Side& x, const Side& y) {
        return std::pair(IdOf(x), x.k) < std::pair(IdOf(y), y.k);
      });
    }
    // (not the same cell's, angle, forward, back)
    std::vector<std::tuple<bool, double, size_t, size_t>> choices;
    for (size_t i = 0; i < sides[0].size(); ++i) {
      for (size_t j = 0; j < sides[1].size(); ++j) {
        const auto x = static_cast<size_t>(sides[0][i].triangle);
        const auto y = static_cast<size_t>(sides[1][j].triangle);
        const bool same_cell = topology_.inside[x] != 0 && topology_.inside[y] != 0 &&
                               topology_.nodes[x] == topology_.nodes[y];
        choices.emplace_back(!same_cell, SolidAngle(a, b, sides[0][i], sides[1][j]), i, j);
      }
    }
    std::sort(choices.begin(), choices.end());
    std::array<std::vector<uint8_t>, 2> taken{std::vector<uint8_t>(sides[0].size(), 0),
                                              std::vector<uint8_t>(sides[1].size(), 0)};
    bool keeps = true;  // the first two that are found
    for (const auto& [other, angle, i, j] : choices) {
      if (taken[0][i] != 0 || taken[1][j] != 0) continue;
      taken[0][i] = taken[1][j] = 1;
      if (!std::exchange(keeps, false)) AddMiddle(a, b, sides[0][i], sides[1][j]);
    }
  }

  void AddMiddle(int32_t a, int32_t b, const Side& forward, const Side& back) {
    const auto at = static_cast<int32_t>(topology_.points.size());
    topology_.points.push_back(Between(topology_.points[static_cast<size_t>(a)],
                                       topology_.points[static_cast<size_t>(b)]));
    topology_.point_ids.push_back(surface_id::OfHalf(IdOf(forward), forward.k));
    for (const Side& side : {forward, back}) {
      auto [entry, is_new] =
          middles_.try_emplace(side.triangle, std::array<int32_t, 3>{-1, -1, -1});
      entry->second[side.k] = at;
    }
  }

  // Carried by the nodes of both, or where that are too many by the first one's.
  static SurfacePoint Between(const SurfacePoint& a, const SurfacePoint& b) {
    SurfacePoint middle = a;
    for (size_t axis = 0; axis < 3; ++axis) middle.rest[axis] = 0.5 * (a.rest[axis] + b.rest[axis]);
    for (double& weight : middle.weights) weight *= 0.5;
    middle.off_nodes = a.off_nodes || b.off_nodes;
    for (size_t i = 0; i < b.node_count; ++i) {
      const auto end = middle.nodes.begin() + middle.node_count;
      auto place = static_cast<size_t>(std::find(middle.nodes.begin(), end, b.nodes[i]) -
                                       middle.nodes.begin());
      if (place == middle.nodes.size()) {
        middle = a;
        for (size_t axis = 0; axis < 3; ++axis)
          middle.rest[axis] = 0.5 * (a.rest[axis] + b.rest[axis]);
        middle.off_nodes = true;
        return middle;
      }
      if (place == middle.node_count) middle.nodes[middle.node_count++] = b.nodes[i];
      middle.weights[place] += 0.5 * b.weights[i];
      if ((b.owners >> i & 1) != 0) middle.owners |= static_cast<uint8_t>(1u << place);
    }
    return middle;
  }

  // Replaces a triangle by the parts between its corners and the points on its sides.
  void Divide(int32_t triangle, const std::array<int32_t, 3>& middles) {
    const auto own = static_cast<size_t>(triangle);
    const std::array<int32_t, 3> corners = topology_.triangles[own];
    size_t mask = 0;
    for (size_t k = 0; k < 3; ++k) mask |= middles[k] >= 0 ? size_t{1} << k : 0;
    // Corner k is place 2 k, the point on side k the one after it.
    std::vector<size_t> polygon;
    std::vector<std::array<size_t, 3>> parts;
    for (size_t k = 0; k < 3; ++k) {
      const size_t before = (k + 2) % 3;
      if (middles[before] >= 0 && middles[k] >= 0) {
        parts.push_back({2 * before + 1, 2 * k, 2 * k + 1});  // so that no other part is flat
      } else {
        polygon.push_back(2 * k);
      }
      if (middles[k] >= 0) polygon.push_back(2 * k + 1);
    }
    // The fan begins at a point on a side, as from a corner one along a side is flat.
    std::rotate(polygon.begin(),
                std::find_if(polygon.begin(), polygon.end(), [](size_t at) { return at % 2 != 0; }),
                polygon.end());
    for (size_t i = 1; i + 1 < polygon.size(); ++i)
      parts.push_back({polygon[0], polygon[i], polygon[i + 1]});
    const SurfaceId id = topology_.triangle_ids[own];
    const CornerUvs whole = uvs_.empty() ? CornerUvs{} : uvs_[own];
    for (size_t part = 0; part < parts.size(); ++part) {
      const size_t at = part == 0 ? own : topology_.triangles.size();
      if (part > 0) {
        topology_.triangles.emplace_back();
        topology_.triangle_ids.emplace_back();
        topology_.nodes.push_back(topology_.nodes[own]);
        topology_.tets.push_back(topology_.tets[own]);
        topology_.inside.push_back(topology_.inside[own]);
        if (!uvs_.empty()) uvs_.emplace_back();
        if (!sources_.empty()) sources_.push_back(sources_[own]);
      }
      topology_.triangle_ids[at] = surface_id::OfPart(id, mask, part);
      for (size_t corner = 0; corner < 3; ++corner) {
        const size_t place = parts[part][corner];
        const size_t k = place / 2;
        topology_.triangles[at][corner] = place % 2 == 0 ? corners[k] : middles[k];
        if (uvs_.empty()) continue;
        uvs_[at][corner] = whole[k];
        if (place % 2 == 0) continue;
        for (size_t i = 0; i < 2; ++i)
          uvs_[at][corner][i] = 0.5f * (whole[k][i] + whole[(k + 1) % 3][i]);
      }
    }
  }

  SurfaceTopology& topology_;
  std::vector<CornerUvs>& uvs_;
  std::vector<int32_t>& sources_;
  std::map<Edge, Sides> shared_;                       // by points, that of the smaller id first
  std::map<int32_t, std::array<int32_t, 3>> middles_;  // points on sides of triangles, or -1
};

}  // namespace

void SeparateSharedEdges(SurfaceTopology& topology, std::vector<CornerUvs>& uvs,
                         std::vector<int32_t>& sources) {
  EdgeParting(topology, uvs, sources).Run();
}

}  // namespace cleave
