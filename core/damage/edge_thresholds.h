#ifndef CLEAVE_CORE_DAMAGE_EDGE_THRESHOLDS_H_
#define CLEAVE_CORE_DAMAGE_EDGE_THRESHOLDS_H_

#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// The failure threshold of every edge, Pa, from the tensile strength of every tet, Pa (>= 0;
// infinite: never breaks). An edge takes the smallest strength among its tets: the mean stress of
// an edge on an interface pulls on both sides alike, so the weaker side gives first, and a bond is
// never stronger than what it bonds. So an edge on the interface of a material that never breaks
// has its neighbour's strength, and only edges wholly inside such a material are infinite.
std::vector<double> EdgeThresholds(const Incidence& incidence,
                                   std::span<const double> tet_strengths);

// How many times the strength counts for an edge whose rest direction and the fibre make an angle
// of this cosine; `ratio` R >= 1 is the strength along the fibre over that across it. Source:
// method note, section 2.
inline double DirectionalStrengthFactor(double ratio, double cosine) {
  return 1 + (ratio - 1) * cosine * cosine;
}

// A tet whose strength along a direction exceeds that across it.
struct DirectionalStrength {
  int32_t tet = 0;
  Vec3 direction{0, 0, 0};  // unit
  double ratio = 1;         // R >= 1
};

// The same, where in some tets strength depends on the edge's rest direction; of several records
// for a tet the largest factor counts.
std::vector<double> EdgeThresholds(const TetMesh& mesh, const Incidence& incidence,
                                   std::span<const double> tet_strengths,
                                   std::span<const DirectionalStrength> directional);

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_EDGE_THRESHOLDS_H_
