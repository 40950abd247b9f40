#include "tests/stability/hostile_input.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {
namespace {

constexpr int kFrames = 5;
constexpr double kThin = 1.5e-7;  // m; cells of a third of a metre across have an aspect of 1e6

HostileInput Suspect(int number, const char* name, const char* field, const char* says,
                     std::function<void(HostileBody&)> change) {
  return {number, name, Verdict::kWarned, field, says, kFrames, [change = std::move(change)] {
            HostileBody body = SoftCube();
            change(body);
            return body;
          }};
}

// Half of the body, by tets, is another material, this much stiffer or denser.
void AddMaterial(HostileBody& body, double stiffness_ratio, double density_ratio) {
  body.mesh.tet_regions.resize(body.mesh.tets.size());
  for (size_t tet = 0; tet < body.mesh.tets.size(); ++tet) body.mesh.tet_regions[tet] = tet % 2;
  body.scene.materials.push_back(body.scene.materials[0]);
  body.scene.materials[1].regions = {"1"};
  body.scene.materials[1].youngs_modulus *= stiffness_ratio;
  body.scene.materials[1].density *= density_ratio;
  body.scene.quality.newton_iterations = 100;
}

}  // namespace

std::vector<HostileInput> WarnedInputs() {
  using Body = HostileBody;
  return {
      Suspect(18, "TetsOfNegativeOrientation", "tets", "orient",
              [](Body& b) { std::swap(b.mesh.tets[3][0], b.mesh.tets[3][1]); }),
      Suspect(19, "NodesOfNoTet", "rest_positions", "1 nodes are in no tet",
              [](Body& b) {
                b.mesh.rest_positions.push_back({7, 7, 7});
              }),
      Suspect(20, "CoincidentNodesThatAreNotWelded", "rest_positions", "16 nodes lie on another",
              [](Body& b) {
                // A second cube against the first, with nodes of its own.
                const TetMesh other = KuhnBox({3, 3, 3}, {1, 1, 1}, {1, 0, 0});
                const auto offset = static_cast<int32_t>(b.mesh.node_count());
                for (const Vec3& p : other.rest_positions) b.mesh.rest_positions.push_back(p);
                for (auto tet : other.tets) {
                  for (int32_t& node : tet) node += offset;
                  b.mesh.tets.push_back(tet);
                }
              }),
      Suspect(21, "SliversOfAspectAMillion", "tets", "sliver",
              [](Body& b) {
                // A thin layer of the cube's highest cells.
                for (Vec3& p : b.mesh.rest_positions) {
                  if (p[2] > 0.5 && p[2] < 0.9) p[2] = 1 - kThin;
                }
                b.scene.quality.newton_iterations = 100;
              }),
      Suspect(22, "PoissonRatioThatLocks", "materials[0].poisson_ratio", "lock",
              [](Body& b) { b.scene.materials[0].poisson_ratio = 0.4999; }),
      Suspect(23, "StiffnessAMillionTimesApart", "materials", "Young's moduli differ",
              [](Body& b) { AddMaterial(b, 1e6, 1); }),
      Suspect(23, "DensityAMillionTimesApart", "materials", "densities differ",
              [](Body& b) {
                b.scene.materials[0].density = 1;
                AddMaterial(b, 1, 1e6);
              }),
      Suspect(24, "FibresAMillionTimesStiffer", "materials[0].fibres[0].stiffness", "over",
              [](Body& b) {
                FibreFamily family;
                family.stiffness = 1e11;
                family.direction = ConstantDirection{{0.6, 0, 0.8}};
                b.scene.materials[0].fibres.push_back(family);
                b.scene.quality.newton_iterations = 100;
              }),
      Suspect(25, "StrengthOverTenModuli", "materials[0].tensile_strength", "never breaks",
              [](Body& b) { b.scene.materials[0].tensile_strength = 2e6; }),
      Suspect(26, "StepsOfTwoTenthsOfASecond", "timing.steps_per_frame", "strongly damped",
              [](Body& b) { b.scene.timing.frames_per_second = 5; }),
      Suspect(27, "YieldNotBelowStrength", "materials[0].plasticity.yield_stress",
              "is not below the tensile strength",
              [](Body& b) {
                b.scene.materials[0].tensile_strength = 1e4;
                b.scene.materials[0].plasticity = Plasticity{.yield_stress = 2e4};
              }),
      Suspect(27, "FlowWithoutHardeningOrEnd", "materials[0].plasticity.hardening",
              "without a failure_strain",
              [](Body& b) {
                b.scene.materials[0].tensile_strength = 1e5;
                b.scene.materials[0].plasticity = Plasticity{.yield_stress = 2e4};
              }),
      Suspect(28, "FibreDirectionNotUnit", "materials[0].fibres[0].constant.vector", "has length",
              [](Body& b) {
                FibreFamily family;
                family.stiffness = 1e5;
                family.direction = ConstantDirection{{1, 2, 3}};
                b.scene.materials[0].fibres.push_back(family);
              }),
  };
}

}  // namespace cleave
