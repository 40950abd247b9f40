#include "core/stream/cube_index.h"

#include <algorithm>
#include <array>

namespace cleave {

void CubeSet::Clear(int bits) {
  std::fill(slots_.begin(), slots_.end(), Slot());
  count_ = 0;
  inside_ = (uint64_t{1} << std::max(0, 3 * (kMortonBits - bits) - 6)) - 1;
}

// Precondition: the caller sets a bit of it.
uint64_t& CubeSet::Block(uint64_t block) {
  Slot* slot = &slots_[Find(block)];
  if (slot->cubes == 0) {
    if (2 * (count_ + 1) > slots_.size()) {
      scratch_.assign(4 * slots_.size(), Slot());
      scratch_.swap(slots_);
      shift_ = 64 - std::countr_zero(slots_.size());
      for (const Slot& taken : scratch_) {
        if (taken.cubes != 0) slots_[Find(taken.block)] = taken;
      }
      slot = &slots_[Find(block)];
    }
    ++count_;
    slot->block = block;
  }
  return slot->cubes;
}

void CubeSet::Widen() {
  std::vector<Slot> taken;
  for (int axis = 0; axis < 3; ++axis) {
    taken.clear();
    for (const Slot& slot : slots_) {
      if (slot.cubes != 0) taken.push_back(slot);
    }
    // Along the axis a cube is number 0, 1, 2 or 3 of its block, by bits `axis` and `axis` + 3 of
    // its position.
    const int one = 1 << axis;
    std::array<uint64_t, 4> layers{};
    for (int at = 0; at < 64; ++at) {
      const int layer = (at >> axis & 1) + 2 * (at >> (axis + 3) & 1);
      layers[static_cast<size_t>(layer)] |= uint64_t{1} << at;
    }
    const uint64_t mask = (kMortonX << axis) & inside_;
    for (const auto& [block, cubes] : taken) {
      const uint64_t up = (cubes & layers[0]) << one | (cubes & layers[1]) << (7 * one) |
                          (cubes & layers[2]) << one;
      const uint64_t down = (cubes & layers[1]) >> one | (cubes & layers[2]) >> (7 * one) |
                            (cubes & layers[3]) >> one;
      Block(block) |= up | down;
      const uint64_t own = block & mask;
      const uint64_t last = (cubes & layers[3]) >> (9 * one);
      if (last != 0 && own != mask) {
        const uint64_t next = ((own | ~mask) + (uint64_t{1} << axis)) & mask;
        Block((block & ~mask) | next) |= last;
      }
      const uint64_t first = (cubes & layers[0]) << (9 * one);
      if (first != 0 && own != 0) {
        const uint64_t before = (own - (uint64_t{1} << axis)) & mask;
        Block((block & ~mask) | before) |= first;
      }
    }
  }
}

}  // namespace cleave
