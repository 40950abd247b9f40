#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "tests/stability/hostile_input.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// The soft cube with one thing of its scene or mesh spoiled.
HostileInput Spoiled(int number, const char* name, const char* field, const char* says,
                     std::function<void(HostileBody&)> spoil) {
  return {number, name, Verdict::kRefused, field, says, 0, [spoil = std::move(spoil)] {
            HostileBody body = SoftCube();
            spoil(body);
            return body;
          }};
}

Impurities& AddImpurities(HostileBody& body) {
  body.scene.materials[0].tensile_strength = 1e4;
  return body.scene.impurities.emplace();
}

FibreFamily& AddFibres(HostileBody& body) {
  FibreFamily family;
  family.stiffness = 1e5;
  family.direction = ConstantDirection{{1, 0, 0}};
  body.scene.materials[0].fibres.push_back(family);
  return body.scene.materials[0].fibres.back();
}

}  // namespace

std::vector<HostileInput> RefusedInputs() {
  using Body = HostileBody;
  return {
      Spoiled(1, "NoStiffness", "materials[0].youngs_modulus", "0 is outside",
              [](Body& b) { b.scene.materials[0].youngs_modulus = 0; }),
      Spoiled(1, "NegativeStiffness", "materials[0].youngs_modulus", "-1 is outside",
              [](Body& b) { b.scene.materials[0].youngs_modulus = -1; }),
      Spoiled(2, "NegativePoissonRatio", "materials[0].poisson_ratio", "-0.1 is outside",
              [](Body& b) { b.scene.materials[0].poisson_ratio = -0.1; }),
      Spoiled(2, "PoissonRatioOfAFluid", "materials[0].poisson_ratio", "0.49999 is outside",
              [](Body& b) { b.scene.materials[0].poisson_ratio = 0.49999; }),
      Spoiled(3, "NegativeDensity", "materials[0].density", "-1 is outside",
              [](Body& b) { b.scene.materials[0].density = -1; }),
      Spoiled(3, "NoDensity", "materials[0].density", "0 is outside",
              [](Body& b) { b.scene.materials[0].density = 0; }),
      Spoiled(4, "NoTimeStep", "timing.frames_per_second", "inf is outside",
              [](Body& b) { b.scene.timing.frames_per_second = kInf; }),
      Spoiled(4, "NegativeTimeStep", "timing.frames_per_second", "-24 is outside",
              [](Body& b) { b.scene.timing.frames_per_second = -24; }),
      Spoiled(4, "TimeStepAboveTenSeconds", "timing.steps_per_frame", "makes steps of 100 s",
              [](Body& b) { b.scene.timing.frames_per_second = 0.01; }),
      Spoiled(5, "CoordinateNotANumber", "rest_positions[5]", "nan",
              [](Body& b) { b.mesh.rest_positions[5][1] = kNan; }),
      Spoiled(5, "InfiniteCoordinate", "rest_positions[5]", "inf",
              [](Body& b) { b.mesh.rest_positions[5][1] = kInf; }),
      Spoiled(5, "StiffnessNotANumber", "materials[0].youngs_modulus", "nan is outside",
              [](Body& b) { b.scene.materials[0].youngs_modulus = kNan; }),
      Spoiled(5, "InfiniteStiffness", "materials[0].youngs_modulus", "inf is outside",
              [](Body& b) { b.scene.materials[0].youngs_modulus = kInf; }),
      Spoiled(5, "PoissonRatioNotANumber", "materials[0].poisson_ratio", "nan is outside",
              [](Body& b) { b.scene.materials[0].poisson_ratio = kNan; }),
      Spoiled(5, "InfiniteDensity", "materials[0].density", "inf is outside",
              [](Body& b) { b.scene.materials[0].density = kInf; }),
      Spoiled(5, "StrengthNotANumber", "materials[0].tensile_strength", "nan is outside",
              [](Body& b) { b.scene.materials[0].tensile_strength = kNan; }),
      Spoiled(5, "FlowRateNotANumber", "materials[0].plasticity.flow_rate", "nan is outside",
              [](Body& b) {
                b.scene.materials[0].plasticity =
                    Plasticity{.yield_stress = 5e3, .hardening = 1e3, .flow_rate = kNan};
              }),
      Spoiled(5, "FibreStiffnessNotANumber", "materials[0].fibres[0].stiffness", "nan is outside",
              [](Body& b) { AddFibres(b).stiffness = kNan; }),
      Spoiled(5, "InfiniteNoise", "impurities.noise", "inf is outside",
              [](Body& b) { AddImpurities(b).noise = kInf; }),
      Spoiled(5, "PotencyNotANumber", "impurities.map[7]", "nan is outside",
              [](Body& b) {
                AddImpurities(b).map.assign(64, 0.5);
                b.scene.impurities->map[7] = kNan;
              }),
      Spoiled(5, "WeakeningNotANumber", "weakenings[0].factor", "nan is outside",
              [](Body& b) {
                b.scene.weakenings.push_back({SphereSelector{{0, 0, 0}, 1}, kNan});
              }),
      Spoiled(5, "GravityNotFinite", "gravity[1]", "inf is outside",
              [](Body& b) {
                b.scene.gravity = Vec3{0, kInf, 0};
              }),
      Spoiled(5, "FailureStrainNotANumber", "materials[0].plasticity.failure_strain", "nan",
              [](Body& b) {
                b.scene.materials[0].tensile_strength = 1e4;
                b.scene.materials[0].plasticity =
                    Plasticity{.yield_stress = 5e3, .hardening = 1e3, .failure_strain = kNan};
              }),
      Spoiled(6, "NegativeStrength", "materials[0].tensile_strength", "-1 is outside",
              [](Body& b) { b.scene.materials[0].tensile_strength = -1; }),
      Spoiled(7, "FibresWithoutDirection", "materials[0].fibres[0].constant.vector",
              "has no direction",
              [](Body& b) {
                AddFibres(b).direction = ConstantDirection{{0, 0, 0}};
              }),
      Spoiled(7, "FibresOfATetWithoutDirection", "materials[0].fibres[0].per_tet.vectors[9]",
              "has no direction",
              [](Body& b) {
                TetDirections directions{std::vector<Vec3>(162, {1, 0, 0})};
                directions.vectors[9] = {0, 0, 0};
                AddFibres(b).direction = std::move(directions);
              }),
      Spoiled(8, "NegativeFibreStiffness", "materials[0].fibres[0].stiffness", "-1 is outside",
              [](Body& b) { AddFibres(b).stiffness = -1; }),
      Spoiled(9, "NodeIdOutOfRange", "tets[3]", "node 64 is outside",
              [](Body& b) { b.mesh.tets[3][2] = 64; }),
      Spoiled(9, "NegativeNodeId", "tets[3]", "node -1 is outside",
              [](Body& b) { b.mesh.tets[3][2] = -1; }),
      Spoiled(9, "NodeTwiceInATet", "tets[3]", "twice",
              [](Body& b) { b.mesh.tets[3][2] = b.mesh.tets[3][1]; }),
      Spoiled(10, "FlatTet", "tets[0]", "is flat",
              [](Body& b) {
                b.mesh = TetMesh{};
                b.mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 1e-15}};
                b.mesh.tets = {{0, 1, 2, 3}};
              }),
      Spoiled(11, "FaceOfThreeTets", "tets[2]", "is shared by 3 tets",
              [](Body& b) {
                b.mesh = TetMesh{};
                b.mesh.rest_positions = {{0, 0, 0}, {1, 0, 0},   {0, 1, 0},
                                         {0, 0, 1}, {1, 1, 1.0}, {2, 2, 2.5}};
                b.mesh.tets = {{0, 1, 2, 3}, {1, 2, 3, 4}, {1, 2, 3, 5}};
              }),
      Spoiled(
          12, "TwoTetsOnOneSideOfAFace", "tets[1]", "same side of face",
          [](Body& b) {
            b.mesh = TetMesh{};
            b.mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.1, 0.1, 0.2}};
            b.mesh.tets = {{0, 1, 2, 3}, {1, 3, 2, 4}};
          }),
      Spoiled(13, "NoTets", "tets", "at least one is needed", [](Body& b) { b.mesh.tets.clear(); }),
      Spoiled(14, "MapOfAnotherMesh", "impurities.map", "has 63 shares; the mesh has 64 nodes",
              [](Body& b) { AddImpurities(b).map.assign(63, 0.5); }),
      Spoiled(14, "FibresOfAnotherMesh", "materials[0].fibres[0].per_tet.vectors",
              "has 1 directions; the mesh has 162 tets",
              [](Body& b) {
                AddFibres(b).direction = TetDirections{{{1, 0, 0}}};
              }),
      Spoiled(15, "NoiseOutOfRange", "impurities.noise", "11 is outside",
              [](Body& b) { AddImpurities(b).noise = 11; }),
      Spoiled(15, "PotencyOutOfRange", "impurities.potency", "101 is outside",
              [](Body& b) { AddImpurities(b).potency = 101; }),
      Spoiled(15, "SteepnessOutOfRange", "impurities.steepness", "0 is outside",
              [](Body& b) { AddImpurities(b).steepness = 0; }),
      Spoiled(15, "PureOffsetOutOfRange", "impurities.pure_offset", "0 is outside",
              [](Body& b) { AddImpurities(b).pure_offset = 0; }),
      Spoiled(15, "NegativeNoise", "impurities.noise", "-1 is outside",
              [](Body& b) { AddImpurities(b).noise = -1; }),
      Spoiled(15, "WeakeningOutOfRange", "weakenings[0].factor", "-1 is outside",
              [](Body& b) {
                b.scene.weakenings.push_back({SphereSelector{{0, 0, 0}, 1}, -1});
              }),
      Spoiled(16, "DuplicateTets", "tets[162]", "as tets[4]",
              [](Body& b) { b.mesh.tets.push_back(b.mesh.tets[4]); }),
  };
}

}  // namespace cleave
