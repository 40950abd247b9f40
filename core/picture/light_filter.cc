#include "core/picture/light_filter.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace cleave {

Eigen::Vector3f FilteredColor(const LitPixels& pixels, int x, int y, float radius) {
  // Together these weigh each of the 4 x 4 sets of rays the same: two boxes of width four.
  constexpr std::array<float, 7> kWeights = {1, 2, 3, 4, 3, 2, 1};
  const LitPixel& pixel = pixels.at(x, y);
  if (pixel.mixed) return pixel.color + pixel.extra;
  Eigen::Vector3f light = Eigen::Vector3f::Zero();
  float sum = 0;
  for (int dy = -3; dy <= 3; ++dy) {
    for (int dx = -3; dx <= 3; ++dx) {
      const int qx = x + dx;
      const int qy = y + dy;
      if (qx < 0 || qy < 0 || qx >= pixels.width || qy >= pixels.height) continue;
      const LitPixel& other = pixels.at(qx, qy);
      if (other.mixed || other.normal.dot(pixel.normal) < 0.85f) continue;
      const float apart = std::abs((other.position - pixel.position).dot(pixel.normal));
      if (apart > 0.006f * radius) continue;
      const float weight =
          kWeights[static_cast<size_t>(dx + 3)] * kWeights[static_cast<size_t>(dy + 3)];
      light += weight * other.light;
      sum += weight;
    }
  }
  return pixel.albedo.cwiseProduct(light / sum) + pixel.extra;
}

}  // namespace cleave
