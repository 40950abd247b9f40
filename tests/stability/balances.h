#ifndef CLEAVE_TESTS_STABILITY_BALANCES_H_
#define CLEAVE_TESTS_STABILITY_BALANCES_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/mesh/tet_geometry.h"
#include "core/scene/selection.h"
#include "core/simulation/simulation.h"
#include "tests/stability/hostile_input.h"

// What every run keeps, however hostile its input (method note, section 12).

namespace cleave {

// Whether what changes the body's momentum is what pushes it from outside: gravity, and the forces
// that motions report. Of steps that are a frame each and touch nothing rigid.
class MomentumBalance {
 public:
  explicit MomentumBalance(const HostileBody& body)
      : dt_(1 / body.scene.timing.frames_per_second),
        gravity_(body.scene.gravity.value_or(Vec3{0, 0, 0})),
        applies_(body.scene.colliders.empty() && body.scene.timing.steps_per_frame == 1),
        tolerance_(body.scene.quality.residual_tolerance),
        masses_(body.mesh.rest_positions.size(), 0) {
    const auto materials = AssignMaterials(body.scene.materials, body.mesh, RegionIndex(body.mesh));
    for (size_t tet = 0; tet < body.mesh.tets.size(); ++tet) {
      const double density = body.scene.materials[static_cast<size_t>(materials[tet])].density;
      const double volume = SignedVolume(CornersOf(body.mesh, static_cast<int64_t>(tet)));
      for (const int32_t node : body.mesh.tets[tet])
        masses_[static_cast<size_t>(node)] += density * volume / 4;
    }
    earlier_ = last_ = body.mesh.rest_positions;
  }

  // What is not accounted for, over what the solve was held to: about 1 at most, a little more in
  // float.
  double Excess(const FrameReport& report, const std::vector<Vec3>& positions) {
    double excess = 0;
    whole_steps_ = report.steps == 1 ? whole_steps_ + 1 : 0;
    if (applies_ && (whole_steps_ >= 2 || (whole_steps_ == 1 && report.frame == 1))) {
      double squares = 0, sizes = 0, rounding = 0;
      for (size_t axis = 0; axis < 3; ++axis) {
        double change = 0, forces = 0;
        for (size_t node = 0; node < masses_.size(); ++node) {
          const double inertia = masses_[node] / (dt_ * dt_);
          const double push =
              inertia * (positions[node][axis] - 2 * last_[node][axis] + earlier_[node][axis]);
          change += push;
          forces += masses_[node] * gravity_[axis];
          sizes += std::abs(push) + std::abs(masses_[node] * gravity_[axis]);
          rounding += inertia * std::abs(positions[node][axis]);
        }
        for (const Vec3& force : report.motion_forces) {
          forces += force[axis];
          sizes += std::abs(force[axis]);
        }
        squares += (change - forces) * (change - forces);
      }
      excess = std::sqrt(squares) / (tolerance_ * sizes + 1e-15 * rounding + 1e-300);
    }
    earlier_ = last_;
    last_ = positions;
    return excess;
  }

 private:
  const double dt_;  // s
  const Vec3 gravity_;
  const bool applies_;
  const double tolerance_;
  std::vector<double> masses_;        // kg
  std::vector<Vec3> earlier_, last_;  // m, a frame and two before
  int whole_steps_ = 0;
};

// Whether what comes in from outside is what the body holds more and what was taken out of it by
// name, and nothing is made.
class EnergyBalance {
 public:
  // What is not accounted for, as a share of the largest energy so far.
  double Gap(const FrameReport& report) {
    const double held = report.kinetic_energy + report.elastic_energy + report.contact_energy;
    const double taken = report.fracture_energy + report.plastic_work +
                         report.friction_dissipation + report.damping_dissipation +
                         report.integration_dissipation;
    for (const double energy : {report.external_work, held, taken})
      largest_ = std::max(largest_, std::abs(energy));
    if (largest_ == 0) return 0;
    // What a collider presses on before the first step is energy that nothing brought in.
    if (report.frame == 1 && report.contact_energy > 0) pressed_ = -taken;
    made_ = -(taken + pressed_);
    return std::abs(report.external_work - held - taken) / largest_;
  }
  // What the body holds beyond what came in, as such a share. One step may seem to make some where
  // energy is concave, as in what is crushed: work is the force at its end times the way.
  double Made() const { return largest_ == 0 ? 0 : made_ / largest_; }

 private:
  double largest_ = 0;  // J
  double pressed_ = 0;  // J, before the first step
  double made_ = 0;     // J
};

}  // namespace cleave

#endif  // CLEAVE_TESTS_STABILITY_BALANCES_H_
