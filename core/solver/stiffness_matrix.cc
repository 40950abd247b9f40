#include "core/solver/stiffness_matrix.h"

#include <cmath>
#include <cstring>

#include "core/base/parallel.h"

namespace cleave {
namespace {

constexpr int64_t kGrain = 2048;  // rows

constexpr Int64x4 kCoordinates = {-1, -1, -1, 0};

inline void Load(const float* column, Double4& values) { values = LoadFloats(column); }
inline void Load(const float* column, Float4& values) { values = LoadFloat4(column); }
inline Double4 ToDouble(Double4 v) { return v; }
inline Double4 ToDouble(Float4 v) { return Widen(v); }
inline void Store(Double4 v, Double4& to) { to = v; }
inline void Store(Double4 v, Float4& to) { to = Narrow(v); }

// Adds B (x - y) for the blocks of one row.
template <typename V>
V RowSum(const float* block, const int32_t* column, const int32_t* end, V x, const V* values) {
  V sum0 = V{}, sum1 = V{}, sum2 = V{};
  for (; column != end; ++column, block += 9) {
    const V d = x - values[*column];
    V column0, column1, column2;
    Load(block, column0);
    Load(block + 3, column1);
    Load(block + 6, column2);
    sum0 = MultiplyAdd(column0, SplatLane<0>(d), sum0);
    sum1 = MultiplyAdd(column1, SplatLane<1>(d), sum1);
    sum2 = MultiplyAdd(column2, SplatLane<2>(d), sum2);
  }
  return sum0 + sum1 + sum2;
}

}  // namespace

StiffnessMatrix::StiffnessMatrix(const std::vector<std::array<int32_t, 2>>& edges,
                                 int64_t node_count)
    : upper_(EdgeBlocksSize(static_cast<int64_t>(edges.size())), 0.0f),
      upper_begin_(static_cast<size_t>(node_count) + 1, 0),
      upper_node_(edges.size()),
      lower_(upper_.size(), 0.0f),
      lower_begin_(upper_begin_),
      lower_node_(edges.size()),
      lower_edge_(edges.size()) {
  for (const auto& [small, large] : edges) {
    ++upper_begin_[static_cast<size_t>(small) + 1];
    ++lower_begin_[static_cast<size_t>(large) + 1];
  }
  for (size_t node = 0; node < static_cast<size_t>(node_count); ++node) {
    upper_begin_[node + 1] += upper_begin_[node];
    lower_begin_[node + 1] += lower_begin_[node];
  }
  std::vector<int32_t> next = lower_begin_;
  for (size_t edge = 0; edge < edges.size(); ++edge) {
    upper_node_[edge] = edges[edge][1];
    const auto slot = static_cast<size_t>(next[static_cast<size_t>(edges[edge][1])]++);
    lower_node_[slot] = edges[edge][0];
    lower_edge_[slot] = static_cast<int32_t>(edge);
  }
}

EdgeBlocks& StiffnessMatrix::Clear() {
  ParallelFor(static_cast<int64_t>(upper_.size()), 1 << 18, [&](int64_t begin, int64_t end) {
    std::memset(upper_.data() + begin, 0, static_cast<size_t>(end - begin) * sizeof(float));
  });
  couplings_.Clear();
  return upper_;
}

void StiffnessMatrix::Finish(const std::vector<double>& inertia) {
  inertia_ = &inertia;
  couplings_.Gather();
  ParallelFor(static_cast<int64_t>(lower_edge_.size()), kGrain, [&](int64_t begin, int64_t end) {
    for (int64_t slot = begin; slot < end; ++slot) {
      const float* from = upper_.data() + 9 * int64_t{lower_edge_[static_cast<size_t>(slot)]};
      float* to = lower_.data() + 9 * slot;
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column) to[3 * column + row] = from[3 * row + column];
      }
    }
  });
}

void StiffnessMatrix::AddBlocks(const StiffnessMatrix& other, double share) {
  const auto scale = static_cast<float>(share);
  ParallelFor(static_cast<int64_t>(upper_.size()), 1 << 16, [&](int64_t begin, int64_t end) {
    for (auto k = static_cast<size_t>(begin); k < static_cast<size_t>(end); ++k) {
      upper_[k] += scale * other.upper_[k];
      lower_[k] += scale * other.lower_[k];
    }
  });
}

template <typename V>
void StiffnessMatrix::Multiply(const std::vector<V>& x, double unit, int64_t begin, int64_t end,
                               std::vector<V>& product) const {
  const double scale = 1 / unit;
  for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
    const V upper = RowSum(upper_.data() + 9 * int64_t{upper_begin_[node]},
                           upper_node_.data() + upper_begin_[node],
                           upper_node_.data() + upper_begin_[node + 1], x[node], x.data());
    const V lower = RowSum(lower_.data() + 9 * int64_t{lower_begin_[node]},
                           lower_node_.data() + lower_begin_[node],
                           lower_node_.data() + lower_begin_[node + 1], x[node], x.data());
    const Double4 sum = (*inertia_)[node] * ToDouble(x[node]) + ToDouble(upper) + ToDouble(lower);
    Store(kCoordinates ? scale * sum : Splat(0), product[node]);
  }
  if (couplings_.empty()) return;
  for (const NodeCouplings::Entry& entry : couplings_.Rows(begin, end)) {
    const Double4 value = scale * ToDouble(x[static_cast<size_t>(entry.column)]);
    V& target = product[static_cast<size_t>(entry.row)];
    Store(ToDouble(target) + entry.columns[0] * SplatLane<0>(value) +
              entry.columns[1] * SplatLane<1>(value) + entry.columns[2] * SplatLane<2>(value),
          target);
  }
}

template void StiffnessMatrix::Multiply(const std::vector<Double4>&, double, int64_t, int64_t,
                                        std::vector<Double4>&) const;
template void StiffnessMatrix::Multiply(const std::vector<Float4>&, double, int64_t, int64_t,
                                        std::vector<Float4>&) const;

Double4 StiffnessMatrix::GrossTerms(const NodalVector& x, int64_t begin, int64_t end) const {
  double energy = 0, squared_forces = 0, squared_differences = 0;
  for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
    double force = 0, of_differences = 0;
    const double size = std::sqrt(Dot(x[node], x[node]));
    const auto add = [&](const float* block, int32_t other) {
      double squares = 0;
      for (int k = 0; k < 9; ++k) squares += double{block[k]} * block[k];
      const Double4 y = x[static_cast<size_t>(other)];
      const Double4 d = x[node] - y;
      const double length = std::sqrt(Dot(d, d));
      const double stiffness = std::sqrt(squares);
      force += stiffness * (size + std::sqrt(Dot(y, y)));
      of_differences += stiffness * length;
      energy += stiffness * length * length;
    };
    for (int64_t edge = upper_begin_[node]; edge < upper_begin_[node + 1]; ++edge)
      add(upper_.data() + 9 * edge, upper_node_[static_cast<size_t>(edge)]);
    for (int64_t slot = lower_begin_[node]; slot < lower_begin_[node + 1]; ++slot)
      add(lower_.data() + 9 * slot, lower_node_[static_cast<size_t>(slot)]);
    squared_forces += force * force;
    squared_differences += of_differences * of_differences;
  }
  return Double4{energy, squared_forces, squared_differences, 0};
}

void StiffnessMatrix::DiagonalBlock(int64_t node, Double4 columns[3]) const {
  const auto n = static_cast<size_t>(node);
  for (int k = 0; k < 3; ++k) {
    Double4 sum = Splat(0);
    for (int64_t edge = upper_begin_[n]; edge < upper_begin_[n + 1]; ++edge)
      sum += LoadFloats(upper_.data() + 9 * edge + 3 * k);
    for (int64_t slot = lower_begin_[n]; slot < lower_begin_[n + 1]; ++slot)
      sum += LoadFloats(lower_.data() + 9 * slot + 3 * k);
    sum[k] += (*inertia_)[n];
    columns[k] = kCoordinates ? sum : Splat(0);
  }
  if (couplings_.empty()) return;
  for (const NodeCouplings::Entry& entry : couplings_.Rows(node, node + 1)) {
    if (entry.column != node) continue;
    for (int k = 0; k < 3; ++k) columns[k] += entry.columns[k];
  }
}

int64_t StiffnessMatrix::bytes() const {
  return static_cast<int64_t>((upper_.size() + lower_.size()) * sizeof(float) +
                              (upper_begin_.size() + upper_node_.size() + lower_begin_.size() +
                               lower_node_.size() + lower_edge_.size()) *
                                  sizeof(int32_t)) +
         couplings_.bytes();
}

}  // namespace cleave
