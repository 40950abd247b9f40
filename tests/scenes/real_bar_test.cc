// The ductile bar on a mesh that others made; built where CLEAVE_MESHES_DIR holds it.

#include <gtest/gtest.h>

#include <string>

#include "client/io/mesh/mesh_file.h"
#include "tests/scenes/ductile_bar.h"
#include "tests/scenes/scene_testing.h"

namespace cleave {
namespace {

Metrics MeasureOn(const TetMesh& mesh, const std::string& variant) {
  auto bar = MakeDuctileBarOf(mesh, variant);
  EXPECT_TRUE(bar.ok()) << bar.status();
  if (!bar.ok()) return {};
  auto outcome = Measured(*std::move(bar), MeasureDuctileBar);
  EXPECT_TRUE(outcome.ok()) << variant << ": " << outcome.status();
  if (!outcome.ok()) return {};
  Report("ductile_bar " + variant + " of bar-14114.msh", {}, outcome->metrics);
  return outcome->metrics;
}

TEST(FullRealBar, CopperMakesGoldStretchFarther) {
  const absl::StatusOr<TetMesh> mesh = ReadMeshFile(CLEAVE_MESHES_DIR "/tet/bar-14114.msh");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  const Metrics gold = MeasureOn(*mesh, "gold");
  const Metrics alloy = MeasureOn(*mesh, "alloy");
  const Metrics off = MeasureOn(*mesh, "off");
  ASSERT_FALSE(gold.empty() || alloy.empty() || off.empty());
  for (const std::string metric : {"elongation_at_fracture", "elongation_at_separation"}) {
    ASSERT_GT(gold.at(metric), 0);
    EXPECT_GE(alloy.at(metric), 1.15 * gold.at(metric));
    EXPECT_NEAR(off.at(metric), gold.at(metric), 0.02 * gold.at(metric));
  }
  EXPECT_GT(alloy.at("strain_of_neck"), gold.at("strain_of_neck"));
  EXPECT_GT(alloy.at("strain_of_bar"), gold.at("strain_of_bar"));
}

}  // namespace
}  // namespace cleave
