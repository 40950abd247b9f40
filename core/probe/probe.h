#ifndef CLEAVE_CORE_PROBE_PROBE_H_
#define CLEAVE_CORE_PROBE_PROBE_H_

#include <array>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/stop_flag.h"
#include "core/base/vec3.h"
#include "core/scene/material_probe.h"

namespace cleave {

// The answer at a deformation gradient; matrices row by row. A ductile material has flowed from
// rest until it was at yield.
struct ProbedPoint {
  double energy = 0;               // J/m^3, elastic
  std::array<double, 9> stress{};  // first Piola-Kirchhoff, Pa
  // d2 psi / dF2, Pa, 9 x 9, not projected: row 3 i + j, column 3 k + l is dP_ij / dF_kl.
  std::array<double, 81> tangent{};  // at fixed flow
  double plastic_strain = 0;         // equivalent
};

// Why a stress-strain curve ends.
enum class CurveEnd {
  kLargestStrain,        // nothing failed up to there
  kTensileStrength,      // an edge's stress reached the tensile strength
  kDirectionalStrength,  // the same, of an edge that the fibres strengthen
  kCompressiveStrength,  // an edge was crushed
  kFailureStrain,        // the equivalent plastic strain reached the failure strain
  kNoEquilibrium,        // the material gives way: no bar is at rest beyond
};

struct CurvePoint {
  double strain = 0;          // change of length over length
  double nominal_stress = 0;  // Pa, force over the area at rest
  double true_stress = 0;     // Pa, force over the area now
  double volume_ratio = 1;    // det F
  double energy = 0;          // J/m^3, work done so far, that of plastic flow included
  double failure_ratio = 0;   // of the worst edge; 0 where nothing can break
  double plastic_strain = 0;  // equivalent
};

// What a slender bar along a direction does when it is pulled apart slowly, or pressed.
struct StressStrainCurve {
  Vec3 direction{0, 0, 0};         // unit
  double youngs_modulus = 0;       // Pa, slope at rest
  std::vector<CurvePoint> points;  // from rest; equal steps of strain
  CurveEnd end = CurveEnd::kLargestStrain;
  Vec3 worst_edge{0, 0, 0};  // rest direction of the edge with the largest failure ratio at the end
};

struct ProbeReport {
  std::vector<ProbedPoint> points;        // a deformation gradient each
  std::vector<StressStrainCurve> curves;  // a direction each
};

// Evaluates a material. Precondition: ValidateProbe found no error. Takes at most about a second,
// by the limits of a probe. Errors: Cancelled when `stop` was requested, looked for at every
// deformation gradient and every state of a bar. Source: method note, sections 2, 5 and 11.
absl::StatusOr<ProbeReport> RunProbe(const MaterialProbe& probe, const StopFlag& stop);

}  // namespace cleave

#endif  // CLEAVE_CORE_PROBE_PROBE_H_
