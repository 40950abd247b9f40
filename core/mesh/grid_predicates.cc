#include "core/mesh/grid_predicates.h"

#include <array>
#include <cmath>
#include <limits>

namespace cleave {
namespace {

// Debian's compilers all have it; -Wpedantic does not know.
__extension__ typedef __int128 Int128;

template <typename Number>
using Row = std::array<Number, 3>;

template <typename Number>
Number Determinant(const Row<Number>& a, const Row<Number>& b, const Row<Number>& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Determinant of absolute values with all terms added: bounds the rounding of Determinant.
double Permanent(const Row<double>& a, const Row<double>& b, const Row<double>& c) {
  const auto abs = [](double x) { return std::abs(x); };
  return abs(a[0]) * (abs(b[1] * c[2]) + abs(b[2] * c[1])) +
         abs(a[1]) * (abs(b[2] * c[0]) + abs(b[0] * c[2])) +
         abs(a[2]) * (abs(b[0] * c[1]) + abs(b[1] * c[0]));
}

Row<double> Difference(const GridPoint& a, const GridPoint& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}

Row<Int128> Exact(const Row<double>& row) {
  return {static_cast<int64_t>(row[0]), static_cast<int64_t>(row[1]), static_cast<int64_t>(row[2])};
}

template <typename Number>
int Sign(Number x) {
  return x > 0 ? 1 : (x < 0 ? -1 : 0);
}

// Differences of coordinates are exact, every operation after rounds once; far above the handful of
// roundings that a term goes through.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

}  // namespace

int Orientation(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d) {
  const Row<double> u = Difference(b, a);
  const Row<double> v = Difference(c, a);
  const Row<double> w = Difference(d, a);
  const double volume = Determinant(u, v, w);
  if (std::abs(volume) > kRounding * Permanent(u, v, w)) return Sign(volume);
  return Sign(Determinant(Exact(u), Exact(v), Exact(w)));
}

int InSphere(const GridPoint& a, const GridPoint& b, const GridPoint& c, const GridPoint& d,
             const GridPoint& p) {
  const std::array<Row<double>, 4> rows = {Difference(a, p), Difference(b, p), Difference(c, p),
                                           Difference(d, p)};
  const std::array<double, 4> weights = {a.weight, b.weight, c.weight, d.weight};
  // Squared distances stay below 2^48: exact. A heavier point has a larger sphere of its own.
  std::array<double, 4> lift;
  for (size_t i = 0; i < 4; ++i) {
    lift[i] = rows[i][0] * rows[i][0] + rows[i][1] * rows[i][1] + rows[i][2] * rows[i][2] -
              weights[i] + p.weight;
  }
  constexpr size_t kOthers[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  double sum = 0;
  double bound = 0;
  for (size_t i = 0; i < 4; ++i) {
    const auto& [j, k, l] = kOthers[i];
    sum += lift[i] * Determinant(rows[j], rows[k], rows[l]);
    bound += std::abs(lift[i]) * Permanent(rows[j], rows[k], rows[l]);
  }
  if (std::abs(sum) > kRounding * bound) return Sign(sum);
  // |differences| < 2^23 and |lift| < 2^48: the sum of four products stays below 2^124.
  Int128 exact = 0;
  for (size_t i = 0; i < 4; ++i) {
    const auto& [j, k, l] = kOthers[i];
    exact += static_cast<Int128>(static_cast<int64_t>(lift[i])) *
             Determinant(Exact(rows[j]), Exact(rows[k]), Exact(rows[l]));
  }
  return Sign(exact);
}

}  // namespace cleave
