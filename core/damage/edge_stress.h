#ifndef CLEAVE_CORE_DAMAGE_EDGE_STRESS_H_
#define CLEAVE_CORE_DAMAGE_EDGE_STRESS_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>

#include "core/base/vec3.h"

namespace cleave {

// An edge's current and rest direction, of unit length; zero for an edge of length zero.
struct EdgeDirections {
  Eigen::Vector3d current, rest;

  EdgeDirections(const std::array<int32_t, 2>& nodes, std::span<const Vec3> positions,
                 std::span<const Vec3> rest_positions)
      : current(Between(nodes, positions)), rest(Between(nodes, rest_positions)) {}

  // d^T P N, Pa per rest area, of a first Piola-Kirchhoff stress (method note, section 2): bounded
  // as a tet flattens, unchanged by rotation, and the force over the rest area in a pulled bar.
  double Project(const Eigen::Matrix3d& stress) const { return current.dot(stress * rest); }
  // The same of dPsi/dF_e where F_p has turned and stretched the rest direction: stress per area of
  // what flow has made of the rest shape, near true stress. Precondition: det F_p > 0.
  double Project(const Eigen::Matrix3d& stress, const Eigen::Matrix3d& plastic) const {
    const Eigen::Vector3d flowed = plastic * rest;
    const double length = flowed.norm();
    return length > 0 ? current.dot(stress * flowed) / length : 0;
  }

 private:
  static Eigen::Vector3d Between(const std::array<int32_t, 2>& nodes,
                                 std::span<const Vec3> positions) {
    const Eigen::Vector3d edge = Eigen::Vector3d(positions[static_cast<size_t>(nodes[1])].data()) -
                                 Eigen::Vector3d(positions[static_cast<size_t>(nodes[0])].data());
    const double length = edge.norm();
    return length > 0 ? Eigen::Vector3d(edge / length) : Eigen::Vector3d::Zero();
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_EDGE_STRESS_H_
