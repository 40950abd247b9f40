#ifndef CLEAVE_CORE_PROBE_EDGE_FAILURE_H_
#define CLEAVE_CORE_PROBE_EDGE_FAILURE_H_

#include <Eigen/Core>
#include <span>

#include "core/probe/material_point.h"

namespace cleave {

// The edge that would break first.
struct EdgeFailure {
  double ratio = 0;                                      // stress over threshold; breaks at 1
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // of the edge at rest, unit
  double strength_factor = 1;                            // of its direction, on the strength
};

// The largest failure ratio among edges of every direction, as a fine mesh has them, where all tets
// have the first Piola-Kirchhoff stress `stress` (Pa) and the deformation gradient I + g. `hint` is
// a direction that is tried too. Precondition: tensile_strength > 0, Pa. Source: method note,
// section 2.
EdgeFailure WorstEdge(const Eigen::Matrix3d& stress, const Eigen::Matrix3d& g,
                      std::span<const MaterialPoint::Fibre> fibres, double tensile_strength,
                      const Eigen::Vector3d& hint);

}  // namespace cleave

#endif  // CLEAVE_CORE_PROBE_EDGE_FAILURE_H_
