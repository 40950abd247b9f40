#include "client/cli/scene_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "google/rpc/error_details.pb.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using testing::HasSubstr;

class SceneInputTest : public testing::Test {
 protected:
  std::string Write(const std::string& name, absl::string_view text) {
    std::ofstream(folder_ + "/" + name) << text;
    return folder_ + "/" + name;
  }
  const TemporaryDirectory directory_;
  const std::string folder_ = directory_.path();
};

constexpr char kMaterial[] =
    "\"materials\": [{\"youngs_modulus\": 1e5,\n \"poisson_ratio\": 0.3, \"density\": 1000}]";

TEST_F(SceneInputTest, BundledSceneLoadsWithItsMesh) {
  const auto input = LoadScene(CLEAVE_SOURCE_DIR "/tests/scenes/tensile_bar.scene.json");
  ASSERT_TRUE(input.ok()) << input.status();
  ASSERT_TRUE(input->mesh.has_value());
  EXPECT_GT(input->mesh->tet_count(), 1000);
  const auto mesh = SceneMesh(*input);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->rest_positions[0][0], input->mesh->rest_positions[0][0] * 0.001);
}

TEST_F(SceneInputTest, FaultsOfValuesNameTheirLine) {
  const std::string path = Write(
      "a.scene.json",
      "{\"mesh\": {\"box\": {\"size\": [1, 1, 1], \"resolution\": {\"cell_size\": 0.5}}},\n"
      "\"materials\": [{\"youngs_modulus\": 1e5,\n\"poisson_ratio\": 0.7,\n\"density\": -1}]}");
  const absl::Status status = LoadScene(path).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  EXPECT_THAT(std::string(status.message()),
              testing::AllOf(HasSubstr(path + ":3: materials[0].poisson_ratio: 0.7"),
                             HasSubstr(path + ":4: materials[0].density: -1")));
}

TEST_F(SceneInputTest, MissingMeshFileIsNamed) {
  const std::string path =
      Write("a.scene.json", absl::StrCat("{\"mesh\": {\"file\": \"none.msh\"}, ", kMaterial, "}"));
  const absl::Status status = LoadScene(path).status();
  EXPECT_TRUE(absl::IsNotFound(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr(folder_ + "/none.msh"));
}

TEST_F(SceneInputTest, ProceduralMeshIsBuiltInMetres) {
  const std::string path = Write(
      "a.scene.json",
      absl::StrCat("{\"mesh\": {\"unit_scale\": 0.5, \"box\": {\"size\": [1, 1, 1], \"resolution\":"
                   "{\"layout\": \"MESH_LAYOUT_JITTERED_LATTICE\", \"cell_size\": 0.5}}}, ",
                   kMaterial, "}"));
  const auto mesh = ReadAnyMesh(path, 1);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  double largest = 0;
  for (const Vec3& position : mesh->rest_positions) largest = std::max(largest, position[0]);
  EXPECT_DOUBLE_EQ(largest, 0.5);
}

TEST_F(SceneInputTest, SurfaceFilesOfCollidersTravelInsideTheScene) {
  Write("wedge.obj", "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
  const std::string path =
      Write("a.scene.json",
            absl::StrCat(
                "{\"mesh\": {\"box\": {\"size\": [1, 1, 1], \"resolution\": {\"cell_size\": 0.5}}},"
                "\"colliders\": [{\"surface\": {\"file\": \"wedge.obj\", \"unit_scale\": 0.1}}], ",
                kMaterial, "}"));
  const auto input = LoadScene(path);
  ASSERT_TRUE(input.ok()) << input.status();
  EXPECT_EQ(input->file.scene.colliders(0).surface().file(), "");
  EXPECT_EQ(input->file.scene.colliders(0).surface().triangles_size(), 12);
  const auto& surface = std::get<SurfaceShape>(input->scene.colliders[0].shape);
  ASSERT_EQ(surface.vertices.size(), 4u);
  double largest = 0;
  for (const Vec3& vertex : surface.vertices) largest = std::max(largest, vertex[0]);
  EXPECT_DOUBLE_EQ(largest, 1);
}

TEST_F(SceneInputTest, FaultsOfSurfaceFilesNameFieldAndLine) {
  Write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const auto message_of = [&](absl::string_view surface) {
    const std::string path = Write(
        "a.scene.json", absl::StrCat("{\"mesh\": {\"box\": {\"size\": [1, 1, 1], \"resolution\":"
                                     "{\"cell_size\": 0.5}}},\n\"colliders\": [\n{\"surface\": ",
                                     surface, "}], ", kMaterial, "}"));
    return std::string(LoadScene(path).status().message());
  };
  EXPECT_THAT(message_of("{\"file\": \"none.obj\"}"),
              testing::AllOf(HasSubstr(":3: colliders[0].surface.file: "), HasSubstr("none.obj")));
  EXPECT_THAT(message_of("{\"file\": \"open.obj\", \"vertices\": [0, 0, 0]}"),
              HasSubstr(":3: colliders[0].surface.file: stands beside vertices or triangles"));
  EXPECT_THAT(message_of("{\"file\": \"open.obj\"}"),
              HasSubstr("colliders[0].surface.triangles: the surface is not closed"));
  EXPECT_THAT(message_of("{\"file\": \"open.obj\", \"unit_scale\": 0}"),
              HasSubstr("colliders[0].surface.unit_scale: 0 is outside (0, "));
}

TEST_F(SceneInputTest, FaultsFromTheServerGetTheirLines) {
  const auto file = ParseScene("{\n\"seed\": 1}", SceneFormat::kJson, "a.scene.json");
  ASSERT_TRUE(file.ok());
  google::rpc::BadRequest bad_request;
  bad_request.add_field_violations()->set_field("scene.seed");
  bad_request.mutable_field_violations(0)->set_description("is unlucky");
  absl::Status status = absl::InvalidArgumentError("seed: is unlucky");
  status.SetPayload("type.googleapis.com/google.rpc.BadRequest",
                    absl::Cord(bad_request.SerializeAsString()));
  EXPECT_EQ(WithLines(*file, status).message(), "a.scene.json:2: seed: is unlucky");
  EXPECT_EQ(WithLines(*file, absl::NotFoundError("none")).message(), "none");
}

}  // namespace
}  // namespace cleave
