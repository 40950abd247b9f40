#include "core/surface/fans.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace cleave {
namespace {

// The triangles round one point, sorted into fans. Reused from point to point.
class FansRound {
 public:
  // Returns how many fans there are.
  size_t Sort(const SurfaceTopology& topology, int32_t point, std::span<const int32_t> triangles) {
    fan_of_.resize(triangles.size());
    neighbors_.clear();
    for (size_t i = 0; i < triangles.size(); ++i) {
      fan_of_[i] = i;
      for (const int32_t corner : topology.triangles[static_cast<size_t>(triangles[i])]) {
        if (corner != point) neighbors_.emplace_back(corner, i);
      }
    }
    // Triangles that share an edge are of one fan.
    std::sort(neighbors_.begin(), neighbors_.end());
    size_t fans = triangles.size();
    for (size_t k = 1; k < neighbors_.size(); ++k) {
      if (neighbors_[k].first != neighbors_[k - 1].first) continue;
      const size_t a = Root(neighbors_[k - 1].second), b = Root(neighbors_[k].second);
      if (a == b) continue;
      fan_of_[std::max(a, b)] = std::min(a, b);
      --fans;
    }
    return fans;
  }
  // A triangle of the fan, the same for all of it.
  size_t Root(size_t i) const {
    while (fan_of_[i] != i) i = fan_of_[i];
    return i;
  }

 private:
  std::vector<size_t> fan_of_;
  std::vector<std::pair<int32_t, size_t>> neighbors_;
};

}  // namespace

void SeparateFans(SurfaceTopology& topology) {
  const size_t point_count = topology.points.size();
  std::vector<size_t> offsets(point_count + 1, 0);
  for (const auto& triangle : topology.triangles) {
    for (const int32_t point : triangle) ++offsets[static_cast<size_t>(point) + 1];
  }
  for (size_t i = 0; i < point_count; ++i) offsets[i + 1] += offsets[i];
  std::vector<int32_t> items(offsets.back());
  std::vector<size_t> ends(offsets.begin(), offsets.end() - 1);
  for (size_t t = 0; t < topology.triangles.size(); ++t) {
    for (const int32_t point : topology.triangles[t])
      items[ends[static_cast<size_t>(point)]++] = static_cast<int32_t>(t);
  }

  FansRound round;
  for (size_t p = 0; p < point_count; ++p) {
    const auto point = static_cast<int32_t>(p);
    const std::span<int32_t> triangles(items.data() + offsets[p], offsets[p + 1] - offsets[p]);
    if (round.Sort(topology, point, triangles) < 2) continue;
    // By ids, so that it does not matter where triangles stand.
    std::sort(triangles.begin(), triangles.end(), [&](int32_t a, int32_t b) {
      return topology.triangle_ids[static_cast<size_t>(a)] <
             topology.triangle_ids[static_cast<size_t>(b)];
    });
    round.Sort(topology, point, triangles);
    size_t fans = 0;
    for (size_t i = 0; i < triangles.size(); ++i) {
      if (round.Root(i) != i || fans++ == 0 || fans > surface_id::kMaxFan + 1) continue;
      const auto copy = static_cast<int32_t>(topology.points.size());
      topology.points.push_back(topology.points[p]);
      topology.point_ids.push_back(surface_id::OfFan(topology.point_ids[p], fans - 1));
      for (size_t k = i; k < triangles.size(); ++k) {
        if (round.Root(k) != i) continue;
        for (int32_t& corner : topology.triangles[static_cast<size_t>(triangles[k])]) {
          if (corner == point) corner = copy;
        }
      }
    }
  }
}

}  // namespace cleave
