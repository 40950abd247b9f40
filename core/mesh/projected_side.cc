#include "core/mesh/projected_side.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace cleave {
namespace {

// The exact sum a + b as a rounded sum and what rounding took.
struct Pair {
  double high, low;
};

Pair Sum(double a, double b) {
  const double high = a + b;
  const double part = high - a;
  return {high, (a - (high - part)) + (b - part)};
}

Pair Product(double a, double b) {
  const double high = a * b;
  return {high, std::fma(a, b, -high)};
}

// A number as a sum of doubles that do not overlap, by ascending size.
class Expansion {
 public:
  void Add(double value) {
    if (value == 0) return;
    for (size_t i = 0; i < size_; ++i) {
      const Pair sum = Sum(value, parts_[i]);
      parts_[i] = sum.low;
      value = sum.high;
    }
    parts_[size_++] = value;
  }
  void AddProduct(double a, double b, double c) {
    const Pair ab = Product(a, b);
    for (const double factor : {ab.low, ab.high}) {
      const Pair abc = Product(factor, c);
      Add(abc.low);
      Add(abc.high);
    }
  }
  int Sign() const {
    for (size_t i = size_; i > 0; --i) {
      if (parts_[i - 1] != 0) return parts_[i - 1] > 0 ? 1 : -1;
    }
    return 0;
  }

 private:
  std::array<double, 6 * 4 * 4> parts_;  // six terms, two pairs each, four parts a product
  size_t size_ = 0;
};

// The terms of a determinant, row by row, and their signs.
struct Term {
  size_t i, j, k;
  int sign;
};
constexpr Term kTerms[6] = {{0, 1, 2, 1},  {0, 2, 1, -1}, {1, 2, 0, 1},
                            {1, 0, 2, -1}, {2, 0, 1, 1},  {2, 1, 0, -1}};

// Differences round once, terms twice more, sums five times; far above them all.
constexpr double kRounding = 16 * std::numeric_limits<double>::epsilon();

}  // namespace

int ProjectedSide(const Vec3& direction, const Vec3& a, const Vec3& b, const Vec3& c) {
  std::array<Pair, 3> u, v;
  for (size_t i = 0; i < 3; ++i) {
    u[i] = Sum(b[i], -a[i]);
    v[i] = Sum(c[i], -a[i]);
  }
  double determinant = 0, bound = 0;
  for (const auto& [i, j, k, sign] : kTerms) {
    const double term = u[i].high * direction[j] * v[k].high;
    determinant += sign * term;
    bound += std::abs(term);
  }
  if (std::abs(determinant) > kRounding * bound) return determinant > 0 ? 1 : -1;
  Expansion exact;
  for (const auto& [i, j, k, sign] : kTerms) {
    if (direction[j] == 0) continue;
    for (const double first : {u[i].low, u[i].high}) {
      for (const double last : {v[k].low, v[k].high}) {
        if (first != 0 && last != 0) exact.AddProduct(first, sign * direction[j], last);
      }
    }
  }
  return exact.Sign();
}

bool CrossesCurtain(const Vec3& direction, const Vec3& start, const Vec3& end, const Vec3& first,
                    const Vec3& second) {
  const bool first_over = ProjectedSide(direction, start, end, first) >= 0;
  const bool second_over = ProjectedSide(direction, start, end, second) >= 0;
  if (first_over == second_over) return false;
  return ProjectedSide(direction, first, second, start) *
             ProjectedSide(direction, first, second, end) <=
         0;
}

}  // namespace cleave
