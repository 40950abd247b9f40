#include "core/model/node_couplings.h"

#include <algorithm>
#include <utility>

namespace cleave {

void NodeCouplings::AddCoupling(int32_t i, int32_t j, const Double4 block[3]) {
  Put(i, j, block);
  Double4 transpose[4] = {block[0], block[1], block[2], Splat(0)};
  Transpose(transpose[0], transpose[1], transpose[2], transpose[3]);
  Put(j, i, transpose);
}

void NodeCouplings::AddSpring(int32_t i, int32_t j, const Double4 block[3]) {
  AddNode(i, block);
  AddNode(j, block);
  const Double4 between[3] = {-block[0], -block[1], -block[2]};
  AddCoupling(i, j, between);
}

void NodeCouplings::Gather() {
  if (gathered_) return;
  std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return std::pair(a.row, a.column) < std::pair(b.row, b.column);
  });
  gathered_ = true;
}

std::span<const NodeCouplings::Entry> NodeCouplings::Rows(int64_t begin, int64_t end) const {
  const auto before = [](const Entry& entry, int64_t row) { return entry.row < row; };
  const auto first = std::lower_bound(entries_.begin(), entries_.end(), begin, before);
  return {first, std::lower_bound(first, entries_.end(), end, before)};
}

}  // namespace cleave
