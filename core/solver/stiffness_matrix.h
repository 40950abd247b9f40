#ifndef CLEAVE_CORE_SOLVER_STIFFNESS_MATRIX_H_
#define CLEAVE_CORE_SOLVER_STIFFNESS_MATRIX_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/double4.h"
#include "core/model/nodal_vector.h"
#include "core/model/node_couplings.h"
#include "core/model/tet_term.h"

namespace cleave {

// The symmetric matrix of a backward Euler step, mass / dt^2 + elastic stiffness, in 3x3 blocks on
// the rest edge graph, whose pattern never changes, besides the couplings of the moment. Blocks of
// edges are float: they only steer the search, and
// in the form of EdgeBlocks translations stay exact. Not thread-safe; loops run on the caller's TBB
// arena and give the same bits for any number of threads.
class StiffnessMatrix {
 public:
  // `edges` is Incidence::edges; it is not kept.
  StiffnessMatrix(const std::vector<std::array<int32_t, 2>>& edges, int64_t node_count);

  // Sets all blocks to zero, drops all couplings and hands the blocks out to be added to; then call
  // Finish.
  EdgeBlocks& Clear();
  // To be added to between Clear and Finish.
  NodeCouplings& couplings() { return couplings_; }
  const NodeCouplings& couplings() const { return couplings_; }
  // Takes over what was added. `inertia` is mass / dt^2, kg/s^2, a node each, and must stay as it
  // is until the next call.
  void Finish(const std::vector<double>& inertia);
  // After Finish: takes over another `inertia`, and adds `share` times the blocks of a matrix on
  // the same edges.
  void SetInertia(const std::vector<double>& inertia) { inertia_ = &inertia; }
  void AddBlocks(const StiffnessMatrix& other, double share);

  // (A x) / unit of nodes [begin, end), unit being a power of two; V is Double4 or Float4. In float
  // the blocks' share is summed up in float.
  template <typename V>
  void Multiply(const std::vector<V>& x, double unit, int64_t begin, int64_t end,
                std::vector<V>& product) const;
  // What rounding takes a share of at displacements x, for nodes [begin, end): the sum over edges
  // of |B| |x_i - x_j|^2 (J), the squared sums of |B| (|x_i| + |x_j|) and of |B| |x_i - x_j| (N^2),
  // 0. A piece that has only moved and turned has no net force, but its terms do not cancel to the
  // last digit.
  Double4 GrossTerms(const NodalVector& x, int64_t begin, int64_t end) const;
  // The diagonal block of a node, by columns. Symmetric to float rounding.
  void DiagonalBlock(int64_t node, Double4 columns[3]) const;

  // Runs body(other node, block) for every block in the row of a node, in a fixed order; a block is
  // nine floats by columns, and pulls at the node with block * (x_node - x_other). Couplings are
  // not among them.
  template <typename Body>
  void ForEachBlock(int64_t node, const Body& body) const {
    const auto n = static_cast<size_t>(node);
    for (int64_t edge = upper_begin_[n]; edge < upper_begin_[n + 1]; ++edge)
      body(upper_node_[static_cast<size_t>(edge)], upper_.data() + 9 * edge);
    for (int64_t slot = lower_begin_[n]; slot < lower_begin_[n + 1]; ++slot)
      body(lower_node_[static_cast<size_t>(slot)], lower_.data() + 9 * slot);
  }
  // kg/s^2.
  double inertia(int64_t node) const { return (*inertia_)[static_cast<size_t>(node)]; }

  int64_t node_count() const { return static_cast<int64_t>(upper_begin_.size()) - 1; }
  int64_t bytes() const;

 private:
  EdgeBlocks upper_;                  // by edge: the row of its smaller node
  std::vector<int32_t> upper_begin_;  // of each node, nodes + 1
  std::vector<int32_t> upper_node_;   // the edge's larger node
  EdgeBlocks lower_;                  // the same blocks turned, in rows of their larger nodes
  std::vector<int32_t> lower_begin_;
  std::vector<int32_t> lower_node_;
  std::vector<int32_t> lower_edge_;
  NodeCouplings couplings_;
  const std::vector<double>* inertia_ = nullptr;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_STIFFNESS_MATRIX_H_
