#ifndef CLEAVE_CORE_SOLVER_COARSE_SPACE_H_
#define CLEAVE_CORE_SOLVER_COARSE_SPACE_H_

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/double4.h"
#include "core/model/nodal_vector.h"
#include "core/solver/constraints.h"
#include "core/solver/stiffness_matrix.h"

namespace cleave {

// The second level of a preconditioner: the body cut into some dozens of patches of neighbouring
// nodes, each of which moves and turns as a whole. What inverse diagonal blocks carry from node to
// node, in as many iterations as there are nodes across, it carries across patches at once. Added
// to them, not multiplied, so that it costs no further product. Source: additive two-level Schwarz
// methods with rigid body modes (Smith, Bjorstad and Gropp, Domain Decomposition, 1996). Not
// thread-safe; loops run on the caller's TBB arena and give the same bits for any number of
// threads.
class CoarseSpace {
 public:
  // Patches are runs of nodes, whose numbering must be local (core/mesh/reorder.h).
  // The last of the nodes, from `body_nodes` on, are in no patch.
  CoarseSpace(int64_t node_count, int64_t body_nodes, const std::vector<FixedNode>& fixed_nodes);
  // Whether there are enough nodes for patches to pay; if not, nothing else is to be called.
  bool pays() const { return !motions_.empty(); }

  void SetFixedNodes(const std::vector<FixedNode>& fixed_nodes);

  // Takes the matrix in the space of the patches' motions. `positions` (m) are about those of the
  // nodes. False where the matrix is not positive definite; what follows is then not to be called.
  bool Prepare(const StiffnessMatrix& matrix, const NodalVector& positions);

  // Finds the motion of the patches that answers a residual (N). V is Double4 or Float4.
  template <typename V>
  void Solve(const std::vector<V>& residual);
  // What it does to a node (m), 0 along given axes.
  Double4 Correction(int64_t node) const {
    const auto n = static_cast<size_t>(node);
    const Motion& motion = motions_[static_cast<size_t>(PatchOf(node))];
    return free_[n] ? motion.shift + Cross(motion.turn, arms_[n]) : Splat(0);
  }

  int64_t bytes() const;

 private:
  // Of nodes in no patch, any: they follow none.
  int64_t PatchOf(int64_t node) const { return std::min(node / patch_nodes_, patch_count_ - 1); }

  struct Motion {
    Double4 shift;  // m; of a residual: N
    Double4 turn;   // rad; of a residual: N m
  };

  static Double4 Cross(Double4 a, Double4 b) {
    const auto next = [](Double4 v) { return __builtin_shufflevector(v, v, 1, 2, 0, 3); };
    const auto last = [](Double4 v) { return __builtin_shufflevector(v, v, 2, 0, 1, 3); };
    return next(a) * last(b) - last(a) * next(b);
  }

  // Adds the forces (N) with which a node pulls at its patch for each motion of a patch.
  void AddPulls(int64_t node, int64_t other_patch, const Double4 forces[6]);
  void SetModes(int64_t node, Double4 modes[6]) const;
  // [first, end)
  std::pair<int64_t, int64_t> NodesOf(int64_t patch) const {
    return {patch * patch_nodes_, std::min((patch + 1) * patch_nodes_, body_nodes_)};
  }
  void FillRows(const StiffnessMatrix& matrix, int64_t patch);

  int64_t body_nodes_;
  int64_t patch_nodes_;
  int64_t patch_count_;
  std::vector<Double4> arms_;    // m, from the middle of the patch
  std::vector<Int64x4> free_;    // all ones along free axes, 0 in the last lane
  std::vector<Motion> motions_;  // a patch each
  Eigen::MatrixXd matrix_;       // six rows a patch: shift, turn
  Eigen::LLT<Eigen::MatrixXd> factors_;
  Eigen::VectorXd unknowns_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_COARSE_SPACE_H_
