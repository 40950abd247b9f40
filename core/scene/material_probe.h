#ifndef CLEAVE_CORE_SCENE_MATERIAL_PROBE_H_
#define CLEAVE_CORE_SCENE_MATERIAL_PROBE_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/faults.h"
#include "core/base/vec3.h"
#include "core/scene/scene.h"

namespace cleave {

// What is asked of a material without a body of it, as plain data in SI units; mirrors
// ProbeMaterialRequest of proto/cleave/v1/material.proto.
struct MaterialProbe {
  Material material;
  FractureStress stress = FractureStress::kMatrix;  // which stress breaks edges
  // Fibres whose direction depends on the place need one of the two: a place, or their directions.
  std::optional<Vec3> point;  // m, at rest
  std::vector<Vec3>
      fibre_directions;  // a family each, in place of the material's; any length but 0
  // Where energy, stress and tangent are wanted, row by row.
  std::vector<std::array<double, 9>> deformation_gradients;
  // Along which bars are pulled until they fail; any length but 0. If neither these nor gradients
  // are given: along the first family of fibres and across it, or x.
  std::vector<Vec3> pull_directions;
  // Change of length over length, where a bar that holds is let go; below 0 bars are pressed; absent:
  // 10 for what can break, else 1.
  std::optional<double> largest_strain;
  int32_t samples = 100;      // steps of equal strain a curve
};

// Everything wrong with a probe, fields as in ProbeMaterialRequest.
Faults ValidateProbe(const MaterialProbe& probe);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_MATERIAL_PROBE_H_
