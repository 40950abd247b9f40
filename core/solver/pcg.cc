#include "core/solver/pcg.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/status/status.h"
#include "core/base/matrix3.h"

namespace cleave {
namespace {

// The inverse of the symmetric matrix with these columns, on its free axes only; 0 elsewhere.
void InvertBlock(const Double4 columns[3], Int64x4 fixed, Double4 inverse[3]) {
  Matrix3<double> block;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const bool free = fixed[i] == 0 && fixed[j] == 0;
      block(i, j) = free ? 0.5 * (columns[j][i] + columns[i][j]) : (i == j ? 1 : 0);
    }
  }
  // Scaled to a unit diagonal, so that no determinant over- or underflows.
  double scale[3];
  for (int i = 0; i < 3; ++i) scale[i] = 1 / std::sqrt(block(i, i));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) block(i, j) *= scale[i] * scale[j];
  }
  const Matrix3<double> cofactor = Cofactor(block);
  const double determinant =
      block(0, 0) * cofactor(0, 0) + block(0, 1) * cofactor(0, 1) + block(0, 2) * cofactor(0, 2);
  // A block that is singular to rounding is preconditioned by its diagonal.
  const bool regular = determinant > 1e-9;
  for (int j = 0; j < 3; ++j) {
    inverse[j] = Splat(0);
    for (int i = 0; i < 3; ++i) {
      if (fixed[i] != 0 || fixed[j] != 0) continue;
      const double entry = regular ? cofactor(i, j) / determinant : (i == j ? 1 : 0);
      inverse[j][i] = entry * scale[i] * scale[j];
    }
  }
}

}  // namespace

PcgSolver::PcgSolver(int64_t node_count, std::vector<FixedNode> fixed_nodes)
    : fixed_nodes_(std::move(fixed_nodes)),
      blocks_(node_count),
      inverse_diagonal_(static_cast<size_t>(node_count)),
      residual_(static_cast<size_t>(node_count)),
      direction_(static_cast<size_t>(node_count)),
      product_(static_cast<size_t>(node_count)),
      preconditioned_(static_cast<size_t>(node_count)) {}

void PcgSolver::Prepare(const StiffnessMatrix& matrix) {
  blocks_.Run([&](int64_t begin, int64_t end) {
    auto fixed =
        std::lower_bound(fixed_nodes_.begin(), fixed_nodes_.end(), begin,
                         [](const FixedNode& entry, int64_t node) { return entry.node < node; });
    for (int64_t node = begin; node < end; ++node) {
      Double4 columns[3];
      matrix.DiagonalBlock(node, columns);
      Int64x4 axes = {0, 0, 0, 0};
      if (fixed != fixed_nodes_.end() && fixed->node == node) axes = (fixed++)->axes;
      InvertBlock(columns, axes, inverse_diagonal_[static_cast<size_t>(node)].columns);
    }
  });
}

absl::StatusOr<int32_t> PcgSolver::Solve(const StiffnessMatrix& matrix, const NodalVector& rhs,
                                         double tolerance, const StopFlag& stop,
                                         NodalVector& solution) {
  double rz = Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
    Double4 sum = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      solution[node] = Splat(0);
      residual_[node] = rhs[node];
      direction_[node] = Precondition(node);
      sum += residual_[node] * direction_[node];
    }
    return sum;
  }));
  const double target = tolerance * tolerance * rz;
  const auto limit = static_cast<int32_t>(std::min<int64_t>(10'000, 3 * matrix.node_count() + 20));
  int32_t iteration = 0;
  while (iteration < limit && rz > target) {
    if (stop.requested()) return absl::CancelledError("stopped inside a linear solve");
    ++iteration;
    const double curvature = Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
      matrix.Multiply(direction_, begin, end, product_);
      Double4 sum = Splat(0);
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
        sum += direction_[node] * product_[node];
      return sum;
    }));
    if (!(curvature > 0)) break;
    const double step = rz / curvature;
    const double next_rz = Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
      Double4 sum = Splat(0);
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
        solution[node] += step * direction_[node];
        residual_[node] -= step * product_[node];
        preconditioned_[node] = Precondition(node);
        sum += residual_[node] * preconditioned_[node];
      }
      return sum;
    }));
    if (!(next_rz > target)) break;
    const double beta = next_rz / rz;
    rz = next_rz;
    blocks_.Run([&](int64_t begin, int64_t end) {
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
        direction_[node] = preconditioned_[node] + beta * direction_[node];
    });
  }
  return iteration;
}

int64_t PcgSolver::bytes() const {
  return static_cast<int64_t>(inverse_diagonal_.size() * sizeof(InverseBlock) +
                              4 * residual_.size() * sizeof(Double4) +
                              fixed_nodes_.size() * sizeof(FixedNode)) +
         blocks_.bytes();
}

}  // namespace cleave
