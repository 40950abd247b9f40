#include "proto/convert/probe.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/base/status.h"
#include "core/scene/presets.h"
#include "proto/convert/field_reader.h"
#include "proto/convert/scene.h"

namespace cleave {
namespace {

v1::CurveEnd MessageFromEnd(CurveEnd end) {
  switch (end) {
    case CurveEnd::kLargestStrain:
      return v1::CURVE_END_LARGEST_STRAIN;
    case CurveEnd::kTensileStrength:
      return v1::CURVE_END_TENSILE_STRENGTH;
    case CurveEnd::kDirectionalStrength:
      return v1::CURVE_END_DIRECTIONAL_STRENGTH;
    case CurveEnd::kCompressiveStrength:
      return v1::CURVE_END_COMPRESSIVE_STRENGTH;
    case CurveEnd::kFailureStrain:
      return v1::CURVE_END_FAILURE_STRAIN;
    case CurveEnd::kNoEquilibrium:
      break;
  }
  return v1::CURVE_END_NO_EQUILIBRIUM;
}

void WriteCurve(const StressStrainCurve& curve, v1::StressStrainCurve& message) {
  message.mutable_direction()->Add(curve.direction.begin(), curve.direction.end());
  message.set_youngs_modulus(curve.youngs_modulus);
  message.set_end(MessageFromEnd(curve.end));
  message.mutable_worst_edge()->Add(curve.worst_edge.begin(), curve.worst_edge.end());
  for (const CurvePoint& point : curve.points) {
    message.add_strain(point.strain);
    message.add_nominal_stress(point.nominal_stress);
    message.add_true_stress(point.true_stress);
    message.add_volume_ratio(point.volume_ratio);
    message.add_energy(point.energy);
    message.add_failure_ratio(point.failure_ratio);
    message.add_plastic_strain(point.plastic_strain);
  }
}

}  // namespace

MaterialProbe ProbeFromMessage(const v1::ProbeMaterialRequest& message, Faults& faults) {
  const FieldReader read(faults);
  MaterialProbe probe;
  probe.material = MaterialFromMessage(message.material(), "material", faults);
  if (message.stress() == v1::FRACTURE_STRESS_TOTAL) {
    probe.stress = FractureStress::kTotal;
  } else if (message.stress() > v1::FRACTURE_STRESS_TOTAL || message.stress() < 0) {
    faults.Error("stress",
                 absl::StrCat(static_cast<int>(message.stress()), " is not a FractureStress"));
  }
  if (message.point_size() != 0 && message.point_size() != 3) {
    faults.Error("point",
                 absl::StrCat("has ", message.point_size(), " numbers; three are required"));
  } else if (message.point_size() == 3) {
    probe.point = Vec3{message.point(0), message.point(1), message.point(2)};
  }
  probe.fibre_directions = read.Groups<3>("fibre_directions", message.fibre_directions());
  probe.deformation_gradients =
      read.Groups<9>("deformation_gradients", message.deformation_gradients());
  probe.pull_directions = read.Groups<3>("pull_directions", message.pull_directions());
  if (message.has_largest_strain()) probe.largest_strain = message.largest_strain();
  if (message.has_samples()) probe.samples = message.samples();
  return probe;
}

absl::StatusOr<v1::ProbeMaterialResponse> AnswerProbe(const v1::ProbeMaterialRequest& request,
                                                      const StopFlag& stop, Faults& faults) {
  v1::ProbeMaterialResponse response;
  const MaterialProbe probe = ProbeFromMessage(request, faults);
  faults.Append("", ValidateProbe(probe));
  if (!faults.ok()) return response;
  *response.mutable_material() = MessageFromMaterial(probe.material);
  for (const Fault& warning : faults.warnings())
    response.add_warnings(absl::StrCat(warning.field, ": ", warning.description));
  CLEAVE_ASSIGN_OR_RETURN(const ProbeReport report, RunProbe(probe, stop));
  for (const ProbedPoint& point : report.points) {
    v1::ProbedPoint* to = response.add_points();
    to->set_energy(point.energy);
    to->set_plastic_strain(point.plastic_strain);
    to->mutable_stress()->Add(point.stress.begin(), point.stress.end());
    to->mutable_tangent()->Add(point.tangent.begin(), point.tangent.end());
  }
  for (const StressStrainCurve& curve : report.curves) WriteCurve(curve, *response.add_curves());
  return response;
}

v1::ListMaterialPresetsResponse PresetsMessage() {
  v1::ListMaterialPresetsResponse response;
  for (const MaterialPreset& preset : MaterialPresets()) {
    v1::MaterialPreset* to = response.add_presets();
    to->set_name(preset.material.name);
    to->set_description(preset.description);
    *to->mutable_material() = MessageFromMaterial(preset.material);
    for (const std::string& source : preset.sources) to->add_sources(source);
  }
  return response;
}

}  // namespace cleave
