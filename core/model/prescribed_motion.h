#ifndef CLEAVE_CORE_MODEL_PRESCRIBED_MOTION_H_
#define CLEAVE_CORE_MODEL_PRESCRIBED_MOTION_H_

#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/model/nodal_vector.h"
#include "core/scene/scene.h"

namespace cleave {

// Nodes whose displacement along some axes is given as a function of time.
struct PrescribedMotion {
  std::vector<int32_t> nodes;   // the solver's ids, ascending
  Int64x4 axes = {0, 0, 0, 0};  // all ones along prescribed axes, 0 elsewhere and in the last lane
  std::vector<Keyframe> keyframes;
  Double4 center;        // m, of the rotation
  Double4 axis;          // of the rotation, unit length
  int32_t release = -1;  // its place in Model::releases; -1: never let go
};

// Where a body that follows `motion` is at `time` (s): keyframes interpolated, held before the
// first and after the last.
Keyframe PoseAt(const PrescribedMotion& motion, double time);

// Displacement from rest, m, of a point that follows `pose`: rotated about the motion's axis, then
// translated. Exact zero for the zero pose.
Double4 DisplacementAt(const PrescribedMotion& motion, const Keyframe& pose,
                       const Vec3& rest_position);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_PRESCRIBED_MOTION_H_
