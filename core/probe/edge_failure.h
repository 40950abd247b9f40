#ifndef CLEAVE_CORE_PROBE_EDGE_FAILURE_H_
#define CLEAVE_CORE_PROBE_EDGE_FAILURE_H_

#include <Eigen/Core>
#include <limits>
#include <span>

#include "core/probe/material_point.h"

namespace cleave {

// What edges of a material withstand.
struct MaterialStrength {
  double tensile = std::numeric_limits<double>::infinity();      // Pa, > 0
  double compressive = std::numeric_limits<double>::infinity();  // Pa, > 0
};

// The edge that would break first.
struct EdgeFailure {
  double ratio = 0;                                      // stress over threshold; breaks at 1
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  // of the edge at rest, unit
  double strength_factor = 1;                            // of its direction, on tensile strength
  bool crushed = false;                                  // by compression
};

// The largest failure ratio among edges of every direction, as a fine mesh has them, where all tets
// have the deformation gradient I + g, this plastic flow and the stress `stress`, dpsi/dF_e in Pa.
// `hint` is a direction that is tried too, unit. Source: method note, sections 2 and 6.
EdgeFailure WorstEdge(const Eigen::Matrix3d& stress, const Eigen::Matrix3d& g,
                      const PlasticState& plastic, std::span<const MaterialPoint::Fibre> fibres,
                      const MaterialStrength& strength, const Eigen::Vector3d& hint);

}  // namespace cleave

#endif  // CLEAVE_CORE_PROBE_EDGE_FAILURE_H_
