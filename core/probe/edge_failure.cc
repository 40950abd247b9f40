#include "core/probe/edge_failure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/vec3.h"
#include "core/damage/edge_stress.h"
#include "core/damage/edge_thresholds.h"

namespace cleave {

using Eigen::Matrix3d;
using Eigen::Vector3d;

EdgeFailure WorstEdge(const Matrix3d& stress, const Matrix3d& g,
                      std::span<const MaterialPoint::Fibre> fibres, double tensile_strength,
                      const Vector3d& hint) {
  const auto failure_of = [&](const Vector3d& direction) {
    const Vector3d turned = direction + g * direction;
    const std::array<Vec3, 2> rest = {Vec3{0, 0, 0}, {direction[0], direction[1], direction[2]}};
    const std::array<Vec3, 2> current = {Vec3{0, 0, 0}, {turned[0], turned[1], turned[2]}};
    EdgeFailure failure;
    failure.direction = direction;
    for (const MaterialPoint::Fibre& fibre : fibres) {
      failure.strength_factor =
          std::max(failure.strength_factor,
                   DirectionalStrengthFactor(fibre.strength_ratio, fibre.direction.dot(direction)));
    }
    failure.ratio = EdgeDirections({0, 1}, current, rest).Project(stress) /
                    (tensile_strength * failure.strength_factor);
    return failure;
  };

  EdgeFailure worst = failure_of(hint);
  const auto consider = [&](const Vector3d& direction) {
    const EdgeFailure failure = failure_of(direction);
    // Only what is worse beyond rounding, so that ties do not hop about.
    const bool worse = failure.ratio > worst.ratio + 1e-12 * std::abs(worst.ratio);
    if (worse) worst = failure;
    return worse;
  };
  // Directions spread evenly over half a sphere: a spiral whose turns keep the golden angle.
  constexpr int kDirections = 200;
  const double golden_angle = M_PI * (3 - std::sqrt(5.0));
  for (int i = 0; i < kDirections; ++i) {
    const double height = (i + 0.5) / kDirections;
    const double radius = std::sqrt(1 - height * height);
    consider({radius * std::cos(golden_angle * i), radius * std::sin(golden_angle * i), height});
  }
  for (const MaterialPoint::Fibre& fibre : fibres) consider(fibre.direction);
  // Uphill from there. A maximum is flat: the last step leaves an error of its square.
  double step = 0.1;
  for (int round = 0; round < 1000 && step > 1e-7; ++round) {
    const Vector3d at = worst.direction;
    const Vector3d side = at.unitOrthogonal();
    const Vector3d other = at.cross(side);
    bool better = false;
    for (const Vector3d& way : {side, Vector3d(-side), other, Vector3d(-other)})
      better = consider((at + step * way).normalized()) || better;
    if (!better) step /= 2;
  }
  return worst;
}

}  // namespace cleave
