#include "core/solver/pcg.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
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

// A step in which waves cross fewer cells than this is solved in about as many iterations without a
// second level.
constexpr double kFarReach = 10;

inline Float4 InPrecision(Double4 v, Float4) { return Narrow(v); }
inline Double4 InPrecision(Double4 v, Double4) { return v; }
inline Double4 ToDouble(Double4 v) { return v; }
inline Double4 ToDouble(Float4 v) { return Widen(v); }

template <typename V, typename Block>
V Precondition(const Block& inverse, V r) {
  if constexpr (std::is_same_v<V, Float4>) {
    return MultiplyAdd(
        inverse.columns[0], SplatLane<0>(r),
        MultiplyAdd(inverse.columns[1], SplatLane<1>(r), inverse.columns[2] * SplatLane<2>(r)));
  } else {
    return MultiplyAdd(Widen(inverse.columns[0]), SplatLane<0>(r),
                       MultiplyAdd(Widen(inverse.columns[1]), SplatLane<1>(r),
                                   Widen(inverse.columns[2]) * SplatLane<2>(r)));
  }
}

// The power of two at or below a positive finite size, else 1.
double UnitNear(double size) {
  return size > 0 && std::isfinite(size) ? std::exp2(std::ilogb(size)) : 1;
}

}  // namespace

PcgSolver::PcgSolver(int64_t node_count, int64_t body_nodes, std::vector<FixedNode> fixed_nodes,
                     Precision precision)
    : fixed_nodes_(std::move(fixed_nodes)),
      blocks_(node_count),
      inverse_diagonal_(static_cast<size_t>(node_count)),
      coarse_(node_count, body_nodes, fixed_nodes_),
      vectors_(Vectors<Double4>(0)) {
  const auto count = static_cast<size_t>(node_count);
  if (precision == Precision::kFloat) {
    vectors_.emplace<Vectors<Float4>>(count).solution.resize(count);
  } else {
    vectors_.emplace<Vectors<Double4>>(count);
  }
}

void PcgSolver::SetFixedNodes(std::vector<FixedNode> fixed_nodes) {
  fixed_nodes_ = std::move(fixed_nodes);
  if (coarse_.pays()) coarse_.SetFixedNodes(fixed_nodes_);
}

void PcgSolver::SetRuns(std::span<const std::array<int64_t, 2>> runs) {
  blocks_.SetRuns(runs);
  // Nothing moves where no pass goes.
  std::visit(
      [](auto& vectors) {
        for (auto* of : {&vectors.residual, &vectors.direction, &vectors.product,
                         &vectors.preconditioned, &vectors.solution})
          std::fill(of->begin(), of->end(), typename std::decay_t<decltype(*of)>::value_type{});
      },
      vectors_);
}

void PcgSolver::Prepare(const StiffnessMatrix& matrix, const NodalVector& positions) {
  // Of the first node from the middle on that is connected or has mass.
  double size = 0;
  for (int64_t node = matrix.node_count() / 2; size == 0 && node < matrix.node_count(); ++node) {
    Double4 columns[3];
    matrix.DiagonalBlock(node, columns);
    size = std::abs(columns[0][0]) + std::abs(columns[1][1]) + std::abs(columns[2][2]);
  }
  unit_ = UnitNear(size);
  // Diagonal blocks that are not positive, and the traces of all and of inertia's share in them.
  const Double4 sums = blocks_.Sum([&](int64_t begin, int64_t end) {
    auto fixed =
        std::lower_bound(fixed_nodes_.begin(), fixed_nodes_.end(), begin,
                         [](const FixedNode& entry, int64_t node) { return entry.node < node; });
    Double4 sum = Splat(0);
    for (int64_t node = begin; node < end; ++node) {
      Double4 columns[3], inverse[3];
      matrix.DiagonalBlock(node, columns);
      Int64x4 axes = {0, 0, 0, 0};
      if (fixed != fixed_nodes_.end() && fixed->node == node) axes = (fixed++)->axes;
      const bool positive = InvertBlock(columns, axes, inverse);
      sum += Double4{positive ? 0.0 : 1.0, columns[0][0] + columns[1][1] + columns[2][2],
                     3 * matrix.inertia(node), 0};
      for (int k = 0; k < 3; ++k) {
        inverse_diagonal_[static_cast<size_t>(node)].columns[k] = Narrow(unit_ * inverse[k]);
      }
    }
    return sum;
  });
  positive_diagonal_ = sums[0] == 0;
  two_level_ = coarse_.pays() && sums[1] > kFarReach * kFarReach * sums[2] &&
               coarse_.Prepare(matrix, positions);
}

absl::StatusOr<PcgSolver::Result> PcgSolver::Solve(const StiffnessMatrix& matrix,
                                                   const NodalVector& rhs, double tolerance,
                                                   const StopFlag& stop, NodalVector& solution) {
  return std::visit(
      [&](auto& vectors) {
        return two_level_ ? SolveIn<true>(vectors, matrix, rhs, tolerance, stop, solution)
                          : SolveIn<false>(vectors, matrix, rhs, tolerance, stop, solution);
      },
      vectors_);
}

template <bool kTwoLevel, typename V>
absl::StatusOr<PcgSolver::Result> PcgSolver::SolveIn(Vectors<V>& vectors,
                                                     const StiffnessMatrix& matrix,
                                                     const NodalVector& rhs, double tolerance,
                                                     const StopFlag& stop, NodalVector& solution) {
  std::vector<V>& residual = vectors.residual;
  std::vector<V>& direction = vectors.direction;
  std::vector<V>& product = vectors.product;
  std::vector<V>& preconditioned = vectors.preconditioned;
  const auto result_vector = [&]() -> std::vector<V>& {
    if constexpr (std::is_same_v<V, Float4>) {
      return vectors.solution;
    } else {
      return solution;
    }
  };
  std::vector<V>& x = result_vector();
  // In float, units bring everything near 1: the equations are (A / unit) (unit x / size) = b /
  // size.
  double matrix_unit = 1, size = 1;
  if constexpr (std::is_same_v<V, Float4>) {
    matrix_unit = unit_;
    size = UnitNear(std::sqrt(Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
      Double4 sum = Splat(0);
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
        sum += rhs[node] * rhs[node];
      return sum;
    }))));
  }
  // Applies the preconditioner to the residual; returns their product.
  const auto precondition = [&](std::vector<V>& target) {
    if constexpr (kTwoLevel) coarse_.Solve(residual);
    return Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
      Double4 sum = Splat(0);
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
        V z = Precondition(inverse_diagonal_[node], residual[node]);
        if constexpr (kTwoLevel)
          z += InPrecision(unit_ * coarse_.Correction(static_cast<int64_t>(node)), V{});
        target[node] = z;
        sum += ToDouble(residual[node] * z);
      }
      return sum;
    }));
  };
  blocks_.Run([&](int64_t begin, int64_t end) {
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      x[node] = V{};
      residual[node] = InPrecision(rhs[node] / size, V{});
    }
  });
  double rz = precondition(direction);
  const double target = tolerance * tolerance * rz;
  const auto limit = static_cast<int32_t>(std::min<int64_t>(10'000, 3 * matrix.node_count() + 20));
  Result result;
  result.positive = positive_diagonal_;
  while (result.iterations < limit && rz > target) {
    if (stop.requested()) return absl::CancelledError("stopped inside a linear solve");
    ++result.iterations;
    const double curvature = Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
      matrix.Multiply(direction, matrix_unit, begin, end, product);
      Double4 sum = Splat(0);
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
        sum += ToDouble(direction[node] * product[node]);
      return sum;
    }));
    if (!(curvature > 0)) {
      result.positive = false;
      if (result.iterations == 1) x = direction;
      break;
    }
    using Scalar = std::remove_reference_t<decltype(V{}[0])>;
    const auto step = static_cast<Scalar>(rz / curvature);
    blocks_.Run([&](int64_t begin, int64_t end) {
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
        x[node] += step * direction[node];
        residual[node] -= step * product[node];
      }
    });
    const double next_rz = precondition(preconditioned);
    const auto beta = static_cast<Scalar>(next_rz / rz);
    rz = next_rz;
    blocks_.Run([&](int64_t begin, int64_t end) {
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
        direction[node] = preconditioned[node] + beta * direction[node];
    });
  }
  if constexpr (std::is_same_v<V, Float4>) {
    blocks_.Run([&](int64_t begin, int64_t end) {
      for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
        solution[node] = (size / unit_) * Widen(x[node]);
    });
  }
  return result;
}

int64_t PcgSolver::bytes() const {
  const auto of_vectors = [](const auto& vectors) {
    return static_cast<int64_t>((4 * vectors.residual.size() + vectors.solution.size()) *
                                sizeof(vectors.residual[0]));
  };
  return static_cast<int64_t>(inverse_diagonal_.size() * sizeof(InverseBlock) +
                              fixed_nodes_.size() * sizeof(FixedNode)) +
         std::visit(of_vectors, vectors_) + blocks_.bytes() + coarse_.bytes();
}

}  // namespace cleave
