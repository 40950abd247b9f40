#include <string>
#include <variant>

#include "absl/strings/str_cat.h"
#include "proto/convert/field_reader.h"
#include "proto/convert/scene.h"

namespace cleave {
namespace {

ElasticLaw Law(const std::string& field, v1::ElasticLaw law, Faults& faults) {
  switch (law) {
    case v1::ELASTIC_LAW_UNSPECIFIED:
    case v1::ELASTIC_LAW_STABLE_NEO_HOOKEAN:
      return ElasticLaw::kStableNeoHookean;
    case v1::ELASTIC_LAW_INVERTIBLE_NEO_HOOKEAN:
      return ElasticLaw::kInvertibleNeoHookean;
    case v1::ELASTIC_LAW_COROTATED_LINEAR:
      return ElasticLaw::kCorotatedLinear;
    case v1::ELASTIC_LAW_ST_VENANT_KIRCHHOFF:
      return ElasticLaw::kStVenantKirchhoff;
    default:
      faults.Error(field, absl::StrCat(static_cast<int>(law), " is not an ElasticLaw"));
      return ElasticLaw::kStableNeoHookean;
  }
}

FibreDirection Direction(const std::string& field, const v1::FibreFamily& message,
                         const FieldReader& read) {
  switch (message.direction_case()) {
    case v1::FibreFamily::kConstant:
      return ConstantDirection{
          read.RequiredVector(field + ".constant.vector", message.constant().vector(), {1, 0, 0})};
    case v1::FibreFamily::kCylindrical: {
      const v1::CylindricalDirection& from = message.cylindrical();
      CylindricalDirection cylindrical;
      const std::string frame = field + ".cylindrical.";
      cylindrical.center = read.Vector(frame + "center", from.center(), cylindrical.center);
      cylindrical.axis = read.Vector(frame + "axis", from.axis(), cylindrical.axis);
      cylindrical.mixture = read.Vector(frame + "mixture", from.mixture(), cylindrical.mixture);
      return cylindrical;
    }
    case v1::FibreFamily::kPerTet:
      return TetDirections{read.Groups<3>(field + ".per_tet.vectors", message.per_tet().vectors())};
    case v1::FibreFamily::kCurves: {
      CurveDirections directions;
      for (int i = 0; i < message.curves().curves_size(); ++i) {
        directions.curves.push_back(
            {read.Groups<3>(absl::StrCat(field, ".curves.curves[", i, "].points"),
                            message.curves().curves(i).points())});
      }
      return directions;
    }
    case v1::FibreFamily::DIRECTION_NOT_SET:
      break;
  }
  return std::monostate{};
}

}  // namespace

Material MaterialFromMessage(const v1::Material& given, const std::string& field, Faults& faults) {
  const FieldReader read(faults);
  v1::Material message = given;
  ResolvePreset(field, message, faults);
  Material material;
  material.name = message.name();
  material.regions.assign(message.regions().begin(), message.regions().end());
  material.law = Law(field + ".law", message.law(), faults);
  material.youngs_modulus = message.youngs_modulus();
  material.poisson_ratio = message.poisson_ratio();
  material.density = message.density();
  if (message.has_tensile_strength()) material.tensile_strength = message.tensile_strength();
  if (message.has_compressive_strength())
    material.compressive_strength = message.compressive_strength();
  for (int i = 0; i < message.fibres_size(); ++i) {
    const v1::FibreFamily& from = message.fibres(i);
    FibreFamily& family = material.fibres.emplace_back();
    family.stiffness = from.stiffness();
    family.direction = Direction(absl::StrCat(field, ".fibres[", i, "]"), from, read);
    if (from.has_strength_ratio()) family.strength_ratio = from.strength_ratio();
  }
  if (message.has_fatigue()) {
    const v1::Fatigue& from = message.fatigue();
    Fatigue& fatigue = material.fatigue.emplace();
    fatigue.strength_coefficient = from.strength_coefficient();
    fatigue.strength_exponent = from.strength_exponent();
    if (from.has_endurance_limit()) fatigue.endurance_limit = from.endurance_limit();
    if (from.has_degradation_exponent()) fatigue.degradation_exponent = from.degradation_exponent();
  }
  if (message.has_plasticity()) {
    const v1::Plasticity& from = message.plasticity();
    Plasticity& plasticity = material.plasticity.emplace();
    plasticity.yield_stress = from.yield_stress();
    plasticity.hardening = from.hardening();
    if (from.has_flow_rate()) plasticity.flow_rate = from.flow_rate();
    if (from.has_failure_strain()) plasticity.failure_strain = from.failure_strain();
  }
  if (message.has_strands()) {
    material.strands =
        Strands{message.strands().residual_factor(), message.strands().stretch_limit()};
  }
  return material;
}

}  // namespace cleave
