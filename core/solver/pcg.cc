#include "core/solver/pcg.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/status/status.h"
#include "core/base/matrix3.h"

namespace cleave {
namespace {

// The inverse of the symmetric matrix with these columns, on its free axes only; 0 elsewhere.
// Returns whether the matrix is positive definite; if not, the inverse is that of its diagonal.
bool InvertBlock(const Double4 columns[3], Int64x4 fixed, Double4 inverse[3]) {
  Matrix3<double> block;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const bool free = fixed[i] == 0 && fixed[j] == 0;
      block(i, j) = free ? 0.5 * (columns[j][i] + columns[i][j]) : (i == j ? 1 : 0);
    }
  }
  // Scaled to a unit diagonal, so that no determinant over- or underflows.
  double scale[3];
  bool positive = true;
  for (int i = 0; i < 3; ++i) {
    positive = positive && block(i, i) > 0;
    scale[i] = 1 / std::sqrt(std::abs(block(i, i)));
  }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) block(i, j) *= scale[i] * scale[j];
  }
  const Matrix3<double> cofactor = Cofactor(block);
  const double determinant =
      block(0, 0) * cofactor(0, 0) + block(0, 1) * cofactor(0, 1) + block(0, 2) * cofactor(0, 2);
  // Singular to the rounding of floats is as good as not positive.
  positive = positive && cofactor(2, 2) > 0 && determinant > 1e-9;
  for (int j = 0; j < 3; ++j) {
    inverse[j] = Splat(0);
    for (int i = 0; i < 3; ++i) {
      if (fixed[i] != 0 || fixed[j] != 0) continue;
      const double entry = positive ? cofactor(i, j) / determinant : (i == j ? 1 : 0);
      inverse[j][i] = entry * scale[i] * scale[j];
    }
  }
  return positive;
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
  Double4 middle[3];
  matrix.DiagonalBlock(matrix.node_count() / 2, middle);
  const double size = std::abs(middle[0][0]) + std::abs(middle[1][1]) + std::abs(middle[2][2]);
  const double unit = size > 0 && std::isfinite(size) ? std::exp2(std::ilogb(size)) : 1;
  const Double4 negatives = blocks_.Sum([&](int64_t begin, int64_t end) {
    auto fixed =
        std::lower_bound(fixed_nodes_.begin(), fixed_nodes_.end(), begin,
                         [](const FixedNode& entry, int64_t node) { return entry.node < node; });
    double negative = 0;
    for (int64_t node = begin; node < end; ++node) {
      Double4 columns[3], inverse[3];
      matrix.DiagonalBlock(node, columns);
      Int64x4 axes = {0, 0, 0, 0};
      if (fixed != fixed_nodes_.end() && fixed->node == node) axes = (fixed++)->axes;
      if (!InvertBlock(columns, axes, inverse)) negative += 1;
      for (int k = 0; k < 3; ++k) {
        inverse_diagonal_[static_cast<size_t>(node)].columns[k] = Narrow(unit * inverse[k]);
      }
    }
    return Splat(negative);
  });
  positive_diagonal_ = negatives[0] == 0;
}

absl::StatusOr<PcgSolver::Result> PcgSolver::Solve(const StiffnessMatrix& matrix,
                                                   const NodalVector& rhs, double tolerance,
                                                   const StopFlag& stop, NodalVector& solution) {
  double rz = Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
    Double4 sum = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      solution[node] = Splat(0);
      residual_[node] = rhs[node];
      direction_[node] = Precondition(node, rhs[node]);
      sum += residual_[node] * direction_[node];
    }
    return sum;
  }));
  const double target = tolerance * tolerance * rz;
  const auto limit = static_cast<int32_t>(std::min<int64_t>(10'000, 3 * matrix.node_count() + 20));
  Result result;
  result.positive = positive_diagonal_;
  while (result.iterations < limit && rz > target) {
    if (stop.requested()) return absl::CancelledError("stopped inside a linear solve");
    ++result.iterations;
    const double curvature = Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
      matrix.Multiply(direction_, begin, end, product_);
      Double4 sum = Splat(0);
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
        sum += direction_[node] * product_[node];
      return sum;
    }));
    if (!(curvature > 0)) {
      result.positive = false;
      break;
    }
    const double step = rz / curvature;
    const double next_rz = Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
      Double4 sum = Splat(0);
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
        const Double4 r = residual_[node] - step * product_[node];
        const Double4 z = Precondition(node, r);
        residual_[node] = r;
        preconditioned_[node] = z;
        sum += r * z;
      }
      return sum;
    }));
    const double beta = next_rz / rz;
    rz = next_rz;
    blocks_.Run([&](int64_t begin, int64_t end) {
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
        const Double4 direction = direction_[node];
        solution[node] += step * direction;
        direction_[node] = preconditioned_[node] + beta * direction;
      }
    });
  }
  return result;
}

int64_t PcgSolver::bytes() const {
  return static_cast<int64_t>(inverse_diagonal_.size() * sizeof(InverseBlock) +
                              4 * residual_.size() * sizeof(Double4) +
                              fixed_nodes_.size() * sizeof(FixedNode)) +
         blocks_.bytes();
}

}  // namespace cleave
