#include "core/scene/material_rules.h"

#include <cmath>
#include <limits>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/scene/limits.h"

namespace cleave {
namespace {

struct DirectionRules {
  std::string field;
  Faults& faults;
  Checker& check;

  void operator()(std::monostate) const {
    faults.Error(field,
                 "names no direction; one of constant, cylindrical, per_tet, curves is required");
  }
  void operator()(const ConstantDirection& constant) const {
    check.Direction(field + ".constant.vector", constant.vector);
    const double length = std::hypot(constant.vector[0], constant.vector[1], constant.vector[2]);
    if (length > 0 && std::abs(length - 1) > 1e-6) {
      faults.Warning(field + ".constant.vector",
                     absl::StrCat("has length ", length, "; only its direction counts"));
    }
  }
  void operator()(const CylindricalDirection& cylindrical) const {
    check.Coordinates(field + ".cylindrical.center", cylindrical.center);
    check.Direction(field + ".cylindrical.axis", cylindrical.axis);
    check.Direction(field + ".cylindrical.mixture", cylindrical.mixture);
  }
  void operator()(const TetDirections& directions) const {
    const std::string list = field + ".per_tet.vectors";
    if (!check.List(list, directions.vectors.size(), limits::kMaxTets)) return;
    for (size_t k = 0; k < directions.vectors.size(); ++k)
      check.Direction(At(list, k), directions.vectors[k]);
  }
  void operator()(const CurveDirections& directions) const {
    const std::string list = field + ".curves.curves";
    size_t points = 0;
    for (const Polyline& curve : directions.curves) points += curve.points.size();
    if (!check.List(list + "[*].points", points, limits::kMaxCurvePoints)) return;
    bool directed = false;
    for (size_t i = 0; i < directions.curves.size(); ++i) {
      const std::vector<Vec3>& curve = directions.curves[i].points;
      if (curve.size() < 2)
        faults.Error(At(list, i, "points"), "has fewer than two points: no direction");
      for (size_t k = 0; k < curve.size(); ++k) {
        check.Coordinates(At(At(list, i, "points"), k), curve[k]);
        directed = directed || (k > 0 && curve[k] != curve[k - 1]);
      }
    }
    if (!directed) faults.Error(list, "has no segment of any length: no direction");
  }
};

void CheckFibres(const std::string& field, const FibreFamily& family, double youngs_modulus,
                 Faults& faults, Checker& check) {
  check.Within(field + ".stiffness", family.stiffness, 0, limits::kMaxYoungsModulus);
  if (family.stiffness >= limits::kHardFibreRatio * youngs_modulus && youngs_modulus > 0) {
    faults.Warning(field + ".stiffness",
                   absl::StrCat(family.stiffness, " Pa is over ", limits::kHardFibreRatio,
                                " times Young's modulus: solves will be slow"));
  }
  check.Within(field + ".strength_ratio", family.strength_ratio, 1, limits::kMaxStrengthRatio);
  std::visit(DirectionRules{field, faults, check}, family.direction);
}

void CheckPlasticity(const std::string& field, const Material& material,
                     const Plasticity& plasticity, Faults& faults, Checker& check) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  check.Above(field + ".yield_stress", plasticity.yield_stress, 0, limits::kMaxYoungsModulus);
  check.Within(field + ".hardening", plasticity.hardening, 0, limits::kMaxYoungsModulus);
  check.Above(field + ".flow_rate", plasticity.flow_rate, 0, kInfinity);
  if (plasticity.failure_strain.has_value()) {
    check.Above(field + ".failure_strain", *plasticity.failure_strain, 0, kInfinity);
    if (!(material.tensile_strength.value_or(kInfinity) < kInfinity))
      faults.Error(field + ".failure_strain",
                   "needs a finite tensile_strength: without one the material never breaks");
  }
  const bool fails_by_strain = plasticity.failure_strain.value_or(kInfinity) < kInfinity;
  if (!material.tensile_strength.has_value() || !(*material.tensile_strength < kInfinity)) return;
  if (plasticity.yield_stress >= *material.tensile_strength) {
    faults.Warning(field + ".yield_stress",
                   absl::StrCat(plasticity.yield_stress, " Pa is not below the tensile strength, ",
                                *material.tensile_strength, " Pa: breaks before it yields"));
  } else if (plasticity.hardening == 0 && !fails_by_strain) {
    faults.Warning(field + ".hardening",
                   "is 0 without a failure_strain: stress stays at yield, below the strength, and "
                   "slow pulling breaks nothing");
  }
}

void CheckFatigue(const std::string& field, const Material& material, const Fatigue& fatigue,
                  Faults& faults, Checker& check) {
  check.Above(field + ".strength_coefficient", fatigue.strength_coefficient, 0,
              limits::kMaxYoungsModulus);
  check.Within(field + ".strength_exponent", fatigue.strength_exponent, limits::kMinFatigueExponent,
               limits::kMaxFatigueExponent);
  if (fatigue.endurance_limit.has_value())
    check.Within(field + ".endurance_limit", *fatigue.endurance_limit, 0,
                 limits::kMaxYoungsModulus);
  check.Above(field + ".degradation_exponent", fatigue.degradation_exponent, 0,
              limits::kMaxDegradationExponent);
  const double strength = material.tensile_strength.value_or(0);
  if (!(strength > 0 && std::isfinite(strength))) {
    faults.Error(field, "needs a tensile_strength above 0 and finite: it is what cycles take from");
  } else if (fatigue.strength_coefficient < strength) {
    faults.Warning(field + ".strength_coefficient",
                   absl::StrCat(fatigue.strength_coefficient, " Pa is below the tensile strength, ",
                                strength, " Pa: loads near it last less than a cycle"));
  }
}

void CheckStrands(const std::string& field, const Material& material, const Strands& strands,
                  Faults& faults, Checker& check) {
  check.Within(field + ".residual_factor", strands.residual_factor, limits::kMinResidualFactor,
               limits::kMaxResidualFactor);
  check.Above(field + ".stretch_limit", strands.stretch_limit, 1, limits::kMaxStretchLimit);
  if (!std::isfinite(material.tensile_strength.value_or(INFINITY)))
    faults.Error(field, "needs a finite tensile_strength: without one nothing tears");
  if (material.plasticity.has_value())
    faults.Error(field, "are elastic, but plasticity is set: their rest length would be lost");
}

}  // namespace

void CheckMaterial(const std::string& field, const Material& material, Faults& faults,
                   Checker& check) {
  const auto at = [&](absl::string_view name) { return absl::StrCat(field, ".", name); };
  check.Name(at("name"), material.name, false);
  check.Above(at("youngs_modulus"), material.youngs_modulus, 0, limits::kMaxYoungsModulus);
  check.Within(at("poisson_ratio"), material.poisson_ratio, 0, limits::kMaxPoissonRatio);
  check.Above(at("density"), material.density, 0, limits::kMaxDensity);
  if (check.List(at("regions"), material.regions.size())) {
    for (size_t k = 0; k < material.regions.size(); ++k) {
      check.Name(At(at("regions"), k), material.regions[k], true);
    }
  }
  if (material.poisson_ratio > limits::kLockingPoissonRatio) {
    faults.Warning(at("poisson_ratio"),
                   absl::StrCat(material.poisson_ratio, " is above ", limits::kLockingPoissonRatio,
                                ": linear tets lock, the body will be too stiff in bending"));
  } else if (material.poisson_ratio < limits::kFloppyPoissonRatio) {
    faults.Warning(at("poisson_ratio"),
                   absl::StrCat(material.poisson_ratio, " is below ", limits::kFloppyPoissonRatio,
                                ": crushed tets resist little"));
  }
  if (material.tensile_strength.has_value()) {
    const double strength = *material.tensile_strength;
    if (!(strength >= 0)) {
      faults.Error(at("tensile_strength"), absl::StrCat(strength, " is outside [0, inf]"));
    } else if (strength > 10 * material.youngs_modulus) {
      faults.Warning(at("tensile_strength"),
                     absl::StrCat(strength, " Pa is over 10 times Young's modulus: never breaks"));
    }
  }
  if (material.plasticity.has_value())
    CheckPlasticity(at("plasticity"), material, *material.plasticity, faults, check);
  if (material.compressive_strength.has_value()) {
    const double strength = *material.compressive_strength;
    if (!(strength > 0))
      faults.Error(at("compressive_strength"), absl::StrCat(strength, " is outside (0, inf]"));
  }
  if (material.fatigue.has_value())
    CheckFatigue(at("fatigue"), material, *material.fatigue, faults, check);
  if (material.strands.has_value())
    CheckStrands(at("strands"), material, *material.strands, faults, check);
  if (!check.List(at("fibres"), material.fibres.size(), limits::kMaxFibreFamilies)) return;
  for (size_t k = 0; k < material.fibres.size(); ++k)
    CheckFibres(At(at("fibres"), k), material.fibres[k], material.youngs_modulus, faults, check);
}

void CheckMaterials(const Scene& scene, Faults& faults, Checker& check) {
  if (scene.materials.empty()) faults.Error("materials", "is empty; a body needs a material");
  if (!check.List("materials", scene.materials.size())) return;
  for (size_t i = 0; i < scene.materials.size(); ++i)
    CheckMaterial(At("materials", i), scene.materials[i], faults, check);
}

void CheckFibreArrays(const Scene& scene, const TetMesh& mesh, Faults& faults) {
  for (size_t i = 0; i < scene.materials.size(); ++i) {
    const std::vector<FibreFamily>& fibres = scene.materials[i].fibres;
    for (size_t k = 0; k < fibres.size(); ++k) {
      const auto* per_tet = std::get_if<TetDirections>(&fibres[k].direction);
      if (per_tet == nullptr) continue;
      const auto count = static_cast<int64_t>(per_tet->vectors.size());
      if (count == mesh.tet_count()) continue;
      faults.Error(
          At(At("materials", i, "fibres"), k, "per_tet.vectors"),
          absl::StrCat("has ", count, " directions; the mesh has ", mesh.tet_count(), " tets"));
    }
  }
}

}  // namespace cleave
