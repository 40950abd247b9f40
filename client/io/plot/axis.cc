#include "client/io/plot/axis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "absl/strings/str_format.h"

namespace cleave {
namespace {

// The round step nearest to `step`, by ratio.
double RoundStep(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  double best = power;
  for (const double factor : {2.0, 5.0, 10.0}) {
    if (std::abs(std::log(factor * power / step)) < std::abs(std::log(best / step))) {
      best = factor * power;
    }
  }
  return best;
}

std::pair<double, const char*> PrefixFor(double largest) {
  constexpr std::array<std::pair<double, const char*>, 7> kPrefixes = {
      {{1e9, "G"}, {1e6, "M"}, {1e3, "k"}, {1, ""}, {1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}}};
  for (const auto& prefix : kPrefixes) {
    if (largest >= prefix.first) return prefix;
  }
  return {1, ""};
}

}  // namespace

Axis MakeAxis(double low, double high, int wanted, bool prefixed, bool whole) {
  if (!(high - low > 1e-12 * std::max(std::abs(low), std::abs(high)))) {
    const double room = std::max(std::abs(low) * 0.1, whole ? 1.0 : 1e-9);
    if (low == 0 && !whole) {
      high = 1;
    } else {
      high += room;
    }
  }
  double step = RoundStep((high - low) / wanted);
  if (whole) step = std::max(step, 1.0);
  Axis axis;
  axis.low = step * std::floor(low / step + 1e-9);
  axis.high = step * std::ceil(high / step - 1e-9);
  double scale = 1;
  if (prefixed) {
    const auto [factor, name] = PrefixFor(std::max(std::abs(axis.low), std::abs(axis.high)));
    scale = factor;
    axis.prefix = name;
  }
  const int decimals =
      std::clamp(static_cast<int>(std::ceil(-std::log10(step / scale) - 1e-9)), 0, 12);
  const auto steps = static_cast<int>(std::lround((axis.high - axis.low) / step));
  for (int i = 0; i <= steps; ++i) {
    axis.ticks.push_back(axis.low + i * step);
    axis.labels.push_back(absl::StrFormat("%.*f", decimals, axis.ticks.back() / scale));
  }
  return axis;
}

std::string WithPrefix(double value, absl::string_view unit) {
  // What three digits round up to a thousand has the next prefix.
  const auto [factor, name] = PrefixFor(std::abs(value) * 1.0005);
  return absl::StrFormat("%.3g %s%s", value / factor, name, unit);
}

}  // namespace cleave
