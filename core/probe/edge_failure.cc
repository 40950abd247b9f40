#include "core/probe/edge_failure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/vec3.h"
#include "core/damage/edge_stress.h"
#include "core/damage/edge_thresholds.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vec3 Plain(const Vector3d& v) { return {v[0], v[1], v[2]}; }

}  // namespace

EdgeFailure WorstEdge(const Matrix3d& stress, const Matrix3d& g, const PlasticState& plastic,
                      std::span<const MaterialPoint::Fibre> fibres,
                      const MaterialStrength& strength, const Vector3d& hint) {
  const Matrix3d elastic = ElasticChange(g, plastic);
  // Of an edge whose direction after flow, N_p, is this.
  const auto failure_of = [&](const Vector3d& flowed) {
    const Vector3d current = flowed + elastic * flowed;
    EdgeFailure failure;
    failure.direction = (flowed + plastic.inverse_change * flowed).normalized();
    for (const MaterialPoint::Fibre& fibre : fibres) {
      failure.strength_factor = std::max(
          failure.strength_factor,
          DirectionalStrengthFactor(fibre.strength_ratio, fibre.direction.dot(failure.direction)));
    }
    const std::array<Vec3, 2> at_rest = {Vec3{0, 0, 0}, Plain(flowed)};
    const std::array<Vec3, 2> now = {Vec3{0, 0, 0}, Plain(current)};
    const double load = EdgeDirections({0, 1}, now, at_rest).Project(stress);
    failure.crushed = load < 0;
    failure.ratio = failure.crushed ? -load / strength.compressive
                                    : load / (strength.tensile * failure.strength_factor);
    return failure;
  };

  Vector3d worst_flowed = hint;
  EdgeFailure worst = failure_of(hint);
  const auto consider = [&](const Vector3d& flowed) {
    const EdgeFailure failure = failure_of(flowed);
    // Only what is worse beyond rounding, so that ties do not hop about.
    if (!(failure.ratio > (1 + 1e-12) * worst.ratio)) return false;
    worst = failure;
    worst_flowed = flowed;
    return true;
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
    const Vector3d at = worst_flowed;
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
