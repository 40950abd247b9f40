#include "core/model/prescribed_motion.h"

#include <algorithm>
#include <cmath>

namespace cleave {

Keyframe PoseAt(const PrescribedMotion& motion, double time) {
  const auto& keys = motion.keyframes;
  if (keys.empty()) return Keyframe{};
  const auto next = std::upper_bound(keys.begin(), keys.end(), time,
                                     [](double t, const Keyframe& key) { return t < key.time; });
  if (next == keys.begin()) return keys.front();
  if (next == keys.end()) return keys.back();
  const Keyframe& from = *(next - 1);
  const double share = (time - from.time) / (next->time - from.time);
  Keyframe pose = from;
  pose.time = time;
  for (size_t i = 0; i < 3; ++i)
    pose.translation[i] += share * (next->translation[i] - from.translation[i]);
  pose.rotation += share * (next->rotation - from.rotation);
  return pose;
}

Double4 DisplacementAt(const PrescribedMotion& motion, const Keyframe& pose,
                       const Vec3& rest_position) {
  const Double4 arm = ToDouble4(rest_position) - motion.center;
  // Rodrigues' formula less the identity; 1 - cos without cancellation.
  const double half = std::sin(pose.rotation / 2);
  const Double4 turned = Cross(motion.axis, arm);
  return ToDouble4(pose.translation) + std::sin(pose.rotation) * turned +
         2 * half * half * Cross(motion.axis, turned);
}

}  // namespace cleave
