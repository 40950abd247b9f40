#ifndef CLEAVE_CORE_SOLVER_BLOCK_SUMS_H_
#define CLEAVE_CORE_SOLVER_BLOCK_SUMS_H_

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/double4.h"
#include "core/base/parallel.h"

namespace cleave {

// Passes over the nodes that also add something up. Every pass cuts the nodes into the same fixed
// blocks and adds their sums in order, so no result depends on the number of threads.
class NodeBlocks {
 public:
  explicit NodeBlocks(int64_t node_count)
      : node_count_(node_count), sums_(static_cast<size_t>((node_count + kBlock - 1) / kBlock)) {}

  // Runs body(begin, end) -> Double4 over every block; returns the sum of what it returned.
  template <typename Body>
  Double4 Sum(const Body& body) {
    const auto blocks = static_cast<int64_t>(sums_.size());
    ParallelFor(blocks, 1, [&](int64_t first, int64_t last) {
      for (int64_t block = first; block < last; ++block) {
        sums_[static_cast<size_t>(block)] =
            body(block * kBlock, std::min((block + 1) * kBlock, node_count_));
      }
    });
    Double4 sum = Splat(0);
    for (const Double4& of_block : sums_) sum += of_block;
    return sum;
  }

  // Runs body(begin, end) over every block.
  template <typename Body>
  void Run(const Body& body) const {
    ParallelFor(static_cast<int64_t>(sums_.size()), 1, [&](int64_t first, int64_t last) {
      body(first * kBlock, std::min(last * kBlock, node_count_));
    });
  }

  int64_t bytes() const { return static_cast<int64_t>(sums_.size() * sizeof(Double4)); }

 private:
  static constexpr int64_t kBlock = 512;
  int64_t node_count_;
  std::vector<Double4> sums_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_BLOCK_SUMS_H_
