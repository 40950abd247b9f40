#ifndef CLEAVE_CORE_MODEL_NODE_COUPLINGS_H_
#define CLEAVE_CORE_MODEL_NODE_COUPLINGS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/double4.h"

namespace cleave {

// Stiffness outside the mesh's edges, N/m, in 3x3 blocks by columns (the last lane of each is 0):
// of single nodes, and between any two. Filled anew for every matrix; empty where no node term
// pushes back. Not thread-safe.
class NodeCouplings {
 public:
  // What follows a row's node: the product's share of `column` is block * x[column].
  struct Entry {
    int32_t row;
    int32_t column;
    Double4 columns[3];
  };

  void Clear() {
    entries_.clear();
    gathered_ = true;
  }

  // Adds a symmetric block to row and column `node`.
  void AddNode(int32_t node, const Double4 block[3]) { Put(node, node, block); }

  // Adds K_ij to row i and column j, and its transpose to row j and column i. Preconditions: i and
  // j differ.
  void AddCoupling(int32_t i, int32_t j, const Double4 block[3]);

  // Adds the symmetric B to both nodes and -B between them: the stiffness of a spring, which no
  // translation stretches.
  void AddSpring(int32_t i, int32_t j, const Double4 block[3]);

  // Sorts what was added by row and column; entries of one place stay in the order of adding, so
  // that sums over them have one order. Call it before what follows.
  void Gather();

  bool empty() const { return entries_.empty(); }
  // Entries whose rows are in [begin, end), ascending by row. Precondition: gathered.
  std::span<const Entry> Rows(int64_t begin, int64_t end) const;

  int64_t bytes() const { return static_cast<int64_t>(entries_.capacity() * sizeof(Entry)); }

 private:
  void Put(int32_t row, int32_t column, const Double4 block[3]) {
    entries_.push_back({row, column, {block[0], block[1], block[2]}});
    gathered_ = false;
  }

  std::vector<Entry> entries_;
  bool gathered_ = true;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_NODE_COUPLINGS_H_
