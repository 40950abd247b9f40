#include "tests/metrics/statistics.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/base/counter_rng.h"

namespace cleave {
namespace {

std::vector<size_t> OrderOf(std::span<const double> values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return values[a] < values[b]; });
  return order;
}

std::vector<double> Ranks(std::span<const double> values) {
  const std::vector<size_t> order = OrderOf(values);
  std::vector<double> ranks(values.size());
  for (size_t begin = 0; begin < order.size();) {
    size_t end = begin + 1;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    const double rank = (static_cast<double>(begin) + static_cast<double>(end) - 1) / 2;
    for (size_t i = begin; i < end; ++i) ranks[order[i]] = rank;
    begin = end;
  }
  return ranks;
}

}  // namespace

double Median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

double Percentile(std::span<const double> values, double share, std::span<const double> weights) {
  const auto weight = [&](size_t i) { return weights.empty() ? 1.0 : weights[i]; };
  double total = 0;
  for (size_t i = 0; i < values.size(); ++i) total += weight(i);
  const std::vector<size_t> order = OrderOf(values);
  double below = 0;
  for (const size_t i : order) {
    below += weight(i);
    if (below >= share * total) return values[i];
  }
  return values[order.back()];
}

double Spearman(std::span<const double> x, std::span<const double> y) {
  const std::vector<double> a = Ranks(x);
  const std::vector<double> b = Ranks(y);
  const double mean = (static_cast<double>(a.size()) - 1) / 2;
  double ab = 0, aa = 0, bb = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - mean) * (b[i] - mean);
    aa += (a[i] - mean) * (a[i] - mean);
    bb += (b[i] - mean) * (b[i] - mean);
  }
  return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

double Jaccard(std::span<const int32_t> a, std::span<const int32_t> b) {
  std::vector<int32_t> common;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
  const size_t all = a.size() + b.size() - common.size();
  return all == 0 ? 1 : static_cast<double>(common.size()) / static_cast<double>(all);
}

GroupComparison CompareGroups(size_t count, size_t first,
                              const std::function<double(size_t i, size_t j)>& distance,
                              uint32_t seed, int regroupings) {
  std::vector<double> distances(count * count, 0);
  for (size_t i = 0; i < count; ++i) {
    for (size_t j = 0; j < i; ++j)
      distances[i * count + j] = distances[j * count + i] = distance(i, j);
  }
  std::vector<size_t> order(count);
  std::iota(order.begin(), order.end(), size_t{0});
  const auto compare = [&] {
    GroupComparison means;
    double pairs_within = 0, pairs_between = 0;
    for (size_t i = 0; i < count; ++i) {
      for (size_t j = 0; j < i; ++j) {
        const bool same = (i < first) == (j < first);
        (same ? means.within : means.between) += distances[order[i] * count + order[j]];
        (same ? pairs_within : pairs_between) += 1;
      }
    }
    means.within /= pairs_within;
    means.between /= pairs_between;
    return means;
  };
  GroupComparison found = compare();
  // Regroupings that differ from this one by rounding alone are as far apart.
  const double excess = found.between - found.within - 1e-12 * found.within;
  int as_far = 1;
  for (int round = 0; round < regroupings; ++round) {
    for (size_t i = count; i > 1; --i) {
      const double draw =
          UniformDraw(seed, RandomStream::kEdgeDeal, i, static_cast<uint64_t>(round));
      std::swap(order[i - 1], order[static_cast<size_t>(draw * static_cast<double>(i))]);
    }
    const GroupComparison other = compare();
    as_far += other.between - other.within >= excess ? 1 : 0;
  }
  found.p = static_cast<double>(as_far) / (regroupings + 1);
  return found;
}

}  // namespace cleave
