#ifndef CLEAVE_CORE_SOLVER_BLOCK_SUMS_H_
#define CLEAVE_CORE_SOLVER_BLOCK_SUMS_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/double4.h"
#include "core/base/parallel.h"

namespace cleave {

// Passes over the nodes that also add something up. Every pass cuts the nodes into the same fixed
// blocks and adds their sums in order, so no result depends on the number of threads.
class NodeBlocks {
 public:
  explicit NodeBlocks(int64_t node_count) { SetRuns({{{0, node_count}}}); }

  // Keeps all passes from now on to these nodes: ascending runs of a first and an end each.
  void SetRuns(std::span<const std::array<int64_t, 2>> runs) {
    blocks_.clear();
    for (const auto& [first, end] : runs) {
      for (int64_t begin = first; begin < end; begin += kBlock)
        blocks_.push_back({begin, std::min(begin + kBlock, end)});
    }
    sums_.resize(blocks_.size());
  }

  // Runs body(begin, end) -> Double4 over every block; returns the sum of what it returned.
  template <typename Body>
  Double4 Sum(const Body& body) {
    ParallelFor(static_cast<int64_t>(blocks_.size()), 1, [&](int64_t first, int64_t last) {
      for (auto block = static_cast<size_t>(first); block < static_cast<size_t>(last); ++block)
        sums_[block] = body(blocks_[block][0], blocks_[block][1]);
    });
    Double4 sum = Splat(0);
    for (const Double4& of_block : sums_) sum += of_block;
    return sum;
  }

  // Runs body(begin, end) over every block.
  template <typename Body>
  void Run(const Body& body) const {
    ParallelFor(static_cast<int64_t>(blocks_.size()), 1, [&](int64_t first, int64_t last) {
      for (auto block = static_cast<size_t>(first); block < static_cast<size_t>(last); ++block)
        body(blocks_[block][0], blocks_[block][1]);
    });
  }

  int64_t bytes() const {
    return static_cast<int64_t>(sums_.size() * sizeof(Double4) +
                                blocks_.size() * sizeof(blocks_[0]));
  }

 private:
  static constexpr int64_t kBlock = 512;
  std::vector<std::array<int64_t, 2>> blocks_;  // first and end node
  std::vector<Double4> sums_;                   // of a block each
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_BLOCK_SUMS_H_
