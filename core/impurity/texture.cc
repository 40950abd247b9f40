#include "core/impurity/texture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace cleave {
namespace {

// Which of `count` texels stands at `index`, that may lie beyond the border.
int64_t Wrapped(int64_t index, int64_t count, TextureWrap wrap) {
  if (wrap == TextureWrap::kClamp) return std::clamp<int64_t>(index, 0, count - 1);
  const int64_t period = wrap == TextureWrap::kMirror ? 2 * count : count;
  const int64_t within = (index % period + period) % period;
  return within < count ? within : 2 * count - 1 - within;
}

}  // namespace

double TextureShare(const SurfaceTexture& texture, double u, double v) {
  const double x = u * texture.width - 0.5, y = (1 - v) * texture.height - 0.5;
  const auto column = static_cast<int64_t>(std::floor(x));
  const auto row = static_cast<int64_t>(std::floor(y));
  const auto at = [&](int64_t i, int64_t j) {
    const int64_t texel = Wrapped(j, texture.height, texture.wrap) * texture.width +
                          Wrapped(i, texture.width, texture.wrap);
    return static_cast<double>(texture.values[static_cast<size_t>(texel)]) / 255;
  };
  const double right = x - std::floor(x), down = y - std::floor(y);
  const double share = (1 - down) * ((1 - right) * at(column, row) + right * at(column + 1, row)) +
                       down * ((1 - right) * at(column, row + 1) + right * at(column + 1, row + 1));
  // Rounding of the weights may leave [0, 1].
  return std::clamp(texture.invert ? 1 - share : share, 0.0, 1.0);
}

}  // namespace cleave
