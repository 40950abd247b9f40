#include "core/stream/near_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "core/stream/edge_graph.h"
#include "core/stream/node_order.h"
#include "core/stream/visible_places.h"
#include "gtest/gtest.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using namespace stream_test;

// A lattice and its near places, by definition.
class Scene {
 public:
  explicit Scene(const Body& body)
      : body_(body),
        order_(MakeNodeOrder(body_.rest)),
        graph_(order_, body_.edges),
        places_of_nodes_(order_.PlacesOfNodes()) {
    for (const int32_t node : order_.nodes) {
      rest_.push_back(body_.rest[static_cast<size_t>(node)]);
    }
    for (const uint64_t code : order_.codes) {
      std::array<int64_t, 3>& x = grid_.emplace_back();
      for (int bit = 0; bit < 63; ++bit) {
        x[static_cast<size_t>(bit % 3)] |= static_cast<int64_t>(code >> bit & 1) << (bit / 3);
      }
    }
    outer_ = VisiblePlaces(order_, body_.edges, body_.tets).marks();
    for (size_t edge = 0; edge < body_.edges.size(); ++edge) {
      const int32_t a = PlaceOf(body_.edges[edge][0]);
      const int32_t b = PlaceOf(body_.edges[edge][1]);
      edges_[{a, b}] = edges_[{b, a}] = static_cast<int32_t>(edge);
    }
  }

  int32_t count() const { return static_cast<int32_t>(rest_.size()); }
  NearPlaces near() const { return {order_, rest_, outer_, graph_}; }
  int32_t CoarserThan(int32_t place) const { return order_.group_begins[order_.GroupOf(place)]; }
  int32_t PlaceOf(int32_t node) const { return places_of_nodes_[static_cast<size_t>(node)]; }
  bool AreInTouchingCubes(int32_t a, int32_t b, int bits) const {
    for (size_t axis = 0; axis < 3; ++axis) {
      const int64_t cube_a = grid_[static_cast<size_t>(a)][axis] >> bits;
      const int64_t cube_b = grid_[static_cast<size_t>(b)][axis] >> bits;
      if (std::abs(cube_a - cube_b) > 1) return false;
    }
    return true;
  }
  bool IsOuter(int32_t place) const { return outer_[static_cast<size_t>(place)] != 0; }
  std::vector<std::pair<double, int32_t>> Nearest(int32_t place, size_t wanted,
                                                  bool outer_only) const {
    std::vector<std::pair<double, int32_t>> found;
    const int least = order_.cube_bits[order_.GroupOf(place)];
    for (int bits = least; bits <= std::min(least + 3, 21) && found.size() < 2 * wanted; ++bits) {
      found.clear();
      const Vec3& x = rest_[static_cast<size_t>(place)];
      for (int32_t other = 0; other < CoarserThan(place); ++other) {
        if (!AreInTouchingCubes(place, other, bits) || (outer_only && !IsOuter(other))) continue;
        const Vec3& y = rest_[static_cast<size_t>(other)];
        const double dx = y[0] - x[0];
        const double dy = y[1] - x[1];
        const double dz = y[2] - x[2];
        found.push_back({dx * dx + dy * dy + dz * dz, other});
      }
    }
    std::sort(found.begin(), found.end());
    if (found.size() > wanted) found.resize(wanted);
    return found;
  }
  int32_t EdgeBetween(int32_t a, int32_t b) const {
    const auto found = edges_.find({a, b});
    return found == edges_.end() ? -1 : found->second;
  }

 private:
  Body body_;
  NodeOrder order_;
  EdgeGraph graph_;
  std::vector<int32_t> places_of_nodes_;
  std::vector<Vec3> rest_;                    // by place
  std::vector<uint8_t> outer_;                // by place
  std::vector<std::array<int64_t, 3>> grid_;  // by place
  std::map<std::pair<int32_t, int32_t>, int32_t> edges_;
};

TEST(NearPlaces, AreTheNearestOfTheCoarserOnesInTheCubesThatHaveTwiceAsMany) {
  const Scene scene(LatticeBody(20, 15, 13));
  const NearPlaces near = scene.near();
  std::set<size_t> sizes;
  for (int32_t place = 0; place < scene.count(); ++place) {
    const auto coarser = static_cast<double>(scene.CoarserThan(place));
    std::set<std::pair<double, int32_t>> expected;
    if (coarser > 0) {
      const double rarity = std::floor(std::log2(static_cast<double>(scene.count()) / coarser));
      const double wanted = 24 * std::exp2(std::min(5.0, std::floor((rarity + 1) / 3)));
      for (const auto& one : scene.Nearest(place, static_cast<size_t>(wanted), false)) {
        expected.insert(one);
      }
    }
    if (scene.IsOuter(place)) {
      for (const auto& one : scene.Nearest(place, 16, true)) expected.insert(one);
    }
    std::vector<int32_t> places;
    for (const auto& [square, other] : expected) places.push_back(other);
    std::vector<int32_t> found;
    for (const NearPlaces::Near& one : near.Of(place)) found.push_back(one.place);
    ASSERT_EQ(found, places) << place;
    sizes.insert(found.size());
  }
  EXPECT_TRUE(sizes.contains(24));
  EXPECT_TRUE(sizes.contains(48));
  EXPECT_GT(*sizes.rbegin(), 48u);
}

TEST(NearPlaces, AreLedToByOneEdgeOrByTwoOverTheLowestPlace) {
  const Scene scene(LatticeBody(13, 9, 8));
  const NearPlaces near = scene.near();
  std::array<size_t, 3> by_edges{};
  for (int32_t place = 0; place < scene.count(); ++place) {
    for (const NearPlaces::Near& one : near.Of(place)) {
      std::array<int32_t, 2> expected = {near.no_edge(), near.no_edge()};
      if (const int32_t edge = scene.EdgeBetween(place, one.place); edge >= 0) {
        expected = {edge, edge};
        ++by_edges[1];
      } else {
        for (int32_t between = 0; between < scene.count(); ++between) {
          const int32_t to = scene.EdgeBetween(place, between);
          const int32_t on = scene.EdgeBetween(between, one.place);
          if (to < 0 || on < 0) continue;
          expected = {to, on};
          ++by_edges[2];
          break;
        }
      }
      by_edges[0] += expected[0] == near.no_edge() ? 1 : 0;
      ASSERT_EQ(one.edges, expected) << place << " " << one.place;
    }
  }
  for (const size_t some : by_edges) EXPECT_GT(some, static_cast<size_t>(scene.count()));
}

TEST(NearPlaces, KnowWhoReadsThem) {
  const Scene scene(LatticeBody(13, 9, 8));
  const NearPlaces near = scene.near();
  size_t pairs = 0;
  size_t of_readers = 0;
  for (int32_t place = 0; place < scene.count(); ++place) {
    pairs += near.Of(place).size();
    int32_t last = -1;
    for (const NearPlaces::Reader& reader : near.ReadersOf(place)) {
      EXPECT_GT(reader.place, last);
      last = reader.place;
      ASSERT_EQ(near.Of(reader.place)[static_cast<size_t>(reader.rank)].place, place);
      ++of_readers;
    }
  }
  EXPECT_EQ(of_readers, pairs);
}

}  // namespace
}  // namespace cleave
