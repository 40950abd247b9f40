#ifndef CLEAVE_CORE_PROBE_PULLED_BAR_H_
#define CLEAVE_CORE_PROBE_PULLED_BAR_H_

#include <Eigen/Core>
#include <array>
#include <optional>
#include <utility>

#include "core/probe/material_point.h"

namespace cleave {

// A slender bar of a material, pulled along a direction, its sides free: it contracts, and with
// fibres askew to it shears, until no stress acts on the sides. That state minimises the energy at
// the given stretch. A ductile one flows until it is at yield; it stays straight and does not neck.
class PulledBar {
 public:
  // `direction` is of unit length. `point` must outlive this object.
  PulledBar(const MaterialPoint& point, const Eigen::Vector3d& direction);

  struct State {
    double strain = 0;                            // change of length over length
    Eigen::Matrix3d g = Eigen::Matrix3d::Zero();  // F - I
    PlasticState plastic;
    PointResponse response;
    double nominal_stress = 0;  // Pa, force over the area at rest
    double volume_ratio = 1;    // det F
  };

  // Pa, the slope of nominal stress over strain at rest.
  double YoungsModulus() const;
  State AtRest() const;
  // The state at `strain` > -1, looked for from `near`, a state of this bar on the way there.
  // nullopt where none is found: the material gives way.
  std::optional<State> Pull(double strain, const State& near) const;

 private:
  static constexpr int kFree = 5;
  using Unknowns = Eigen::Matrix<double, kFree, 1>;
  using Curvature = Eigen::Matrix<double, kFree, kFree>;

  // In the frame of the bar.
  Eigen::Matrix3d Turned(const Eigen::Matrix3d& matrix) const;
  Curvature CurvatureAt(const State& state, Unknowns* with_strain, double* of_strain) const;
  // With the flow of `near`.
  std::optional<State> Rest(double strain, const State& near) const;

  const MaterialPoint& point_;
  Eigen::Matrix3d frame_;  // its first column is the direction
};

}  // namespace cleave

#endif  // CLEAVE_CORE_PROBE_PULLED_BAR_H_
