#include "core/stream/class_choice.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace cleave {
namespace {

constexpr size_t kMaxSamples = 384;  // places a group that are looked at
// What going on may cost against the best class, since it is what later frames go on from too.
constexpr float kPatience = 1.15f;
constexpr float kPatienceBits = 48;

}  // namespace

ClassChoice::ClassChoice() : bits_of_frequency_(kFrequencyOne + 1) {
  for (size_t frequency = 1; frequency < bits_of_frequency_.size(); ++frequency) {
    bits_of_frequency_[frequency] = static_cast<float>(static_cast<double>(kFrequencyBits) -
                                                       std::log2(static_cast<double>(frequency)));
  }
}

std::vector<uint8_t> ClassChoice::Choose(bool key, const InterpolationPredictor& predictor,
                                         const FrameMotion& motion,
                                         std::span<const Int32x4> residuals,
                                         std::span<const uint16_t> activities,
                                         const ResidualCoder& coder) {
  for (size_t c = 0; c < kClasses; ++c) {
    for (size_t symbol = 0; symbol < kMasks + kTokens; ++symbol) {
      bits_[c][symbol] = bits_of_frequency_[coder.Frequency(c, symbol)];
    }
  }
  const NodeOrder& order = predictor.order();
  std::vector<uint8_t> classes;
  bool all_go_on = true;
  for (int64_t group = 0; group < order.groups(); ++group) {
    const int32_t begin = order.group_begins[static_cast<size_t>(group)];
    const int32_t end = order.group_begins[static_cast<size_t>(group) + 1];
    const std::span<const int32_t> places = predictor.PlacesWithin(begin, end - begin);
    const size_t stride = key ? 1 : std::max<size_t>(1, places.size() / kMaxSamples);
    std::array<uint32_t, kMasks + kTokens> times{};
    float going_on = 0;
    for (size_t at = stride / 2; at < places.size(); at += stride) {
      const int32_t place = places[at];
      if (motion.Holds(predictor.pieces()[place])) continue;
      const Int32x4 r = residuals[static_cast<size_t>(place)];
      const auto& of_place = bits_[key ? 0 : ClassOf(activities[static_cast<size_t>(place)])];
      const size_t mask = SignBits(r != 0) & 7;
      ++times[mask];
      going_on += of_place[mask];
      for (int axis = 0; axis < 3; ++axis) {
        if (r[axis] == 0) continue;
        const size_t symbol = kMasks + ToToken(r[axis]).symbol;
        ++times[symbol];
        going_on += of_place[symbol];
      }
    }
    std::array<float, kClasses> costs{};
    for (size_t symbol = 0; symbol < times.size(); ++symbol) {
      if (times[symbol] == 0) continue;
      for (size_t c = 0; c < kClasses; ++c) {
        costs[c] += static_cast<float>(times[symbol]) * bits_[c][symbol];
      }
    }
    const auto least = std::min_element(costs.begin(), costs.end());
    const bool goes_on = !key && going_on <= kPatience * *least + kPatienceBits;
    all_go_on &= goes_on;
    classes.push_back(goes_on ? kGoesOn : static_cast<uint8_t>(least - costs.begin()));
  }
  if (all_go_on) classes.clear();
  return classes;
}

}  // namespace cleave
