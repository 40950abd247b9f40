// The ductile bar on a mesh that others made; built where CLEAVE_MESHES_DIR holds it.

#include <gtest/gtest.h>

#include <string>
#include <vector>

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
  Trial trial;
  for (const std::string variant : {"gold", "alloy", "off"})
    trial.variants[variant] = MeasureOn(*mesh, variant);
  const std::vector<Trial> trials = {trial};
  for (const Criterion& criterion : DuctileBarCriteria()) ExpectHolds(criterion, trials);
}

}  // namespace
}  // namespace cleave
