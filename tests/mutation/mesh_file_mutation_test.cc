#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/io/mesh/mesh_file.h"
#include "client/io/mesh/tetgen.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/quality.h"
#include "tests/mutation/mutate.h"
#include "tests/unit/client/io/mesh/sample_files.h"

namespace cleave {
namespace {

// What any bytes must come to: a refusal of the caller's input, or a mesh no larger than the bytes
// could hold that the check then takes apart without harm. Returns whether there was a mesh.
bool IsRefusedOrBounded(absl::StatusOr<TetMesh> mesh, size_t bytes) {
  if (!mesh.ok()) {
    EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << mesh.status();
    EXPECT_FALSE(mesh.status().message().empty());
    EXPECT_LT(mesh.status().message().size(), 1000u);
    return false;
  }
  EXPECT_LE(static_cast<size_t>(mesh->node_count() + mesh->tet_count()), 40 * bytes);
  EXPECT_GT(mesh->tet_count(), 0);
  const bool sound = CheckAndOrientMesh(*mesh).ok();
  EXPECT_TRUE(!sound || ReportMesh(*mesh, BuildIncidence(*mesh)).volume > 0);
  return true;
}

TEST(MeshFileMutation, DamagedFilesOfEveryFormatAreRefusedOrBounded) {
  constexpr int kRoundsPerSample = 600;
  int inputs = 0;
  int meshes = 0;
  uint64_t seed = 0;
  for (const auto& [name, bytes] : samples::All()) {
    SCOPED_TRACE(name);
    for (int round = 0; round < kRoundsPerSample; ++round) {
      SCOPED_TRACE(++seed);
      Dice dice(seed);
      const std::string damaged = MutateBytes(bytes, dice);
      ++inputs;
      meshes += IsRefusedOrBounded(ParseMeshFile(damaged, name), damaged.size()) ? 1 : 0;
    }
  }
  for (int round = 0; round < kRoundsPerSample; ++round) {
    SCOPED_TRACE(++seed);
    Dice dice(seed);
    const std::string node = MutateBytes(samples::kTetGenNode, dice);
    const std::string ele = MutateBytes(samples::kTetGenEle, dice);
    ++inputs;
    meshes += IsRefusedOrBounded(ParseTetGen(node, ele), node.size() + ele.size()) ? 1 : 0;
  }
  EXPECT_GT(inputs, 10'000);
  // Damage that always or never shows would test only one side.
  EXPECT_GT(meshes, inputs / 100);
  EXPECT_LT(meshes, inputs);
}

// Every reader meets the files of every other under its own name.
TEST(MeshFileMutation, FilesUnderWrongNamesAreRefusedOrRead) {
  for (const auto& [name, bytes] : samples::All()) {
    SCOPED_TRACE(name);
    for (const char* wrong : {"a.msh", "a.vtk", "a.vtu", "a.mesh", "a.meshb", "a.veg", "a.node"}) {
      EXPECT_TRUE(ParseMeshFile(bytes, wrong).ok());  // the content tells
      // Without its start, the reader of the name takes it.
      IsRefusedOrBounded(ParseMeshFile(bytes.substr(9), wrong), bytes.size());
    }
  }
}

}  // namespace
}  // namespace cleave
