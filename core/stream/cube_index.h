#ifndef CLEAVE_CORE_STREAM_CUBE_INDEX_H_
#define CLEAVE_CORE_STREAM_CUBE_INDEX_H_

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/stream/node_order.h"

namespace cleave {

inline constexpr int kMortonBits = 21;                    // of each axis in a Morton code
inline constexpr uint64_t kMortonX = 0x1249249249249249;  // those of x; of y, z one, two higher

// Of a grid of cubes, those that one touches and itself, by their Morton codes: 27, or less at the
// border of the grid.
class CubesAround {
 public:
  // The cube that has this Morton code of a position, of cubes that are 2^bits Morton steps wide.
  CubesAround(uint64_t code, int bits);

  std::span<const uint64_t> cubes() const { return {cubes_.data(), count_}; }

 private:
  std::array<uint64_t, 27> cubes_;
  size_t count_ = 0;
};

inline CubesAround::CubesAround(uint64_t code, int bits) {
  // Neighbours by arithmetic on each axis' bits in place.
  const uint64_t inside = (uint64_t{1} << (3 * (kMortonBits - bits))) - 1;
  const uint64_t cube = code >> (3 * bits);
  std::array<std::array<uint64_t, 3>, 3> along;  // by axis
  std::array<size_t, 3> counts{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const uint64_t mask = (kMortonX << axis) & inside;
    const uint64_t own = cube & mask;
    const uint64_t one = uint64_t{1} << axis;
    if (own != 0) along[axis][counts[axis]++] = (own - one) & mask;
    along[axis][counts[axis]++] = own;
    if (own != mask) along[axis][counts[axis]++] = ((own | ~mask) + one) & mask;
  }
  for (size_t x = 0; x < counts[0]; ++x) {
    for (size_t y = 0; y < counts[1]; ++y) {
      for (size_t z = 0; z < counts[2]; ++z) {
        cubes_[count_++] = along[0][x] | along[1][y] | along[2][z];
      }
    }
  }
}

// Which places are in each cube of a grid: a hash table of the cubes that have room for some.
class CubeIndex {
 public:
  CubeIndex() = default;
  // Room for these places, which are sorted by Morton code, in cubes that are 2^bits Morton steps
  // wide. All are in it.
  CubeIndex(std::span<const NodeOrder::Coarse> places, int bits) : bits_(bits) {
    const auto cube_of = [&](size_t at) { return places[at].code >> (3 * bits); };
    size_t cubes = 0;
    for (size_t at = 0; at < places.size(); ++at) {
      if (at == 0 || cube_of(at) != cube_of(at - 1)) ++cubes;
    }
    slots_.resize(std::bit_ceil(2 * cubes + 2));  // two at least
    shift_ = 64 - std::countr_zero(slots_.size());
    places_.resize(places.size());
    for (size_t at = 0; at < places.size(); ++at) {
      Slot& slot = slots_[Find(cube_of(at))];
      if (slot.begin < 0) slot = {cube_of(at), static_cast<int32_t>(at), 0};
      places_[static_cast<size_t>(slot.begin + slot.count++)] = places[at].place;
    }
  }

  // Takes all places out; one that there is room for is in again.
  void Clear() {
    for (Slot& slot : slots_) slot.count = 0;
  }
  void Add(uint64_t code, int32_t place) {
    Slot& slot = slots_[Find(code >> (3 * bits_))];
    places_[static_cast<size_t>(slot.begin + slot.count++)] = place;
  }

  bool empty() const { return places_.empty(); }  // of room
  int bits() const { return bits_; }
  // Fetches what In will read.
  void Prefetch(uint64_t cube) const { __builtin_prefetch(slots_.data() + Start(cube)); }
  // Those in the cube with this Morton code.
  std::span<const int32_t> In(uint64_t cube) const {
    const Slot& slot = slots_[Find(cube)];
    if (slot.count == 0) return {};
    return {places_.data() + slot.begin, static_cast<size_t>(slot.count)};
  }

 private:
  struct Slot {
    uint64_t cube = 0;
    int32_t begin = -1;  // in places_; -1: the slot is free
    int32_t count = 0;
  };

  size_t Start(uint64_t cube) const { return (cube * 0x9E3779B97F4A7C15u) >> shift_; }
  // The slot of this cube, or the free one that it would take.
  size_t Find(uint64_t cube) const {
    size_t at = Start(cube);
    while (slots_[at].begin >= 0 && slots_[at].cube != cube) at = (at + 1) % slots_.size();
    return at;
  }

  int bits_ = 0;
  std::vector<Slot> slots_;      // a power of two, at most half of them taken
  std::vector<int32_t> places_;  // those of a cube one after the other
  int shift_ = 63;
};

// A set of cubes of a grid: a hash table of blocks of 4 x 4 x 4 cubes, a bit for each. The six
// lowest bits of a cube's Morton code are its position in the block.
class CubeSet {
 public:
  // Makes it empty. Of cubes that are 2^bits Morton steps wide.
  void Clear(int bits);
  void Add(uint64_t cube) { Block(cube >> 6) |= uint64_t{1} << (cube & 63); }
  // Adds the cubes that touch any of the set.
  void Widen();
  bool Has(uint64_t cube) const { return (slots_[Find(cube >> 6)].cubes >> (cube & 63) & 1) != 0; }

 private:
  struct Slot {
    uint64_t block = ~uint64_t{0};
    uint64_t cubes = 0;  // 0: the slot is free
  };

  uint64_t& Block(uint64_t block);
  size_t Find(uint64_t block) const {
    size_t at = (block * 0x9E3779B97F4A7C15u) >> shift_;
    while (slots_[at].cubes != 0 && slots_[at].block != block) at = (at + 1) % slots_.size();
    return at;
  }

  std::vector<Slot> slots_ = std::vector<Slot>(2);  // a power of two, at most half of them taken
  int shift_ = 63;
  size_t count_ = 0;
  uint64_t inside_ = 0;  // the bits that Morton codes of blocks have
  std::vector<Slot> scratch_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_CUBE_INDEX_H_
