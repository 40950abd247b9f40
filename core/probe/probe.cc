#include "core/probe/probe.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/material/fibre_directions.h"
#include "core/probe/edge_failure.h"
#include "core/probe/material_point.h"
#include "core/probe/pulled_bar.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Vector3d UnitOf(const Vec3& v) {
  const Vector3d vector(v.data());
  return (vector / vector.cwiseAbs().maxCoeff()).normalized();
}
Vec3 Plain(const Vector3d& v) { return {v[0] + 0.0, v[1] + 0.0, v[2] + 0.0}; }  // without -0

std::vector<Vec3> FibreDirectionsOf(const MaterialProbe& probe) {
  if (!probe.fibre_directions.empty()) return probe.fibre_directions;
  std::vector<Vec3> directions;
  for (const FibreFamily& family : probe.material.fibres) {
    // Validation leaves none that the point does not decide.
    directions.push_back(FibreDirectionAt(family.direction, probe.point.value_or(Vec3{0, 0, 0}))
                             .value_or(Vec3{1, 0, 0}));
  }
  return directions;
}

ProbedPoint Probed(const MaterialPoint& point, const std::array<double, 9>& gradient) {
  Matrix3d g;
  for (int k = 0; k < 9; ++k)
    g(k / 3, k % 3) = gradient[static_cast<size_t>(k)] - (k % 4 == 0 ? 1 : 0);
  const PointResponse response = point.Respond(g);
  const Matrix9d tangent = point.Tangent(g);
  ProbedPoint probed;
  probed.energy = response.energy;
  for (int k = 0; k < 9; ++k) probed.stress[static_cast<size_t>(k)] = response.stress(k / 3, k % 3);
  for (int k = 0; k < 81; ++k) probed.tangent[static_cast<size_t>(k)] = tangent(k / 9, k % 9);
  return probed;
}

// Pulls one bar until it fails.
class PullTest {
 public:
  PullTest(const MaterialProbe& probe, const MaterialPoint& point, const Vector3d& direction)
      : probe_(probe), point_(point), direction_(direction), bar_(point, direction) {
    if (probe.material.tensile_strength.has_value() &&
        std::isfinite(*probe.material.tensile_strength)) {
      strength_ = *probe.material.tensile_strength;
    }
  }

  StressStrainCurve Run() {
    StressStrainCurve curve;
    curve.direction = Plain(direction_);
    curve.worst_edge = curve.direction;
    curve.youngs_modulus = bar_.YoungsModulus();
    curve.points.emplace_back();
    if (strength_ == 0.0) {  // breaks under no load at all
      curve.end = CurveEnd::kTensileStrength;
      return curve;
    }
    FindEnd(curve);
    Sample(curve);
    return curve;
  }

 private:
  EdgeFailure FailureOf(const PulledBar::State& state) const {
    if (!strength_.has_value()) return EdgeFailure{0, direction_, 1};
    const Matrix3d& stress = probe_.stress == FractureStress::kMatrix ? state.response.matrix_stress
                                                                      : state.response.stress;
    return WorstEdge(stress, state.g, point_.fibres(), *strength_, direction_);
  }

  // Pulls in growing steps, which end_ and the curve's end come from.
  void FindEnd(StressStrainCurve& curve) {
    constexpr double kGrowth = 1.3;
    const double largest = probe_.largest_strain;
    double strain = 1e-3 * largest;
    if (strength_.has_value())
      strain = std::clamp(0.01 * *strength_ / curve.youngs_modulus, 1e-12, strain);
    passed_.push_back(bar_.AtRest());
    while (true) {
      const std::optional<PulledBar::State> state = bar_.Pull(strain, passed_.back());
      if (!state.has_value()) {
        curve.end = CurveEnd::kNoEquilibrium;
        return;
      }
      if (FailureOf(*state).ratio >= 1) return NarrowFailure(*state, curve);
      passed_.push_back(*state);
      if (strain >= largest) return;
      strain = std::min(kGrowth * strain, largest);
    }
  }

  // The failure lies between the last state that passed and `failed`.
  void NarrowFailure(PulledBar::State failed, StressStrainCurve& curve) {
    for (int halving = 0; halving < 100; ++halving) {
      const PulledBar::State& below = passed_.back();
      if (failed.strain - below.strain <= 1e-13 * failed.strain) break;
      const std::optional<PulledBar::State> middle =
          bar_.Pull(0.5 * (below.strain + failed.strain), below);
      if (!middle.has_value()) break;
      if (FailureOf(*middle).ratio >= 1) {
        failed = *middle;
      } else if (middle->strain > below.strain) {
        passed_.push_back(*middle);
      } else {
        break;
      }
    }
    const EdgeFailure failure = FailureOf(failed);
    curve.end = failure.strength_factor > 1 + 1e-9 ? CurveEnd::kDirectionalStrength
                                                   : CurveEnd::kTensileStrength;
    passed_.push_back(failed);
  }

  // Fills the curve up to the last state that was found.
  void Sample(StressStrainCurve& curve) {
    const double end = passed_.back().strain;
    size_t near = 0;
    for (int k = 1; k <= probe_.samples; ++k) {
      const double strain = k == probe_.samples ? end : end * k / probe_.samples;
      while (near + 1 < passed_.size() && passed_[near + 1].strain <= strain) ++near;
      const std::optional<PulledBar::State> state = bar_.Pull(strain, passed_[near]);
      if (!state.has_value()) {
        curve.end = CurveEnd::kNoEquilibrium;
        return;
      }
      const EdgeFailure failure = FailureOf(*state);
      curve.worst_edge = Plain(failure.direction);
      curve.points.push_back({strain, state->nominal_stress,
                              state->nominal_stress * (1 + state->strain) / state->volume_ratio,
                              state->volume_ratio, state->response.energy, failure.ratio});
    }
  }

  const MaterialProbe& probe_;
  const MaterialPoint& point_;
  const Vector3d direction_;
  const PulledBar bar_;
  std::optional<double> strength_;  // Pa; absent: nothing breaks
  std::vector<PulledBar::State> passed_;
};

std::vector<Vec3> PullDirectionsOf(const MaterialProbe& probe, const MaterialPoint& point) {
  if (!probe.pull_directions.empty() || !probe.deformation_gradients.empty())
    return probe.pull_directions;
  if (point.fibres().empty()) return {{1, 0, 0}};
  const Vector3d along = point.fibres()[0].direction;
  return {Plain(along), Plain(along.unitOrthogonal())};
}

}  // namespace

ProbeReport RunProbe(const MaterialProbe& probe) {
  const std::vector<Vec3> fibre_directions = FibreDirectionsOf(probe);
  const MaterialPoint point(probe.material, fibre_directions);
  ProbeReport report;
  for (const std::array<double, 9>& gradient : probe.deformation_gradients)
    report.points.push_back(Probed(point, gradient));
  for (const Vec3& direction : PullDirectionsOf(probe, point))
    report.curves.push_back(PullTest(probe, point, UnitOf(direction)).Run());
  return report;
}

}  // namespace cleave
