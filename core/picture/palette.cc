#include "core/picture/palette.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cleave {
namespace {

constexpr int kRegionColors = 10;

constexpr Color FromHex(uint32_t hex) {
  return {static_cast<float>(hex >> 16 & 255u) / 255.0f,
          static_cast<float>(hex >> 8 & 255u) / 255.0f, static_cast<float>(hex & 255u) / 255.0f};
}

constexpr std::array<Color, kRegionColors> kOuter = {
    FromHex(0xB5532F), FromHex(0x3F6C8F), FromHex(0x5E8456), FromHex(0xC2922E), FromHex(0x7A4E84),
    FromHex(0x2F8580), FromHex(0xA23E5C), FromHex(0x6B6A4F), FromHex(0x4C5BA0), FromHex(0x8A6242)};

// Nine samples of the viridis map (published under CC0), evenly spaced.
constexpr std::array<Color, 9> kSequential = {
    FromHex(0x440154), FromHex(0x472D7B), FromHex(0x3B528B), FromHex(0x2C728E), FromHex(0x21918C),
    FromHex(0x28AE80), FromHex(0x5EC962), FromHex(0xADDC30), FromHex(0xFDE725)};

Color Mix(const Color& a, const Color& b, float t) {
  return {a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t, a[2] + (b[2] - a[2]) * t};
}

size_t RegionSlot(int32_t region) {
  return static_cast<size_t>((region % kRegionColors + kRegionColors) % kRegionColors);
}

// sRGB from OKLab's cylinder (Ottosson 2020): lightness, chroma, hue in rad.
Color FromOklch(double lightness, double chroma, double hue) {
  const double a = chroma * std::cos(hue);
  const double b = chroma * std::sin(hue);
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  const std::array<double, 3> linear = {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
                                        -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
                                        -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
  Color color{};
  for (size_t i = 0; i < 3; ++i) {
    const double x = std::clamp(linear[i], 0.0, 1.0);
    color[i] =
        static_cast<float>(x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1 / 2.4) - 0.055);
  }
  return color;
}

}  // namespace

Color RegionColor(int32_t region) { return kOuter[RegionSlot(region)]; }

Color InsideColor(int32_t region) {
  return Mix(kOuter[RegionSlot(region)], Color{0.98f, 0.93f, 0.84f}, 0.78f);
}

Color PieceColor(int32_t piece) {
  // Multiples of the golden ratio spread hues evenly however many pieces there are; two
  // lightnesses keep pieces apart whose hues come close.
  const double turn = 0.07 + 0.6180339887498949 * static_cast<double>(piece);
  const double hue = 2 * std::numbers::pi * (turn - std::floor(turn));
  return FromOklch((piece & 1) != 0 ? 0.62 : 0.72, 0.115, hue);
}

Color SequentialColor(double value) {
  const double place = std::clamp(value, 0.0, 1.0) * (kSequential.size() - 1);
  const auto low = std::min(static_cast<size_t>(place), kSequential.size() - 2);
  return Mix(kSequential[low], kSequential[low + 1],
             static_cast<float>(place - static_cast<double>(low)));
}

Color ImpurityColor(double value) {
  return Mix(FromHex(0xE8C53A), FromHex(0xC4168C), static_cast<float>(std::clamp(value, 0.0, 1.0)));
}

}  // namespace cleave
