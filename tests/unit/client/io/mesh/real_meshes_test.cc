#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "client/io/mesh/mesh_file.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/quality.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;

// Meshes that others made; built where CLEAVE_MESHES_DIR holds them.
std::string PathOf(const std::string& name) { return std::string(CLEAVE_MESHES_DIR) + "/" + name; }

struct Expected {
  const char* file;
  int64_t nodes;
  int64_t tets;
  int64_t components;
  size_t regions;
};

TEST(RealMeshes, AreReadAndSound) {
  const Expected meshes[] = {
      {"tet/bar-14114.msh", 3842, 14114, 1, 1},
      {"tet/rod300x33.msh", 13333, 50511, 1, 1},
      {"tet/mat20x20.msh", 800, 2166, 1, 1},
      {"tet/cubes_3regions_v41.msh", 7714, 32981, 1, 3},
      {"tet/corner_two_components.msh", 285, 812, 2, 1},
      {"tet/spot_276k_v41bin.msh.zst", 69395, 276266, 1, 1},
      {"format-cases/gmsh_22_ascii.msh", 8, 5, 1, 3},
      {"format-cases/gmsh_22_binary.msh", 8, 5, 1, 3},
      {"format-cases/gmsh_41_ascii.msh", 8, 5, 1, 3},
      {"format-cases/gmsh_41_binary.msh", 8, 5, 1, 3},
      {"format-cases/gmsh_physical_sides_3d_v41.msh", 5, 2, 1, 2},
      {"format-cases/beam-tet_legacy.vtk", 36, 48, 1, 2},
      {"tet/beam3_tet.veg", 208, 450, 1, 1},
      {"format-cases/nested_cubes_v22.msh", 138, 520, 1, 2},
  };
  for (const Expected& expected : meshes) {
    SCOPED_TRACE(expected.file);
    absl::StatusOr<TetMesh> mesh = ReadMeshFile(PathOf(expected.file));
    if (!mesh.ok()) {
      ADD_FAILURE() << mesh.status();
      continue;
    }
    EXPECT_EQ(mesh->node_count(), expected.nodes);
    EXPECT_EQ(mesh->tet_count(), expected.tets);
    const Faults faults = CheckAndOrientMesh(*mesh);
    EXPECT_TRUE(faults.ok()) << faults.ToStatus();
    EXPECT_EQ(faults.warning_count(), 0);
    const MeshReport report = ReportMesh(*mesh, BuildIncidence(*mesh));
    EXPECT_EQ(report.component_count, expected.components);
    EXPECT_EQ(report.regions.size(), expected.regions);
  }
}

TEST(RealMeshes, SurfacesAreRefusedWithTheWayOut) {
  int seen = 0;
  for (const char* folder : {"surface", "malformed"}) {
    for (const auto& entry : std::filesystem::directory_iterator(PathOf(folder))) {
      ++seen;
      const absl::Status status = ReadMeshFile(entry.path().string()).status();
      EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << status;
      EXPECT_THAT(std::string(status.message()),
                  HasSubstr(entry.file_size() == 0 ? "empty" : "surface"));
    }
  }
  EXPECT_GT(seen, 4);
}

}  // namespace
}  // namespace cleave
