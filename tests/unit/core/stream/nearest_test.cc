#include "core/stream/nearest.h"

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/base/int4.h"
#include "gtest/gtest.h"

namespace cleave {
namespace {

// On a lattice of few places, where many are as far, or spread out, where none are.
std::vector<Vec3> Positions(int32_t count, bool lattice) {
  std::vector<Vec3> positions;
  for (int32_t place = 0; place < count; ++place) {
    Vec3 x;
    for (size_t axis = 0; axis < 3; ++axis) {
      x[axis] = UniformDraw(5, RandomStream::kMeshJitter, static_cast<uint64_t>(place), axis);
      if (lattice) x[axis] = static_cast<double>(static_cast<int>(5 * x[axis]));
    }
    positions.push_back(x);
  }
  return positions;
}

TEST(Nearest, AreTheFirstByDistanceAndThenByPlaceEachOnce) {
  const Vec3 centre = {1, 0.5, 0.25};
  for (const bool lattice : {false, true}) {
    for (const int32_t count : {0, 1, 7, 8, 9, 16, 17, 60, 255, 256, 257, 700}) {
      for (const int32_t times : {1, 2}) {
        const std::vector<Vec3> positions = Positions(count, lattice);
        std::vector<std::tuple<double, int32_t>> expected;
        Nearest nearest(centre);
        for (int32_t time = 0; time < times; ++time) {
          for (int32_t place = 0; place < count; ++place) {
            const Vec3& x = positions[static_cast<size_t>(place)];
            nearest.Offer(place, x, place % 5 != 3);
            if (place % 5 == 3 || time > 0) continue;
            const double dx = x[0] - centre[0];
            const double dy = x[1] - centre[1];
            const double dz = x[2] - centre[2];
            expected.push_back({dx * dx + dy * dy + dz * dz, place});
          }
        }
        std::sort(expected.begin(), expected.end());
        expected.resize(std::min(expected.size(), kStencilNodes));
        nearest.Settle();
        ASSERT_EQ(nearest.count(), expected.size()) << count << " places, " << times << " times";
        for (size_t at = 0; at < expected.size(); ++at) {
          EXPECT_EQ(nearest[at], std::get<1>(expected[at])) << count << " places, " << at;
        }
      }
    }
  }
}

TEST(Integers, ProductsAndShiftsOfLanesAreExact) {
  const Int32x4 v = {-2147483647 - 1, 2147483647, -1, 12345};
  for (const int32_t factor : {1, -1, 32768, -262144, 262144 + 32768}) {
    const Int64x4 product = WideProduct(v, factor);
    const Int64x4 shifted = ShiftRight<15>(product);
    const Double4 doubles = ToDoubles(shifted);
    for (int lane = 0; lane < 4; ++lane) {
      EXPECT_EQ(product[lane], int64_t{v[lane]} * factor);
      EXPECT_EQ(shifted[lane], (int64_t{v[lane]} * factor) >> 15);
      EXPECT_EQ(doubles[lane], static_cast<double>(shifted[lane]));
    }
  }
}

}  // namespace
}  // namespace cleave
