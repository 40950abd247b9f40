#ifndef CLEAVE_CORE_PICTURE_LIGHT_FILTER_H_
#define CLEAVE_CORE_PICTURE_LIGHT_FILTER_H_

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace cleave {

// Means over the rays of a pixel, before the light is smoothed.
struct LitPixel {
  Eigen::Vector3f light = Eigen::Vector3f::Zero();  // irradiance
  Eigen::Vector3f albedo = Eigen::Vector3f::Zero();
  Eigen::Vector3f extra = Eigen::Vector3f::Zero();  // added as it is: shine, backdrop
  Eigen::Vector3f color = Eigen::Vector3f::Zero();  // albedo times light, ray by ray
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  Eigen::Vector3f position = Eigen::Vector3f::Zero();  // m
  float distance = 0;                                  // m
  bool mixed = false;                                  // the rays met different things

  void Divide(float rays) {
    light /= rays;
    albedo /= rays;
    extra /= rays;
    color /= rays;
    normal /= rays;
    position /= rays;
    distance /= rays;
  }
};

struct LitPixels {
  int width;
  int height;
  std::vector<LitPixel> pixels;

  LitPixels(int image_width, int image_height)
      : width(image_width),
        height(image_height),
        pixels(static_cast<size_t>(image_width) * static_cast<size_t>(image_height)) {}
  LitPixel& at(int x, int y) {
    return pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
  }
  const LitPixel& at(int x, int y) const { return const_cast<LitPixels*>(this)->at(x, y); }
};

// The linear colour of a pixel, its light averaged with that of the pixels around which lie in the
// same plane; pixels on edges keep their own. `radius` (m) is the scene's size.
Eigen::Vector3f FilteredColor(const LitPixels& pixels, int x, int y, float radius);

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_LIGHT_FILTER_H_
