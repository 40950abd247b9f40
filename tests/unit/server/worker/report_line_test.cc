#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/worker/recorded_simulation.h"

namespace cleave {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;

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

TEST(ReportLine, NamesEveryPartAndHowItIsSet) {
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

}  // namespace
}  // namespace cleave
