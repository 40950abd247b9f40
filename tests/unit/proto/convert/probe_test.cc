#include "proto/convert/probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace cleave {
namespace {

using ::testing::ElementsAre;

TEST(Probe, KeepsEveryFieldOfARequest) {
  v1::ProbeMaterialRequest request;
  request.mutable_material()->set_preset("dry_wood");
  request.set_stress(v1::FRACTURE_STRESS_TOTAL);
  for (const double x : {1, 2, 3}) request.add_point(x);
  for (const double x : {0, 1, 0}) request.add_fibre_directions(x);
  for (int k = 0; k < 18; ++k) request.add_deformation_gradients(k);
  for (const double x : {0, 0, 1, 1, 0, 1}) request.add_pull_directions(x);
  request.set_largest_strain(0.5);
  request.set_samples(7);
  Faults faults;
  const MaterialProbe probe = ProbeFromMessage(request, faults);
  EXPECT_TRUE(faults.ok()) << faults.ToStatus();
  EXPECT_EQ(probe.material.name, "dry_wood");
  EXPECT_EQ(probe.stress, FractureStress::kTotal);
  EXPECT_EQ(probe.point, (Vec3{1, 2, 3}));
  EXPECT_THAT(probe.fibre_directions, ElementsAre(Vec3{0, 1, 0}));
  ASSERT_EQ(probe.deformation_gradients.size(), 2u);
  EXPECT_EQ(probe.deformation_gradients[1][8], 17);
  EXPECT_THAT(probe.pull_directions, ElementsAre(Vec3{0, 0, 1}, Vec3{1, 0, 1}));
  EXPECT_EQ(probe.largest_strain, 0.5);
  EXPECT_EQ(probe.samples, 7);
}

TEST(Probe, IsAnsweredInColumns) {
  v1::ProbeMaterialRequest request;
  request.mutable_material()->set_preset("glass");
  for (const double x : {1, 0, 0, 0, 1, 0, 0, 0, 1}) request.add_deformation_gradients(x);
  for (const double x : {0, 2, 0}) request.add_pull_directions(x);
  request.set_samples(4);
  Faults faults;
  const v1::ProbeMaterialResponse response = *AnswerProbe(request, {}, faults);
  ASSERT_TRUE(faults.ok()) << faults.ToStatus();
  EXPECT_EQ(response.material().name(), "glass");
  EXPECT_TRUE(response.material().preset().empty());
  ASSERT_EQ(response.points_size(), 1);
  EXPECT_EQ(response.points(0).stress_size(), 9);
  EXPECT_EQ(response.points(0).tangent_size(), 81);
  ASSERT_EQ(response.curves_size(), 1);
  const v1::StressStrainCurve& curve = response.curves(0);
  EXPECT_THAT(curve.direction(), ElementsAre(0, 1, 0));
  EXPECT_EQ(curve.end(), v1::CURVE_END_TENSILE_STRENGTH);
  for (const int size : {curve.strain_size(), curve.nominal_stress_size(), curve.true_stress_size(),
                         curve.volume_ratio_size(), curve.energy_size(), curve.failure_ratio_size(),
                         curve.plastic_strain_size()}) {
    EXPECT_EQ(size, 5);
  }
  EXPECT_NEAR(curve.nominal_stress(4), 45e6, 1);
}

TEST(Probe, NamesWhatOnlyAMessageCanSayWrongly) {
  v1::ProbeMaterialRequest request;
  request.mutable_material()->set_preset("glass");
  request.set_stress(static_cast<v1::FractureStress>(9));
  request.add_point(1);
  request.add_fibre_directions(1);
  request.add_deformation_gradients(1);
  request.add_pull_directions(1);
  Faults faults;
  const v1::ProbeMaterialResponse response = *AnswerProbe(request, {}, faults);
  EXPECT_EQ(response.ByteSizeLong(), 0u);
  std::vector<std::string> fields;
  for (const Fault& fault : faults.errors()) fields.push_back(fault.field);
  EXPECT_THAT(fields, ElementsAre("stress", "point", "fibre_directions", "deformation_gradients",
                                  "pull_directions"));
}

TEST(Presets, AreListedWithTheirNumbers) {
  const v1::ListMaterialPresetsResponse presets = PresetsMessage();
  ASSERT_GE(presets.presets_size(), 11);
  EXPECT_EQ(presets.presets(0).name(), presets.presets(0).material().name());
  EXPECT_GT(presets.presets(0).material().youngs_modulus(), 0);
  EXPECT_GT(presets.presets(0).sources_size(), 0);
}

}  // namespace
}  // namespace cleave
