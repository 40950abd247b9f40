#ifndef CLEAVE_CORE_STREAM_CUBE_INDEX_H_
#define CLEAVE_CORE_STREAM_CUBE_INDEX_H_

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/large_vector.h"
#include "core/stream/node_order.h"

namespace cleave {

inline constexpr int kMortonBits = 21;                    // of each axis in a Morton code
inline constexpr uint64_t kMortonX = 0x1249249249249249;  // those of x; of y, z one, two higher

// Of a grid of cubes, those that one touches and itself, 27 or less at the border of the grid: by
// blocks of 2 x 2 x 2. The three lowest bits of a cube's Morton code are its position in the block.
class CubesAround {
 public:
  struct Some {
    uint64_t block;  // Morton code of the cubes without those bits
    uint8_t cubes;   // a bit for each position
  };
  // The cube that has this Morton code of a position, of cubes that are 2^bits Morton steps wide.
  CubesAround(uint64_t code, int bits);

  std::span<const Some> blocks() const& { return {blocks_.data(), count_}; }
  std::span<const Some> blocks() && = delete;  // a loop over it would outlive what it reads

 private:
  std::array<Some, 8> blocks_;
  size_t count_ = 0;
};

inline CubesAround::CubesAround(uint64_t code, int bits) {
  constexpr std::array<uint8_t, 3> kLow = {0x55, 0x33, 0x0F};  // the lower half along each axis
  // Neighbours by arithmetic on each axis' bits in place.
  const uint64_t inside = (uint64_t{1} << (3 * (kMortonBits - bits))) - 1;
  const uint64_t cube = code >> (3 * bits);
  std::array<std::array<Some, 2>, 3> along;
  std::array<size_t, 3> counts{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const uint64_t mask = (kMortonX << axis) & (inside >> 3);
    const uint64_t own = (cube >> 3) & mask;
    const uint64_t one = uint64_t{1} << axis;
    const uint8_t low = kLow[axis];
    const auto high = static_cast<uint8_t>(~low);
    const bool is_low = (cube >> axis & 1) == 0;
    along[axis][counts[axis]++] = {own, inside == 0 ? low : uint8_t{0xFF}};
    if (is_low && own != 0) {
      along[axis][counts[axis]++] = {(own - one) & mask, high};
    } else if (!is_low && own != mask) {
      along[axis][counts[axis]++] = {((own | ~mask) + one) & mask, low};
    }
  }
  for (size_t x = 0; x < counts[0]; ++x) {
    for (size_t y = 0; y < counts[1]; ++y) {
      for (size_t z = 0; z < counts[2]; ++z) {
        blocks_[count_++] = {
            along[0][x].block | along[1][y].block | along[2][z].block,
            static_cast<uint8_t>(along[0][x].cubes & along[1][y].cubes & along[2][z].cubes)};
      }
    }
  }
}

// Which places are in each cube of a grid: a hash table of the blocks of 2 x 2 x 2 cubes that have
// some.
class CubeIndex {
 public:
  CubeIndex() = default;
  // Of these places, which are sorted by Morton code, in cubes that are 2^bits Morton steps
  // wide. Precondition: at most 65,535 in a cube; places coarser than a group (NodeOrder) are at
  // most 4096, as 3 * bits is below the group's top level + 12 and no two of them are one from
  // there on.
  CubeIndex(std::span<const NodeOrder::Coarse> places, int bits) : bits_(bits) {
    const auto block_of = [&](size_t at) { return places[at].code >> (3 * bits) >> 3; };
    size_t blocks = 0;
    for (size_t at = 0; at < places.size(); ++at) {
      if (at == 0 || block_of(at) != block_of(at - 1)) ++blocks;
    }
    slots_.resize(std::bit_ceil(2 * blocks + 2));  // two at least
    shift_ = 64 - std::countr_zero(slots_.size());
    places_.resize(places.size());
    for (size_t at = 0; at < places.size(); ++at) {
      Slot& slot = slots_[Find(block_of(at))];
      slot.block = block_of(at);
      const size_t cube = places[at].code >> (3 * bits) & 7;
      if (slot.counts[cube] == 0) slot.begins[cube] = static_cast<int32_t>(at);
      ++slot.counts[cube];
      places_[at] = places[at].place;
    }
  }

  int bits() const { return bits_; }
  // Fetches what ForCubes will read.
  void Prefetch(uint64_t block) const { __builtin_prefetch(slots_.data() + Start(block)); }
  // Calls visit(places) for each of these cubes that has some.
  template <typename Visit>
  void ForCubes(const CubesAround::Some& some, const Visit& visit) const {
    const Slot& slot = slots_[Find(some.block)];
    for (unsigned left = some.cubes; left != 0; left &= left - 1) {
      const auto cube = static_cast<size_t>(std::countr_zero(left));
      if (slot.counts[cube] == 0) continue;
      visit(std::span<const int32_t>(places_.data() + slot.begins[cube], slot.counts[cube]));
    }
  }

 private:
  static constexpr uint64_t kFree = ~uint64_t{0};
  struct alignas(64) Slot {
    uint64_t block = kFree;
    std::array<int32_t, 8> begins{};  // in places_, of each cube
    std::array<uint16_t, 8> counts{};
  };

  size_t Start(uint64_t block) const { return (block * 0x9E3779B97F4A7C15u) >> shift_; }
  // The slot of this block, or the free one that it would take.
  size_t Find(uint64_t block) const {
    size_t at = Start(block);
    while (slots_[at].block != block && slots_[at].block != kFree) at = (at + 1) % slots_.size();
    return at;
  }

  int bits_ = 0;
  LargeVector<Slot> slots_;      // a power of two, at most half of them taken
  std::vector<int32_t> places_;  // those of a cube one after the other
  int shift_ = 63;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_CUBE_INDEX_H_
