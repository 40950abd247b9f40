#ifndef CLEAVE_TESTS_METRICS_STRAIN_H_
#define CLEAVE_TESTS_METRICS_STRAIN_H_

#include <cstdint>
#include <span>

#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/stream/frame.h"

namespace cleave {

// The largest principal stretch of a tet minus 1 at the node positions of `frame`.
double PrincipalStrain(const TetMesh& mesh, int32_t tet, const Frame& frame);

// From the centroid of the most strained tet in the last frame without broken edges to the nearest
// midpoint of an edge that broke in the next, at rest, m; -1 where nothing broke after the first
// frame.
double StrainToFirstCrack(const TetMesh& mesh, const Incidence& incidence,
                          std::span<const Frame> frames);

}  // namespace cleave

#endif  // CLEAVE_TESTS_METRICS_STRAIN_H_
