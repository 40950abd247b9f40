#ifndef CLEAVE_TESTS_METRICS_STATISTICS_H_
#define CLEAVE_TESTS_METRICS_STATISTICS_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

// What criteria over several runs are made of.

namespace cleave {

// The middle value, the mean of the two middle ones for an even count. Precondition: not empty.
double Median(std::vector<double> values);

// The smallest value below which at least `share` of the weight lies; without weights every value
// weighs 1. Preconditions: not empty, share in [0, 1], a weight each.
double Percentile(std::span<const double> values, double share,
                  std::span<const double> weights = {});

// Spearman's rank correlation, equal values sharing their mean rank; 0 where one side is constant.
// Precondition: equal lengths.
double Spearman(std::span<const double> x, std::span<const double> y);

// Size of the intersection over that of the union (Jaccard index, IoU) of two ascending lists; 1
// for two empty ones.
double Jaccard(std::span<const int32_t> a, std::span<const int32_t> b);

// Two groups by the distances between their members.
struct GroupComparison {
  double within = 0;   // mean distance of two of one group, of both groups' pairs
  double between = 0;  // of one of each
  // Share of random regroupings in which `between` exceeds `within` by as much: small where the
  // groups differ.
  double p = 1;
};
// `distance` of members i and j, symmetric; the first `first` of `count` are one group. Random by
// `seed`. Precondition: at least two in each group. Source: permutation test, as in Good,
// "Permutation, Parametric and Bootstrap Tests of Hypotheses", 2005.
GroupComparison CompareGroups(size_t count, size_t first,
                              const std::function<double(size_t i, size_t j)>& distance,
                              uint32_t seed, int regroupings = 999);

// How many of `values` are true by `holds`.
template <typename Predicate>
int CountWhere(std::span<const double> values, Predicate holds) {
  int count = 0;
  for (const double value : values) count += holds(value) ? 1 : 0;
  return count;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_METRICS_STATISTICS_H_
