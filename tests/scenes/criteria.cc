#include "tests/scenes/criteria.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_cat.h"

namespace cleave {

double Trial::Get(const std::string& variant, const std::string& metric) const {
  const auto metrics = variants.find(variant);
  if (metrics != variants.end()) {
    const auto found = metrics->second.find(metric);
    if (found != metrics->second.end()) return found->second;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

bool Condition::Met(double measured) const {
  switch (relation) {
    case Relation::kAtMost:
      return measured <= limit;
    case Relation::kAtLeast:
      return measured >= limit;
    case Relation::kBelow:
      return measured < limit;
    case Relation::kAbove:
      return measured > limit;
  }
  return false;
}

std::string Condition::Bound() const {
  constexpr const char* kWords[] = {"at most ", "at least ", "below ", "above "};
  return absl::StrCat(kWords[static_cast<size_t>(relation)], limit);
}

int TrialsNeeded(const Criterion& criterion, int trials) {
  // Half of them are not yet the median.
  if (criterion.share == kHalf) return trials / 2 + 1;
  return static_cast<int>(std::ceil(criterion.share * trials - 1e-9));
}

Finding Judge(const Criterion& criterion, std::span<const Trial> trials) {
  Finding finding;
  finding.values.resize(criterion.conditions.size());
  for (const Trial& trial : trials) {
    bool met = true, measured = true;
    for (size_t i = 0; i < criterion.conditions.size(); ++i) {
      const Condition& condition = criterion.conditions[i];
      const double value = condition.value(trial);
      finding.values[i].push_back(value);
      met = met && condition.Met(value);
      measured = measured && !std::isnan(value);
    }
    finding.met += met ? 1 : 0;
    finding.unmeasured += measured ? 0 : 1;
  }
  const auto all = static_cast<int>(trials.size());
  const int good = criterion.control ? all - finding.met - finding.unmeasured : finding.met;
  finding.holds = all > 0 && good >= TrialsNeeded(criterion, all);
  return finding;
}

std::vector<std::string> VariantsOf(std::span<const Criterion> criteria) {
  std::vector<std::string> variants;
  for (const Criterion& criterion : criteria) {
    for (const std::string& variant : criterion.variants) {
      if (std::find(variants.begin(), variants.end(), variant) == variants.end())
        variants.push_back(variant);
    }
  }
  return variants;
}

Value Of(std::string variant, std::string metric) {
  return [variant = std::move(variant), metric = std::move(metric)](const Trial& trial) {
    return trial.Get(variant, metric);
  };
}

Value Ratio(Value upper, Value lower) {
  return [upper = std::move(upper), lower = std::move(lower)](const Trial& trial) {
    return upper(trial) / lower(trial);
  };
}

Value Difference(Value from, Value what) {
  return [from = std::move(from), what = std::move(what)](const Trial& trial) {
    return from(trial) - what(trial);
  };
}

}  // namespace cleave
