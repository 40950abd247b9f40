#include "core/solver/constraints.h"

#include <algorithm>

namespace cleave {
namespace {

bool Holds(const PrescribedMotion& motion, const std::vector<uint8_t>& released) {
  return motion.release < 0 || released[static_cast<size_t>(motion.release)] == 0;
}

}  // namespace

std::vector<FixedNode> FindFixedNodes(const Model& model, const std::vector<uint8_t>& released) {
  std::vector<FixedNode> all;
  for (size_t node = 0; node < model.masses.size(); ++node) {
    if (model.masses[node] == 0)
      all.push_back({static_cast<int32_t>(node), Int64x4{-1, -1, -1, 0}});
  }
  for (const PrescribedMotion& motion : model.motions) {
    if (!Holds(motion, released)) continue;
    for (const int32_t node : motion.nodes) all.push_back({node, motion.axes});
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const FixedNode& a, const FixedNode& b) { return a.node < b.node; });
  std::vector<FixedNode> merged;
  for (const FixedNode& fixed : all) {
    if (!merged.empty() && merged.back().node == fixed.node) {
      merged.back().axes |= fixed.axes;
    } else {
      merged.push_back(fixed);
    }
  }
  return merged;
}

void ApplyMotions(const Model& model, const std::vector<uint8_t>& released, double time,
                  NodalVector& displacements) {
  for (const PrescribedMotion& motion : model.motions) {
    if (!Holds(motion, released)) continue;
    const Keyframe pose = PoseAt(motion, time);
    for (const int32_t node : motion.nodes) {
      const auto n = static_cast<size_t>(node);
      displacements[n] = motion.axes ? DisplacementAt(motion, pose, model.mesh->rest_positions[n])
                                     : displacements[n];
    }
  }
}

void AddMotionInfluences(const Model& model, const std::vector<uint8_t>& released, double time,
                         const NodalVector& displacements, std::vector<Influence>& influences) {
  for (const PrescribedMotion& motion : model.motions) {
    if (!Holds(motion, released)) continue;
    const Keyframe pose = PoseAt(motion, time);
    for (const int32_t node : motion.nodes) {
      const auto n = static_cast<size_t>(node);
      const Double4 way =
          DisplacementAt(motion, pose, model.mesh->rest_positions[n]) - displacements[n];
      if (Dot(motion.axes ? way * way : Splat(0), Splat(1)) > 0) influences.push_back({node, -1});
    }
  }
}

std::vector<Vec3> SumMotionForces(const Model& model, const std::vector<uint8_t>& released,
                                  const NodalVector& forces) {
  std::vector<Vec3> sums;
  for (const PrescribedMotion& motion : model.motions) {
    Double4 sum = Splat(0);
    if (Holds(motion, released)) {
      for (const int32_t node : motion.nodes) sum += forces[static_cast<size_t>(node)];
    }
    sums.push_back(ToVec3(motion.axes ? sum : Splat(0)));
  }
  return sums;
}

}  // namespace cleave
