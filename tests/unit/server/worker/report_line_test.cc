#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "server/worker/recorded_simulation.h"

namespace cleave {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ReportLine, OfABareBodyNamesQualityStepAndLawAlone) {
  Scene scene;
  scene.materials.resize(1);
  scene.timing = Timing{.frames_per_second = 25, .frame_count = 1, .steps_per_frame = 2};
  const std::string in_force = InForce(scene);
  EXPECT_EQ(in_force,
            "{\"precision\":\"double\",\"residual_tolerance\":0.0001,\"step_tolerance\":0.0001,"
            "\"linear_tolerance\":0.001,\"newton_iterations\":8,\"max_step_halvings\":6,"
            "\"time_step\":0.02,\"parts\":[],\"laws\":[\"stable_neo_hookean\"]}");
  FrameReport report;
  report.damping_dissipation = 0.25;
  const std::string line = ReportLine(report, in_force);
  EXPECT_THAT(line, HasSubstr(",\"damping_dissipation\":0.25,"));
  EXPECT_THAT(line, EndsWith(",\"in_force\":" + in_force + "}"));
}

TEST(ReportLine, TellsHowPartsAreSet) {
  Scene scene;
  scene.materials.resize(3);
  scene.materials[0].law = scene.materials[2].law = ElasticLaw::kCorotatedLinear;
  scene.materials[0].tensile_strength = 1e5;
  scene.materials[0].fatigue = Fatigue{2e5, -0.1, {}, 1};
  scene.materials[1].plasticity = Plasticity{.yield_stress = 1e4};
  scene.materials[2].compressive_strength = 1e6;
  scene.gravity = Vec3{0, 0, -9.81};
  scene.damping = Damping{0.5, 0.001};
  scene.contact.emplace();
  scene.sleep.emplace();
  scene.fracture = Fracture{.max_passes = 7,
                            .simultaneity = 0.75,
                            .stress = FractureStress::kTotal,
                            .aggregation = StressAggregation::kMax};
  scene.impurities = Impurities{.effect = ImpurityEffect::kUpgradation,
                                .model = ImpurityModel::kStatic,
                                .mode = ImpurityMode::kSampled};
  scene.seed = 11;
  scene.quality.precision = Precision::kFloat;
  const std::string in_force = InForce(scene);
  EXPECT_THAT(in_force, HasSubstr("{\"precision\":\"float\","));
  EXPECT_THAT(
      in_force,
      EndsWith("\"parts\":[\"gravity\",\"contact\",\"sleep\",\"plasticity\",\"tensile_strength\","
               "\"compressive_strength\",\"fatigue\"],"
               "\"laws\":[\"corotated_linear\",\"stable_neo_hookean\"],"
               "\"damping\":{\"mass_coefficient\":0.5,\"stiffness_coefficient\":0.001},"
               "\"fracture\":{\"stress\":\"total\",\"aggregation\":\"max\",\"reformulation\":"
               "\"uniform\",\"simultaneity\":0.75,\"max_passes\":7},"
               "\"impurities\":{\"effect\":\"upgradation\",\"model\":\"static\",\"mode\":"
               "\"sampled\",\"seed\":11}}"));
}

TEST(ReportLine, CarriesEveryNumberOfTheFrame) {
  FrameReport report;
  report.frame = 3;
  report.time = 0.125;
  report.steps = 4;
  report.step_halvings = 2;
  report.shortest_step = 0.03125;
  report.newton_iterations = 9;
  report.linear_iterations = 240;
  report.break_passes = 5;
  report.residual = 0.0078125;
  report.kinetic_energy = 1.5;
  report.elastic_energy = 2.5;
  report.external_work = 3.5;
  report.fracture_energy = 4.5;
  report.plastic_work = 5.5;
  report.contact_energy = 6.5;
  report.friction_dissipation = 7.5;
  report.damping_dissipation = 8.5;
  report.integration_dissipation = 9.5;
  report.broken_edges = 70;
  report.new_broken_edges = 7;
  report.fragments = 6;
  report.sleeping_pieces = 1;
  report.motion_forces = {{1, -2, 0.5}, {0, 4, std::numeric_limits<double>::infinity()}};
  report.colliders = {{{0.5, -0.5, 0.5, -0.5}, {1, 2, 3}}};
  report.assembly_seconds = 0.25;
  report.linear_solve_seconds = 0.5;
  report.fracture_seconds = 0.75;
  report.total_seconds = 1.75;
  EXPECT_EQ(ReportLine(report, "{}"),
            "{\"frame\":3,\"time\":0.125,\"steps\":4,\"step_halvings\":2,\"newton_iterations\":9,"
            "\"linear_iterations\":240,\"break_passes\":5,\"residual\":0.0078125,"
            "\"kinetic_energy\":1.5,\"elastic_energy\":2.5,\"external_work\":3.5,"
            "\"fracture_energy\":4.5,\"plastic_work\":5.5,\"contact_energy\":6.5,"
            "\"friction_dissipation\":7.5,\"damping_dissipation\":8.5,"
            "\"integration_dissipation\":9.5,\"broken_edges\":70,\"new_broken_edges\":7,"
            "\"fragments\":6,\"sleeping_pieces\":1,\"motion_forces\":[[1,-2,0.5],[0,4,null]],"
            "\"colliders\":[{\"rotation\":[0.5,-0.5,0.5,-0.5],\"translation\":[1,2,3]}],"
            "\"assembly_seconds\":0.25,\"linear_solve_seconds\":0.5,\"fracture_seconds\":0.75,"
            "\"total_seconds\":1.75,\"shortest_step\":0.03125,\"in_force\":{}}");
}

TEST(ReportLine, NamesEveryPartThatASceneCanHave) {
  Scene scene;
  Material material;
  material.law = ElasticLaw::kInvertibleNeoHookean;
  material.fibres.push_back({1e6, ConstantDirection{{1, 0, 0}}, 1});
  material.tensile_strength = 1e5;
  material.strands = Strands{0.1, 2};
  scene.materials = {material, Material{}};
  scene.materials[1].law = ElasticLaw::kStVenantKirchhoff;
  scene.motions.emplace_back();
  scene.loads.push_back({"any", PointForce{{1, 0, 0}}, {}, {}});
  scene.initial_velocities.emplace_back();
  scene.colliders.emplace_back().shape = PlaneShape{};
  scene.weakenings.push_back({SphereSelector{{0, 0, 0}, 1}, 0.5});
  scene.fracture.reformulation = Reformulation::kEdgeProjected;
  const std::string in_force = InForce(scene);
  EXPECT_THAT(
      in_force,
      HasSubstr("\"parts\":[\"motions\",\"loads\",\"initial_velocities\",\"colliders\",\"fibres\","
                "\"tensile_strength\",\"strands\",\"weakenings\"],"
                "\"laws\":[\"invertible_neo_hookean\",\"st_venant_kirchhoff\"],"));
  EXPECT_THAT(in_force, HasSubstr("\"reformulation\":\"edge_projected\""));
  EXPECT_THAT(in_force, Not(HasSubstr("impurities")));
}

}  // namespace
}  // namespace cleave
