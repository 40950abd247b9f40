#include "core/stream/cube_index.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/counter_rng.h"
#include "gtest/gtest.h"

namespace cleave {
namespace {

using Cube = std::array<int64_t, 3>;

uint64_t CodeOf(const Cube& cube) {
  uint64_t code = 0;
  for (int bit = 0; bit < kMortonBits; ++bit) {
    for (size_t axis = 0; axis < 3; ++axis) {
      code |= (static_cast<uint64_t>(cube[axis]) >> bit & 1) << (3 * bit + static_cast<int>(axis));
    }
  }
  return code;
}

int64_t Pick(uint64_t index, uint64_t axis, int64_t below) {
  return static_cast<int64_t>(UniformDraw(5, RandomStream::kMeshJitter, index, axis) *
                              static_cast<double>(below));
}

// Those of a grid of `side` cubes along each axis that touch a cube, and itself.
std::vector<Cube> Around(const Cube& cube, int64_t side) {
  std::vector<Cube> around;
  for (int64_t x = cube[0] - 1; x <= cube[0] + 1; ++x) {
    for (int64_t y = cube[1] - 1; y <= cube[1] + 1; ++y) {
      for (int64_t z = cube[2] - 1; z <= cube[2] + 1; ++z) {
        if (std::min({x, y, z}) >= 0 && std::max({x, y, z}) < side) around.push_back({x, y, z});
      }
    }
  }
  return around;
}

TEST(CubeIndex, CubesAroundStayInTheGrid) {
  for (const int bits : {0, 9, 18, 20, 21}) {
    const int64_t side = int64_t{1} << (kMortonBits - bits);
    for (uint64_t round = 0; round < 60; ++round) {
      // Of three in four an axis is at a border.
      Cube cube = {Pick(round, 0, side), Pick(round, 1, side), Pick(round, 2, side)};
      if (round % 4 < 3) cube[round % 4] = round % 8 < 4 ? 0 : side - 1;
      const CubesAround around(CodeOf(cube) << (3 * bits), bits);
      std::vector<uint64_t> expected;
      for (const Cube& other : Around(cube, side)) expected.push_back(CodeOf(other));
      std::vector<uint64_t> found;
      for (const CubesAround::Some& some : around.blocks()) {
        for (uint64_t at = 0; at < 8; ++at) {
          if ((some.cubes >> at & 1) != 0) found.push_back(8 * some.block + at);
        }
      }
      std::sort(expected.begin(), expected.end());
      std::sort(found.begin(), found.end());
      ASSERT_EQ(found, expected) << bits << " " << round;
    }
  }
}

TEST(CubeIndex, GivesThePlacesOfEachCube) {
  std::vector<NodeOrder::Coarse> places;
  for (int32_t place = 0; place < 500; ++place) {
    const auto index = static_cast<uint64_t>(place);
    places.push_back({CodeOf({Pick(index, 0, 64), Pick(index, 1, 64), Pick(index, 2, 64)}), place});
  }
  std::sort(places.begin(), places.end(), [](const auto& a, const auto& b) {
    return a.code != b.code ? a.code < b.code : a.place < b.place;
  });
  constexpr int kBits = 3;
  const CubeIndex index(places, kBits);
  const auto in_cube = [&](uint64_t cube) {
    std::vector<int32_t> found;
    index.ForCubes({cube / 8, static_cast<uint8_t>(1u << cube % 8)},
                   [&](std::span<const int32_t> some) {
                     found.insert(found.end(), some.begin(), some.end());
                   });
    return found;
  };
  std::vector<int32_t> all;
  for (uint64_t cube = 0; cube < 512; ++cube) {
    std::vector<int32_t> expected;
    for (const auto& [code, place] : places) {
      if (code >> (3 * kBits) == cube) expected.push_back(place);
    }
    ASSERT_EQ(in_cube(cube), expected) << cube;
    all.insert(all.end(), expected.begin(), expected.end());
  }
  EXPECT_EQ(all.size(), places.size());
  EXPECT_TRUE(in_cube(1u << 20).empty());
  // Cubes of a block in turn, as one by one.
  std::vector<int32_t> found;
  for (uint64_t block = 0; block < 64; ++block) {
    index.ForCubes({block, 0xFF}, [&](std::span<const int32_t> some) {
      found.insert(found.end(), some.begin(), some.end());
    });
  }
  EXPECT_EQ(found, all);
}

}  // namespace
}  // namespace cleave
