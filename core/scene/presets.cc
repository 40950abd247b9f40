#include "core/scene/presets.h"

#include <utility>

namespace cleave {
namespace {

struct Isotropic {
  double youngs_modulus;  // Pa
  double poisson_ratio;
  double density;           // kg/m^3
  double tensile_strength;  // Pa
};

MaterialPreset Preset(absl::string_view name, absl::string_view description,
                      const Isotropic& numbers, std::vector<std::string> sources) {
  MaterialPreset preset;
  preset.material.name = std::string(name);
  preset.material.youngs_modulus = numbers.youngs_modulus;
  preset.material.poisson_ratio = numbers.poisson_ratio;
  preset.material.density = numbers.density;
  preset.material.tensile_strength = numbers.tensile_strength;
  preset.description = std::string(description);
  preset.sources = std::move(sources);
  return preset;
}

FibreFamily AlongX(double stiffness, double strength_ratio) {
  FibreFamily family;
  family.stiffness = stiffness;
  family.direction = ConstantDirection{{1, 0, 0}};
  family.strength_ratio = strength_ratio;
  return family;
}

MaterialPreset Bread() {
  return Preset(
      "bread", "fresh white crumb", {15e3, 0.2, 250, 4e3},
      {"strength: 0.2-0.7 N over necks 10 mm wide, in \"Some tensile characteristics of "
       "bread crumb\", Journal of Texture Studies 25 (1994) 299; 4 kPa for slices that we "
       "take as 12 mm thick",
       "modulus: derived, so that crumb tears at a strain of about 0.3, within the break "
       "elongations of the same paper",
       "Poisson's ratio: of open-cell foams, Gibson and Ashby, Cellular Solids; density: "
       "usual for pan bread, 150-300 kg/m^3"});
}

MaterialPreset RawMeat() {
  MaterialPreset preset = Preset(
      "raw_meat", "passive skeletal muscle, fibres along x", {25e3, 0.45, 1060, 9e3},
      {"strengths: 25 kPa across and 300 kPa along the fibres of cooked beef, \"The physical basis "
       "of meat texture: observations on the fracture behaviour of cooked bovine M. "
       "semitendinosus\", Meat Science 12 (1985); adapted: raw meat is softer, and "
       "a matrix strength of 9 kPa gives about 10 kPa across and 220 kPa along",
       "moduli: of the order of 25 kPa across and 450 kPa along, rabbit muscle, Morrow et al., "
       "Transversely isotropic tensile material properties of skeletal muscle tissue, Journal of "
       "the "
       "Mechanical Behavior of Biomedical Materials 3 (2010) 124; the fibres carry the difference",
       "Poisson's ratio: adapted; muscle is nearly incompressible, linear tets lock above 0.45. "
       "Density: textbook value of muscle"});
  preset.material.fibres = {AlongX(425e3, 1)};
  return preset;
}

MaterialPreset DryWood() {
  MaterialPreset preset = Preset(
      "dry_wood", "Sitka spruce at 12 % moisture, grain along x", {0.72e9, 0.35, 450, 2.6e6},
      {"Wood Handbook (FPL-GTR-190), chapter 5: bending modulus 10.8 GPa, 10 % more along the "
       "grain; "
       "E_R/E_L = 0.078 and E_T/E_L = 0.043, of which the matrix has the mean; tension "
       "perpendicular "
       "to grain 2.55 MPa; specific gravity 0.40 (density with 12 % water)",
       "fibre stiffness: derived, what is missing to the modulus along the grain",
       "strength ratio: adapted, so that a bar along the grain breaks at about the modulus of "
       "rupture, 70 MPa",
       "Poisson's ratio: of the radial and tangential values, rounded, for a matrix that has one"});
  preset.material.fibres = {AlongX(11.2e9, 1.7)};
  return preset;
}

MaterialPreset DampWood() {
  MaterialPreset preset = Preset(
      "damp_wood", "Sitka spruce, green, grain along x", {0.38e9, 0.35, 520, 1.7e6},
      {"Wood Handbook (FPL-GTR-190), chapter 5, green wood: bending modulus 8.5 GPa, 10 % more "
       "along "
       "the grain; tension perpendicular to grain 1.7 MPa; modulus of rupture 39 MPa; specific "
       "gravity 0.37 (density with 40 % water)",
       "matrix modulus: adapted; across the grain stiffness falls by about a half from 12 % "
       "moisture "
       "to fibre saturation",
       "fibre stiffness: derived, what is missing to the modulus along the grain, 9.3 GPa"});
  preset.material.fibres = {AlongX(8.9e9, 1)};
  return preset;
}

MaterialPreset Porcelain() {
  return Preset(
      "porcelain", "hard siliceous porcelain", {70e9, 0.17, 2400, 35e6},
      {"IEC 60672-3, class C 110: at least 60 GPa, 50 MPa flexural strength, 2200 kg/m^3; "
       "modulus and density: typical values of the class, above its minima",
       "Poisson's ratio: MakeItFrom.com, IEC 60672 Type C-430",
       "strength: derived; ceramics in tension have about 0.6-0.7 of their flexural "
       "strength"});
}

MaterialPreset Gold() {
  MaterialPreset preset = Preset(
      "gold", "pure gold, annealed", {78e9, 0.44, 19300, 189e6},
      {"modulus, Poisson's ratio, density: WebElements, gold: 78 GPa, 0.44, 19 300 kg/m^3",
       "strength and elongation: 130 MPa and 45 %, wrought and annealed, Metals Handbook, "
       "9th edition, volume 2; derived: true stress at break, so that a bar breaks there",
       "yield: order of magnitude, 30 MPa; sources scatter, and worked gold yields at 200 MPa; "
       "hardening: derived, linear from yield to the true stress at break"});
  preset.material.plasticity = Plasticity{.yield_stress = 30e6, .hardening = 428e6};
  return preset;
}

MaterialPreset GoldCopper() {
  MaterialPreset preset = Preset(
      "gold_copper", "18 carat red gold: 75 % gold, 25 % copper by weight, annealed",
      {100e9, 0.40, 15200, 770e6},
      {"strength and elongation: 550 MPa and 40 % when quenched after annealing, of the order that "
       "Rapson reviews, The metallurgy of the coloured carat gold alloys, Gold Bulletin 23 (1990); "
       "derived: true stress at break, so that a bar breaks there",
       "yield: order of magnitude, 300 MPa; hardening: derived, linear from yield to the true "
       "stress at break",
       "modulus: derived, mean of gold and copper, half of the atoms each; MakeItFrom.com has "
       "110 GPa and Poisson's ratio 0.40 for ASTM B541, 71.5 % gold and 14.5 % copper hardened by "
       "8.5 % platinum, which also yields at more, 480 MPa",
       "density: derived from those of gold and copper by weight"});
  preset.material.plasticity = Plasticity{.yield_stress = 300e6, .hardening = 1.4e9};
  return preset;
}

MaterialPreset Cheese() {
  return Preset(
      "cheese", "mild Cheddar", {113e3, 0.45, 1080, 40e3},
      {"modulus 113 kPa, stress at fracture 46 +- 9 kPa, strain at fracture 0.50: "
       "commercial mild Cheddar in compression, Journal of Nutrition and Food Sciences 2 "
       "(2012) 136, table 4",
       "strength: adapted within its spread, so that a pulled bar breaks at that strain",
       "Poisson's ratio: adapted; cheese is nearly incompressible, linear tets lock above "
       "0.45. Density: usual value"});
}

MaterialPreset Rubber() {
  return Preset(
      "rubber", "vulcanised natural rubber, unfilled", {1.5e6, 0.45, 950, 3e6},
      {"shear modulus 0.5 MPa (so Young's modulus 1.5 MPa), density 950 kg/m^3, elongation "
       "at break 100-800 %: MatWeb, natural rubber, vulcanized",
       "strength: adapted; the law does not stiffen as rubber does before it breaks (to "
       "28 MPa), so the threshold is its stress at a strain of about 5",
       "Poisson's ratio: adapted; rubber is nearly incompressible, linear tets lock above "
       "0.45"});
}

MaterialPreset Glass() {
  return Preset(
      "glass", "soda-lime float glass, annealed", {70e9, 0.23, 2500, 45e6},
      {"EN 572-1: 70 GPa, 2500 kg/m^3, characteristic bending strength 45 MPa",
       "Poisson's ratio: Pilkington ATS-129, which has a mean modulus of rupture of 41 MPa "
       "for glass in service"});
}

MaterialPreset Concrete() {
  return Preset("concrete", "normal concrete C30/37", {33e9, 0.2, 2400, 2.9e6},
                {"EN 1992-1-1 (Eurocode 2), table 3.1: E_cm 33 GPa, f_ctm 2.9 MPa; clause 3.1.3: "
                 "Poisson's ratio 0.2 uncracked",
                 "density: EN 1991-1-1, normal-weight concrete, 24 kN/m^3"});
}

}  // namespace

std::vector<MaterialPreset> MaterialPresets() {
  return {Bread(),     Cheese(), RawMeat(),  DryWood(), DampWood(),  Rubber(),
          Porcelain(), Glass(),  Concrete(), Gold(),    GoldCopper()};
}

std::optional<MaterialPreset> FindMaterialPreset(absl::string_view name) {
  for (MaterialPreset& preset : MaterialPresets()) {
    if (preset.material.name == name) return std::move(preset);
  }
  return std::nullopt;
}

}  // namespace cleave
