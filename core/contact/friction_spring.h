#ifndef CLEAVE_CORE_CONTACT_FRICTION_SPRING_H_
#define CLEAVE_CORE_CONTACT_FRICTION_SPRING_H_

#include <Eigen/Core>
#include <algorithm>

namespace cleave {

// Coulomb friction as a spring (N/m) whose force ends at a cap (N): it sticks below and slips
// there. A stretch (m) is what lies between two points across their common normal.
struct FrictionSpring {
  double stiffness;
  double cap;

  bool Sticks(double length) const { return stiffness * length <= cap; }
  // J.
  double Energy(double length) const {
    return Sticks(length) ? 0.5 * stiffness * length * length
                          : cap * (length - 0.5 * cap / stiffness);
  }
  // N, on the first point.
  Eigen::Vector3d Force(const Eigen::Vector3d& stretch) const {
    const double length = stretch.norm();
    return -(Sticks(length) ? stiffness : cap / length) * stretch;
  }
  // N/m, in the plane across the unit normal: that of the parabola which touches the energy at this
  // stretch and lies above it everywhere. The energy's own curvature along a stretch that slips is
  // 0, whatever waits beyond the turning point, and steps that trust it go far too far.
  Eigen::Matrix3d Stiffness(const Eigen::Vector3d& stretch, const Eigen::Vector3d& normal) const {
    const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - normal * normal.transpose();
    const double length = stretch.norm();
    return (Sticks(length) ? stiffness : cap / length) * plane;
  }
  // N/m, the energy's own second derivative in that plane, semidefinite: 0 along a stretch that
  // slips.
  Eigen::Matrix3d ExactStiffness(const Eigen::Vector3d& stretch,
                                 const Eigen::Vector3d& normal) const {
    const double length = stretch.norm();
    if (Sticks(length)) return Stiffness(stretch, normal);
    const Eigen::Vector3d along = stretch / length;
    return Stiffness(stretch, normal) - cap / length * along * along.transpose();
  }
  // The stretch that is left when what is beyond either cap has slipped away.
  Eigen::Vector3d Kept(const Eigen::Vector3d& stretch, double next_cap) const {
    const double length = stretch.norm();
    const double longest = std::min(cap, next_cap) / stiffness;
    return length > longest ? Eigen::Vector3d(longest / length * stretch) : stretch;
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_CONTACT_FRICTION_SPRING_H_
