#include "core/mesh/tet_clip.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

constexpr int kBisections = 12;  // a cut is found to this power of 1/2 of its edge
// Shares of an edge: a node so near to a cut moves onto it; where it cannot, the cut keeps away.
constexpr double kNear = 0.35;
constexpr double kClear = 0.2;
// A tet may lose all but this share of its volume to moved nodes.
constexpr double kLeastVolume = 0.2;

enum Side : int8_t { kInside = -1, kOn = 0, kOutside = 1 };

Eigen::Vector3d ToEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }

class Clipper {
 public:
  Clipper(const TetMesh& mesh, const std::function<bool(const Eigen::Vector3d&)>& inside)
      : mesh_(mesh), inside_(inside), incidence_(BuildIncidence(mesh)) {}

  ClippedTets Clip() {
    FindSides();
    FindCuts();
    MoveNodes();
    result_.on_surface.assign(mesh_.rest_positions.size(), 0);
    for (size_t node = 0; node < sides_.size(); ++node)
      result_.on_surface[node] = sides_[node] == kOn ? 1 : 0;
    result_.mesh.rest_positions = mesh_.rest_positions;
    for (const auto& tet : mesh_.tets) CutTet(tet);
    return std::move(result_);
  }

 private:
  Side& SideOf(int32_t node) { return sides_[static_cast<size_t>(node)]; }
  Eigen::Vector3d At(int32_t node) const {
    return ToEigen(mesh_.rest_positions[static_cast<size_t>(node)]);
  }

  void FindSides() {
    sides_.resize(mesh_.rest_positions.size());
    ParallelFor(mesh_.node_count(), 256, [&](int64_t begin, int64_t end) {
      for (int64_t n = begin; n < end; ++n)
        SideOf(static_cast<int32_t>(n)) = inside_(At(static_cast<int32_t>(n))) ? kInside : kOutside;
    });
  }

  // Where along each edge the surface is, from its first node; 0 where it does not cross it.
  void FindCuts() {
    cuts_.assign(incidence_.edges.size(), 0);
    ParallelFor(static_cast<int64_t>(cuts_.size()), 64, [&](int64_t begin, int64_t end) {
      for (int64_t e = begin; e < end; ++e) {
        const auto [i, j] = incidence_.edges[static_cast<size_t>(e)];
        if (SideOf(i) == SideOf(j)) continue;
        const Eigen::Vector3d a = At(i), b = At(j);
        double low = 0, high = 1;
        for (int step = 0; step < kBisections; ++step) {
          const double middle = 0.5 * (low + high);
          const bool as_first = inside_(a + middle * (b - a)) == (SideOf(i) == kInside);
          (as_first ? low : high) = middle;
        }
        cuts_[static_cast<size_t>(e)] = 0.5 * (low + high);
      }
    });
  }

  // Node by node, onto the nearest cut of its edges.
  void MoveNodes() {
    for (size_t node = 0; node < sides_.size(); ++node) {
      std::vector<std::pair<double, int32_t>> near;
      for (const int32_t e : incidence_.node_edges[static_cast<int64_t>(node)]) {
        const auto& ends = incidence_.edges[static_cast<size_t>(e)];
        const double cut = cuts_[static_cast<size_t>(e)];
        if (cut == 0) continue;
        // An end that has moved onto the surface took the cut with it.
        if (SideOf(ends[0]) == kOn || SideOf(ends[1]) == kOn) continue;
        const double share = static_cast<size_t>(ends[0]) == node ? cut : 1 - cut;
        if (share < kNear) near.push_back({share * (At(ends[0]) - At(ends[1])).norm(), e});
      }
      std::sort(near.begin(), near.end());
      for (const auto& [distance, e] : near) {
        const auto& ends = incidence_.edges[static_cast<size_t>(e)];
        const Eigen::Vector3d to =
            At(ends[0]) + cuts_[static_cast<size_t>(e)] * (At(ends[1]) - At(ends[0]));
        if (!Move(node, to)) continue;
        sides_[node] = kOn;
        break;
      }
    }
  }

  bool Move(size_t node, const Eigen::Vector3d& to) {
    const std::span<const int32_t> tets = incidence_.node_tets[static_cast<int64_t>(node)];
    Vec3& place = mesh_.rest_positions[node];
    const Vec3 from = place;
    std::vector<double> before;
    for (const int32_t tet : tets) before.push_back(SignedVolume(CornersOf(mesh_, tet)));
    place = {to[0], to[1], to[2]};
    for (size_t k = 0; k < tets.size(); ++k) {
      if (SignedVolume(CornersOf(mesh_, tets[k])) > kLeastVolume * before[k]) continue;
      place = from;
      return false;
    }
    return true;
  }

  // The node where the surface crosses the edge of an inner and an outer node.
  int32_t Cut(int32_t in, int32_t out) {
    const auto [found, added] = nodes_of_cuts_.try_emplace(
        std::pair(std::min(in, out), std::max(in, out)), result_.mesh.node_count());
    if (added) {
      const auto& [first, second] = found->first;
      const auto edge = std::lower_bound(incidence_.edges.begin(), incidence_.edges.end(),
                                         std::array<int32_t, 2>{first, second});
      const double share = std::clamp(cuts_[static_cast<size_t>(edge - incidence_.edges.begin())],
                                      kClear, 1 - kClear);
      const Eigen::Vector3d at = At(first) + share * (At(second) - At(first));
      result_.mesh.rest_positions.push_back({at[0], at[1], at[2]});
      result_.on_surface.push_back(1);
    }
    return static_cast<int32_t>(found->second);
  }

  void Add(int32_t a, int32_t b, int32_t c, int32_t d) {
    result_.mesh.tets.push_back({a, b, c, d});
    auto& tet = result_.mesh.tets.back();
    if (SignedVolume(CornersOf(result_.mesh, result_.mesh.tet_count() - 1)) < 0)
      std::swap(tet[2], tet[3]);
  }

  double Distance(int32_t a, int32_t b) const {
    return (ToEigen(result_.mesh.rest_positions[static_cast<size_t>(a)]) -
            ToEigen(result_.mesh.rest_positions[static_cast<size_t>(b)]))
        .norm();
  }

  // Quads on faces between tets are cut from the inner node of the smaller id, so that both sides
  // agree.
  void CutTet(const std::array<int32_t, 4>& tet) {
    std::vector<int32_t> in, on, out;
    for (const int32_t node : tet)
      (SideOf(node) == kInside ? in : SideOf(node) == kOn ? on : out).push_back(node);
    std::sort(in.begin(), in.end());
    if (in.empty()) return;
    if (out.empty()) return Add(tet[0], tet[1], tet[2], tet[3]);
    if (in.size() == 1) {
      std::array<int32_t, 4> rest{in[0], 0, 0, 0};
      size_t filled = 1;
      for (const int32_t node : on) rest[filled++] = node;
      for (const int32_t node : out) rest[filled++] = Cut(in[0], node);
      return Add(rest[0], rest[1], rest[2], rest[3]);
    }
    if (in.size() == 2 && out.size() == 1) {
      const int32_t a = Cut(in[0], out[0]), b = Cut(in[1], out[0]);
      Add(on[0], in[0], in[1], b);
      Add(on[0], in[0], b, a);
      return;
    }
    if (in.size() == 2) {
      const int32_t ac = Cut(in[0], out[0]), ad = Cut(in[0], out[1]);
      const int32_t bc = Cut(in[1], out[0]), bd = Cut(in[1], out[1]);
      Add(in[0], in[1], bc, bd);
      if (Distance(ac, bd) <= Distance(ad, bc)) {
        Add(in[0], ac, ad, bd);
        Add(in[0], ac, bd, bc);
      } else {
        Add(in[0], ac, ad, bc);
        Add(in[0], ad, bd, bc);
      }
      return;
    }
    const int32_t a = Cut(in[0], out[0]), b = Cut(in[1], out[0]), c = Cut(in[2], out[0]);
    Add(in[0], in[1], in[2], c);
    Add(in[0], in[1], b, c);
    Add(in[0], a, b, c);
  }

  TetMesh mesh_;
  const std::function<bool(const Eigen::Vector3d&)>& inside_;
  const Incidence incidence_;
  std::vector<Side> sides_;
  std::vector<double> cuts_;  // an edge each
  std::map<std::pair<int32_t, int32_t>, int64_t> nodes_of_cuts_;
  ClippedTets result_;
};

}  // namespace

ClippedTets ClipTets(const TetMesh& mesh,
                     const std::function<bool(const Eigen::Vector3d&)>& inside) {
  return Clipper(mesh, inside).Clip();
}

}  // namespace cleave
