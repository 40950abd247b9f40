#include "core/solver/coarse_space.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace cleave {
namespace {

// Patches this large halve the iterations of a body of some thousand nodes; their number is bounded
// because the dense factors of their matrix cost its cube.
constexpr int64_t kPatchNodes = 200;
constexpr int64_t kMostPatches = 64;
constexpr int64_t kFewestPatches = 4;

inline Double4 ToDouble(Double4 v) { return v; }
inline Double4 ToDouble(Float4 v) { return Widen(v); }

Double4 Times(const Double4 columns[3], Double4 x) {
  return MultiplyAdd(columns[0], SplatLane<0>(x),
                     MultiplyAdd(columns[1], SplatLane<1>(x), columns[2] * SplatLane<2>(x)));
}

}  // namespace

CoarseSpace::CoarseSpace(int64_t node_count, int64_t body_nodes,
                         const std::vector<FixedNode>& fixed_nodes)
    : body_nodes_(body_nodes) {
  const int64_t wanted = std::clamp<int64_t>(body_nodes / kPatchNodes, 1, kMostPatches);
  patch_nodes_ = std::max<int64_t>((body_nodes + wanted - 1) / wanted, 1);
  patch_count_ = (body_nodes + patch_nodes_ - 1) / patch_nodes_;
  if (patch_count_ < kFewestPatches) return;
  arms_.assign(static_cast<size_t>(node_count), Splat(0));
  free_.resize(arms_.size());
  SetFixedNodes(fixed_nodes);
  motions_.resize(static_cast<size_t>(patch_count_));
  matrix_.resize(6 * patch_count_, 6 * patch_count_);
  unknowns_.resize(6 * patch_count_);
}

void CoarseSpace::SetFixedNodes(const std::vector<FixedNode>& fixed_nodes) {
  std::fill(free_.begin(), free_.begin() + body_nodes_, Int64x4{-1, -1, -1, 0});
  std::fill(free_.begin() + body_nodes_, free_.end(), Int64x4{0, 0, 0, 0});
  for (const FixedNode& fixed : fixed_nodes) free_[static_cast<size_t>(fixed.node)] &= ~fixed.axes;
}

bool CoarseSpace::Prepare(const StiffnessMatrix& matrix, const NodalVector& positions) {
  ParallelFor(patch_count_, 1, [&](int64_t begin, int64_t end) {
    for (int64_t patch = begin; patch < end; ++patch) {
      const auto [first, last] = NodesOf(patch);
      Double4 middle = Splat(0);
      for (int64_t node = first; node < last; ++node)
        middle += positions[static_cast<size_t>(node)];
      middle /= static_cast<double>(last - first);
      for (auto node = static_cast<size_t>(first); node < static_cast<size_t>(last); ++node)
        arms_[node] = positions[node] - middle;
    }
  });
  matrix_.setZero();
  ParallelFor(patch_count_, 1, [&](int64_t begin, int64_t end) {
    for (int64_t patch = begin; patch < end; ++patch) FillRows(matrix, patch);
  });
  // A motion that no free node follows has neither stiffness nor residual.
  for (Eigen::Index k = 0; k < matrix_.rows(); ++k) {
    if (matrix_(k, k) == 0) matrix_(k, k) = 1;
  }
  factors_.compute(matrix_);
  return factors_.info() == Eigen::Success;
}

// How a node follows the motions of its patch: three shifts by 1 m, three turns by 1 rad.
void CoarseSpace::SetModes(int64_t node, Double4 modes[6]) const {
  constexpr Double4 kUnit[3] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  const auto n = static_cast<size_t>(node);
  for (int k = 0; k < 3; ++k) {
    modes[k] = free_[n] ? kUnit[k] : Splat(0);
    modes[3 + k] = free_[n] ? Cross(kUnit[k], arms_[n]) : Splat(0);
  }
}

void CoarseSpace::AddPulls(int64_t node, int64_t other_patch, const Double4 forces[6]) {
  const auto n = static_cast<size_t>(node);
  const int64_t row = 6 * PatchOf(node);
  for (int k = 0; k < 6; ++k) {
    const Double4 pull = free_[n] ? forces[k] : Splat(0);
    const Double4 turn = Cross(arms_[n], pull);
    for (int axis = 0; axis < 3; ++axis) {
      matrix_(row + axis, 6 * other_patch + k) += pull[axis];
      matrix_(row + 3 + axis, 6 * other_patch + k) += turn[axis];
    }
  }
}

// What every motion of a patch and of its neighbours pulls with at the patch.
void CoarseSpace::FillRows(const StiffnessMatrix& matrix, int64_t patch) {
  const auto [first, last] = NodesOf(patch);
  for (int64_t node = first; node < last; ++node) {
    Double4 modes[6], theirs[6], own[6], other[6];
    SetModes(node, modes);
    for (int k = 0; k < 6; ++k) own[k] = matrix.inertia(node) * modes[k];
    matrix.ForEachBlock(node, [&, begin = first, end = last](int64_t neighbour,
                                                             const float* block) {
      const Double4 columns[3] = {LoadFloats(block), LoadFloats(block + 3), LoadFloats(block + 6)};
      SetModes(neighbour, theirs);
      if (neighbour >= begin && neighbour < end) {
        for (int k = 0; k < 6; ++k) own[k] += Times(columns, modes[k] - theirs[k]);
        return;
      }
      for (int k = 0; k < 6; ++k) {
        own[k] += Times(columns, modes[k]);
        other[k] = -Times(columns, theirs[k]);
      }
      AddPulls(node, PatchOf(neighbour), other);
    });
    AddPulls(node, patch, own);
  }
  for (const NodeCouplings::Entry& entry : matrix.couplings().Rows(first, last)) {
    Double4 theirs[6], forces[6];
    SetModes(entry.column, theirs);
    for (int k = 0; k < 6; ++k) forces[k] = Times(entry.columns, theirs[k]);
    AddPulls(entry.row, PatchOf(entry.column), forces);
  }
}

template <typename V>
void CoarseSpace::Solve(const std::vector<V>& residual) {
  ParallelFor(patch_count_, 8, [&](int64_t begin, int64_t end) {
    for (int64_t patch = begin; patch < end; ++patch) {
      const auto [first, last] = NodesOf(patch);
      Motion sum = {Splat(0), Splat(0)};
      for (auto node = static_cast<size_t>(first); node < static_cast<size_t>(last); ++node) {
        const Double4 pull = free_[node] ? ToDouble(residual[node]) : Splat(0);
        sum.shift += pull;
        sum.turn += Cross(arms_[node], pull);
      }
      for (int axis = 0; axis < 3; ++axis) {
        unknowns_(6 * patch + axis) = sum.shift[axis];
        unknowns_(6 * patch + 3 + axis) = sum.turn[axis];
      }
    }
  });
  factors_.solveInPlace(unknowns_);
  for (int64_t patch = 0; patch < patch_count_; ++patch) {
    const double* u = unknowns_.data() + 6 * patch;
    motions_[static_cast<size_t>(patch)] = {Double4{u[0], u[1], u[2], 0},
                                            Double4{u[3], u[4], u[5], 0}};
  }
}
template void CoarseSpace::Solve(const std::vector<Double4>&);
template void CoarseSpace::Solve(const std::vector<Float4>&);

int64_t CoarseSpace::bytes() const {
  return static_cast<int64_t>(arms_.size() * (sizeof(Double4) + sizeof(Int64x4)) +
                              motions_.size() * sizeof(Motion)) +
         static_cast<int64_t>(sizeof(double)) * (2 * matrix_.size() + unknowns_.size());
}

}  // namespace cleave
