#ifndef CLEAVE_CORE_SOLVER_PCG_H_
#define CLEAVE_CORE_SOLVER_PCG_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/stop_flag.h"
#include "core/model/nodal_vector.h"
#include "core/solver/block_sums.h"
#include "core/solver/constraints.h"
#include "core/solver/stiffness_matrix.h"

namespace cleave {

// Conjugate gradients preconditioned with the inverse diagonal blocks. Given coordinates stay 0:
// the preconditioner has no entry there, so no search direction has. Not thread-safe; loops run on
// the caller's TBB arena and give the same bits for any number of threads.
class PcgSolver {
 public:
  PcgSolver(int64_t node_count, std::vector<FixedNode> fixed_nodes);

  struct Result {
    int32_t iterations = 0;
    bool positive = true;  // no sign that the matrix is not positive definite
  };

  // Takes the diagonal of `matrix`; call it whenever the matrix changed.
  void Prepare(const StiffnessMatrix& matrix);

  // Solves matrix * solution = rhs from 0 until the preconditioned residual norm fell by
  // `tolerance`, or the iteration limit is reached, or the matrix shows itself not positive to
  // rounding: every iterate lowers the quadratic model, so all of them are worth a line search.
  // Errors: Cancelled, looked for in every iteration.
  absl::StatusOr<Result> Solve(const StiffnessMatrix& matrix, const NodalVector& rhs,
                               double tolerance, const StopFlag& stop, NodalVector& solution);

  int64_t bytes() const;

 private:
  struct InverseBlock {
    Float4 columns[3];
  };

  Double4 Precondition(size_t node, Double4 r) const {
    const InverseBlock& inverse = inverse_diagonal_[node];
    return MultiplyAdd(Widen(inverse.columns[0]), SplatLane<0>(r),
                       MultiplyAdd(Widen(inverse.columns[1]), SplatLane<1>(r),
                                   Widen(inverse.columns[2]) * SplatLane<2>(r)));
  }

  std::vector<FixedNode> fixed_nodes_;
  NodeBlocks blocks_;
  // Times a power of two that brings it near 1: a preconditioner's scale does not matter.
  std::vector<InverseBlock> inverse_diagonal_;
  bool positive_diagonal_ = true;
  NodalVector residual_;
  NodalVector direction_;
  NodalVector product_;
  NodalVector preconditioned_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_PCG_H_
