#include "core/scene/material_probe.h"

#include <string>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/scene/checker.h"
#include "core/scene/limits.h"
#include "core/scene/material_rules.h"

namespace cleave {
namespace {

void CheckPlaces(const MaterialProbe& probe, Faults& faults, Checker& check) {
  if (probe.point.has_value()) check.Coordinates("point", *probe.point);
  const size_t families = probe.material.fibres.size();
  if (!probe.fibre_directions.empty()) {
    if (probe.fibre_directions.size() != families) {
      faults.Error("fibre_directions",
                   absl::StrCat("has ", probe.fibre_directions.size(),
                                " directions; the material has ", families, " families of fibres"));
    }
    if (!check.List("fibre_directions", probe.fibre_directions.size(), limits::kMaxFibreFamilies))
      return;
    for (size_t k = 0; k < probe.fibre_directions.size(); ++k)
      check.Direction(At("fibre_directions", k), probe.fibre_directions[k]);
    return;
  }
  for (size_t k = 0; k < families; ++k) {
    const FibreDirection& direction = probe.material.fibres[k].direction;
    const std::string field = At("material.fibres", k);
    if (std::holds_alternative<TetDirections>(direction)) {
      faults.Error("fibre_directions",
                   absl::StrCat("is missing; ", field,
                                ".per_tet has a direction a tet, and a probe has no tets"));
    } else if (!probe.point.has_value() &&
               (std::holds_alternative<CylindricalDirection>(direction) ||
                std::holds_alternative<CurveDirections>(direction))) {
      faults.Error("point",
                   absl::StrCat("is missing; the direction of ", field,
                                " depends on the place: give a point or fibre_directions"));
    }
  }
}

}  // namespace

Faults ValidateProbe(const MaterialProbe& probe) {
  Faults faults;
  Checker check(faults);
  CheckMaterial("material", probe.material, faults, check);
  CheckPlaces(probe, faults, check);
  if (check.List("deformation_gradients", probe.deformation_gradients.size(),
                 limits::kMaxProbeGradients)) {
    for (size_t i = 0; i < probe.deformation_gradients.size(); ++i) {
      for (size_t k = 0; k < 9; ++k) {
        check.Within(At(At("deformation_gradients", i), k), probe.deformation_gradients[i][k],
                     -limits::kMaxProbeStretch, limits::kMaxProbeStretch);
      }
    }
  }
  if (check.List("pull_directions", probe.pull_directions.size(), limits::kMaxPullDirections)) {
    for (size_t i = 0; i < probe.pull_directions.size(); ++i)
      check.Direction(At("pull_directions", i), probe.pull_directions[i]);
  }
  if (probe.largest_strain.has_value()) {
    check.Within("largest_strain", *probe.largest_strain, limits::kMinProbeStrain,
                 limits::kMaxProbeStrain);
    if (*probe.largest_strain == 0) faults.Error("largest_strain", "is 0: bars stay at rest");
  }
  check.Count("samples", probe.samples, 1, limits::kMaxProbeSamples);
  return faults;
}

}  // namespace cleave
