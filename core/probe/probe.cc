#include "core/probe/probe.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "absl/status/status.h"
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
  PlasticState plastic;
  point.Flow(g, plastic);
  const PointResponse response = point.Respond(g, plastic);
  const Matrix9d tangent = point.Tangent(g, plastic);
  ProbedPoint probed;
  probed.plastic_strain = plastic.strain;
  probed.energy = response.energy;
  for (int k = 0; k < 9; ++k) probed.stress[static_cast<size_t>(k)] = response.stress(k / 3, k % 3);
  for (int k = 0; k < 81; ++k) probed.tangent[static_cast<size_t>(k)] = tangent(k / 9, k % 9);
  return probed;
}

// Why a bar would fail.
struct Failure {
  double ratio = 0;
  CurveEnd end = CurveEnd::kTensileStrength;
  Vector3d edge;
};

// Pulls one bar until it fails, or until `stop`: then what it returns is of no use.
class PullTest {
 public:
  PullTest(const MaterialProbe& probe, const MaterialPoint& point, const Vector3d& direction,
           const StopFlag& stop)
      : probe_(probe), point_(point), direction_(direction), stop_(stop), bar_(point, direction) {
    const Material& material = probe.material;
    strength_.tensile = material.tensile_strength.value_or(strength_.tensile);
    strength_.compressive = material.compressive_strength.value_or(strength_.compressive);
    if (material.plasticity.has_value() && material.plasticity->failure_strain.has_value())
      failure_strain_ = *material.plasticity->failure_strain;
  }

  StressStrainCurve Run() {
    StressStrainCurve curve;
    curve.direction = Plain(direction_);
    curve.worst_edge = curve.direction;
    curve.youngs_modulus = bar_.YoungsModulus();
    curve.points.emplace_back();
    if (strength_.tensile == 0) {  // breaks under no load at all
      curve.end = CurveEnd::kTensileStrength;
      return curve;
    }
    FindEnd(curve);
    Sample(curve);
    return curve;
  }

 private:
  Failure FailureOf(const PulledBar::State& state) const {
    const EdgeFailure edge =
        WorstEdge(probe_.stress == FractureStress::kMatrix ? state.response.matrix_stress
                                                           : state.response.elastic_stress,
                  state.g, state.plastic, point_.fibres(), strength_, direction_);
    Failure failure{edge.ratio, CurveEnd::kTensileStrength, edge.direction};
    if (edge.crushed) {
      failure.end = CurveEnd::kCompressiveStrength;
    } else if (edge.strength_factor > 1 + 1e-9) {
      failure.end = CurveEnd::kDirectionalStrength;
    }
    const double ductile = state.plastic.strain / failure_strain_;
    if (ductile > failure.ratio) failure = {ductile, CurveEnd::kFailureStrain, direction_};
    return failure;
  }

  bool CanFail() const {
    return std::isfinite(strength_.tensile) || std::isfinite(strength_.compressive) ||
           std::isfinite(failure_strain_);
  }

  // Pulls in growing steps, which `passed_` and the curve's end come from.
  void FindEnd(StressStrainCurve& curve) {
    constexpr double kGrowth = 1.3;
    const double farthest = probe_.largest_strain.value_or(CanFail() ? 10 : 1);
    const double largest = std::abs(farthest), sign = farthest < 0 ? -1 : 1;
    const double weakest = std::min(strength_.tensile, strength_.compressive);
    double strain =
        std::min(std::max(0.01 * weakest / curve.youngs_modulus, 1e-12), 1e-3 * largest);
    passed_.push_back(bar_.AtRest());
    while (!stop_.requested()) {
      const std::optional<PulledBar::State> state = bar_.Pull(sign * strain, passed_.back());
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
    for (int halving = 0; halving < 100 && !stop_.requested(); ++halving) {
      const PulledBar::State& below = passed_.back();
      const double gap = std::abs(failed.strain - below.strain);
      if (gap <= 1e-13 * std::abs(failed.strain)) break;
      const std::optional<PulledBar::State> middle =
          bar_.Pull(0.5 * (below.strain + failed.strain), below);
      if (!middle.has_value()) break;
      if (FailureOf(*middle).ratio >= 1) {
        failed = *middle;
      } else if (middle->strain != below.strain) {
        passed_.push_back(*middle);
      } else {
        break;
      }
    }
    curve.end = FailureOf(failed).end;
    passed_.push_back(failed);
  }

  // Fills the curve up to the last state that was found.
  void Sample(StressStrainCurve& curve) {
    const double end = passed_.back().strain;
    size_t near = 0;
    for (int k = 1; k <= probe_.samples && !stop_.requested(); ++k) {
      const double strain = k == probe_.samples ? end : end * k / probe_.samples;
      while (near + 1 < passed_.size() && std::abs(passed_[near + 1].strain) <= std::abs(strain))
        ++near;
      // What flowed on the way is that of the nearest state before.
      const std::optional<PulledBar::State> state =
          k == probe_.samples ? passed_.back() : bar_.Pull(strain, passed_[near]);
      if (!state.has_value()) {
        curve.end = CurveEnd::kNoEquilibrium;
        return;
      }
      const Failure failure = FailureOf(*state);
      // An edge has no sign; this one points with the pull.
      curve.worst_edge =
          Plain(failure.edge.dot(direction_) < 0 ? Vector3d(-failure.edge) : failure.edge);
      CurvePoint& point = curve.points.emplace_back();
      point.strain = strain;
      point.nominal_stress = state->nominal_stress;
      point.true_stress = state->nominal_stress * (1 + state->strain) / state->volume_ratio;
      point.volume_ratio = state->volume_ratio;
      point.energy = state->response.energy + point_.FlowWork(state->plastic.strain);
      point.failure_ratio = failure.ratio;
      point.plastic_strain = state->plastic.strain;
    }
  }

  const MaterialProbe& probe_;
  const MaterialPoint& point_;
  const Vector3d direction_;
  const StopFlag& stop_;
  const PulledBar bar_;
  MaterialStrength strength_;
  double failure_strain_ = std::numeric_limits<double>::infinity();
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

absl::StatusOr<ProbeReport> RunProbe(const MaterialProbe& probe, const StopFlag& stop) {
  const std::vector<Vec3> fibre_directions = FibreDirectionsOf(probe);
  const MaterialPoint point(probe.material, fibre_directions);
  ProbeReport report;
  for (const std::array<double, 9>& gradient : probe.deformation_gradients) {
    if (stop.requested()) break;
    report.points.push_back(Probed(point, gradient));
  }
  for (const Vec3& direction : PullDirectionsOf(probe, point))
    report.curves.push_back(PullTest(probe, point, UnitOf(direction), stop).Run());
  if (stop.requested()) return absl::CancelledError("stopped inside a probe");
  return report;
}

}  // namespace cleave
