#ifndef CLEAVE_CLIENT_IO_SERIES_MOVED_POINTS_H_
#define CLEAVE_CLIENT_IO_SERIES_MOVED_POINTS_H_

#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/surface/point_motion.h"
#include "core/surface/surface_topology.h"

namespace cleave {

// Follows the points of a topology through the frames of one run, and how fast they go. Not
// thread-safe; loops run on the caller's TBB arena.
class MovedPoints {
 public:
  // `mesh` and `incidence` must outlive this object.
  MovedPoints(const TetMesh& mesh, const Incidence& incidence) : motion_(mesh, incidence) {}

  // Goes on to the frame at `time` (s) with the nodes at `node_positions` (m). `topology` may be
  // another one than in the last frame only where `changed` is set. Precondition: a position a
  // node, all finite; frames come by ascending time.
  void Advance(const SurfaceTopology& topology, bool changed,
               const std::vector<Vec3>& node_positions, double time, bool with_velocities);

  const std::vector<Vec3>& points() const { return points_; }  // m
  // m/s, means since the frame before: 0 in the first frame. Empty without velocities.
  const std::vector<Vec3>& velocities() const { return velocities_; }

 private:
  PointMotion motion_;
  bool started_ = false;
  double time_ = 0;
  std::vector<Vec3> node_positions_;  // of the last frame
  std::vector<Vec3> points_;
  std::vector<Vec3> previous_points_;  // points of this topology, a frame ago
  std::vector<Vec3> velocities_;
};

// How far points are from where their topology has them at rest, m.
std::vector<Vec3> Displacements(const SurfaceTopology& topology, const std::vector<Vec3>& points);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SERIES_MOVED_POINTS_H_
