#ifndef CLEAVE_CORE_SOLVER_PCG_H_
#define CLEAVE_CORE_SOLVER_PCG_H_

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/stop_flag.h"
#include "core/model/nodal_vector.h"
#include "core/scene/scene.h"
#include "core/solver/block_sums.h"
#include "core/solver/coarse_space.h"
#include "core/solver/constraints.h"
#include "core/solver/stiffness_matrix.h"

namespace cleave {

// Conjugate gradients preconditioned with the inverse diagonal blocks. Given coordinates stay 0:
// the preconditioner has no entry there, so no search direction has. In float the vectors are, and
// sums over them are double; the solution has as many digits as that leaves. Not thread-safe; loops
// run on the caller's TBB arena and give the same bits for any number of threads.
class PcgSolver {
 public:
  // The first `body_nodes` of the nodes are a mesh's, numbered for locality (core/mesh/reorder.h).
  PcgSolver(int64_t node_count, int64_t body_nodes, std::vector<FixedNode> fixed_nodes,
            Precision precision);

  struct Result {
    int32_t iterations = 0;
    bool positive = true;  // no sign that the matrix is not positive definite
  };

  // Counts from the next Prepare on.
  void SetFixedNodes(std::vector<FixedNode> fixed_nodes);
  // Leaves out all nodes but those of these runs (block_sums.h), of which every coordinate is
  // given; in solutions they stay as they are. Call SetFixedNodes too.
  void SetRuns(std::span<const std::array<int64_t, 2>> runs);

  // Takes what preconditions `matrix`; call it whenever the matrix changed. `positions` (m) are
  // about those of the body's nodes.
  void Prepare(const StiffnessMatrix& matrix, const NodalVector& positions);

  // Solves matrix * solution = rhs from 0 until the preconditioned residual norm fell by
  // `tolerance`, or the iteration limit is reached, or the matrix shows itself not positive to
  // rounding: every iterate lowers the quadratic model, so all of them are worth a line search; of
  // a matrix that shows it in the first direction, the solution is that direction.
  // Errors: Cancelled, looked for in every iteration.
  absl::StatusOr<Result> Solve(const StiffnessMatrix& matrix, const NodalVector& rhs,
                               double tolerance, const StopFlag& stop, NodalVector& solution);

  int64_t bytes() const;

 private:
  struct InverseBlock {
    Float4 columns[3];
  };
  // V is Double4 or Float4.
  template <typename V>
  struct Vectors {
    explicit Vectors(size_t node_count)
        : residual(node_count),
          direction(node_count),
          product(node_count),
          preconditioned(node_count) {}

    std::vector<V> residual, direction, product, preconditioned;
    std::vector<V> solution;  // in float; in double it is the caller's
  };

  template <bool kTwoLevel, typename V>
  absl::StatusOr<Result> SolveIn(Vectors<V>& vectors, const StiffnessMatrix& matrix,
                                 const NodalVector& rhs, double tolerance, const StopFlag& stop,
                                 NodalVector& solution);

  std::vector<FixedNode> fixed_nodes_;
  NodeBlocks blocks_;
  // What is near the matrix's entries, N/m, a power of two.
  double unit_ = 1;
  std::vector<InverseBlock> inverse_diagonal_;  // times the unit
  bool positive_diagonal_ = true;
  CoarseSpace coarse_;
  bool two_level_ = false;
  std::variant<Vectors<Double4>, Vectors<Float4>> vectors_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_PCG_H_
