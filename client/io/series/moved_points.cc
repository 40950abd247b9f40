#include "client/io/series/moved_points.h"

#include <cstddef>
#include <utility>

namespace cleave {

void MovedPoints::Advance(const SurfaceTopology& topology, bool changed,
                          const std::vector<Vec3>& node_positions, double time,
                          bool with_velocities) {
  if (with_velocities && started_) {
    if (changed) {
      // By a copy: what nodes remember of their deformation is not to depend on who asks for
      // velocities.
      PointMotion(motion_).Move(topology, node_positions_, previous_points_);
    } else {
      std::swap(previous_points_, points_);
    }
  }
  motion_.Move(topology, node_positions, points_);
  if (with_velocities) {
    velocities_.assign(points_.size(), Vec3{0, 0, 0});
    const double step = time - time_;
    for (size_t i = 0; started_ && step > 0 && i < points_.size(); ++i) {
      for (size_t k = 0; k < 3; ++k) {
        velocities_[i][k] = (points_[i][k] - previous_points_[i][k]) / step;
      }
    }
    node_positions_ = node_positions;
  }
  time_ = time;
  started_ = true;
}

std::vector<Vec3> Displacements(const SurfaceTopology& topology, const std::vector<Vec3>& points) {
  std::vector<Vec3> displacements(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) {
      displacements[i][k] = points[i][k] - topology.points[i].rest[k];
    }
  }
  return displacements;
}

}  // namespace cleave
