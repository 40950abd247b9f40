#ifndef CLEAVE_CORE_DAMAGE_EDGE_STRESS_H_
#define CLEAVE_CORE_DAMAGE_EDGE_STRESS_H_

#include <Eigen/Core>
#include <array>
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
