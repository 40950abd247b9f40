#ifndef CLEAVE_CORE_STREAM_CUBE_INDEX_H_
#define CLEAVE_CORE_STREAM_CUBE_INDEX_H_

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/stream/node_order.h"

namespace cleave {

// Where the places of each cube of a grid stand in a list that is sorted by Morton code: a hash
// table of the cubes that have some.
class CubeIndex {
 public:
  CubeIndex() = default;
  // Cubes are 2^bits Morton steps wide.
  CubeIndex(std::span<const NodeOrder::Coarse> places, int bits) {
    const auto cube_of = [&](size_t at) { return places[at].code >> (3 * bits); };
    size_t cubes = 0;
    for (size_t at = 0; at < places.size(); ++at) {
      if (at == 0 || cube_of(at) != cube_of(at - 1)) ++cubes;
    }
    slots_.resize(std::bit_ceil(2 * cubes + 2));  // two at least
    shift_ = 64 - std::countr_zero(slots_.size());
    for (size_t begin = 0; begin < places.size();) {
      size_t end = begin + 1;
      while (end < places.size() && cube_of(end) == cube_of(begin)) ++end;
      Slot& slot = slots_[Find(cube_of(begin))];
      slot = {cube_of(begin), static_cast<int32_t>(begin), static_cast<int32_t>(end)};
      begin = end;
    }
  }

  // Fetches what In will read.
  void Prefetch(uint64_t cube) const { __builtin_prefetch(slots_.data() + Start(cube)); }
  // Those of `places`, which the index was made of, that are in the cube with this Morton code.
  std::span<const NodeOrder::Coarse> In(uint64_t cube,
                                        std::span<const NodeOrder::Coarse> places) const {
    const Slot& slot = slots_[Find(cube)];
    return places.subspan(static_cast<size_t>(slot.begin),
                          static_cast<size_t>(slot.end - slot.begin));
  }

 private:
  struct Slot {
    uint64_t cube = 0;
    int32_t begin = 0;
    int32_t end = 0;  // 0: the slot is free
  };

  size_t Start(uint64_t cube) const { return (cube * 0x9E3779B97F4A7C15u) >> shift_; }
  // The slot of this cube, or the free one that it would take.
  size_t Find(uint64_t cube) const {
    size_t at = Start(cube);
    while (slots_[at].end != 0 && slots_[at].cube != cube) at = (at + 1) % slots_.size();
    return at;
  }

  std::vector<Slot> slots_;  // a power of two, at most half of them taken
  int shift_ = 63;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_CUBE_INDEX_H_
