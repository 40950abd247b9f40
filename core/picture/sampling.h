#ifndef CLEAVE_CORE_PICTURE_SAMPLING_H_
#define CLEAVE_CORE_PICTURE_SAMPLING_H_

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace cleave {

// Point `index` of a sequence that fills the unit square evenly from its first points on: the
// lattice of the plastic number (Roberts 2018), shifted by `shift` so that uses do not agree.
inline std::array<float, 2> Spread(uint32_t index, uint32_t shift) {
  const double i = static_cast<double>(index);
  const double u = 0.5 + 0.7548776662466927 * i + 0.3819660112501051 * shift;
  const double v = 0.5 + 0.5698402909980532 * i + 0.2360679774997897 * shift;
  return {static_cast<float>(u - std::floor(u)), static_cast<float>(v - std::floor(v))};
}

// Two directions square to `normal` and to each other.
inline std::array<Eigen::Vector3f, 2> Tangents(const Eigen::Vector3f& normal) {
  const float sign = std::copysign(1.0f, normal.z());
  const float a = -1 / (sign + normal.z());
  const float b = normal.x() * normal.y() * a;
  return {Eigen::Vector3f(1 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x()),
          Eigen::Vector3f(b, sign + normal.y() * normal.y() * a, -normal.y())};
}

// A direction about `normal`, as likely as light from there counts, for a `place` in the unit
// square.
inline Eigen::Vector3f CosineDirection(const Eigen::Vector3f& normal,
                                       const std::array<float, 2>& place) {
  const auto [t, s] = Tangents(normal);
  const float r = std::sqrt(place[0]);
  const float angle = 2 * std::numbers::pi_v<float> * place[1];
  return r * std::cos(angle) * t + r * std::sin(angle) * s + std::sqrt(1 - place[0]) * normal;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_SAMPLING_H_
