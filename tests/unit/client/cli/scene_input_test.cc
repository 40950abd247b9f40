#include "client/cli/scene_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "core/picture/image.h"
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

TEST_F(SceneInputTest, UnitOfAFileThatSaysItItselfIsRefused) {
  for (const std::string path : {"bar.scene.json", "mesh.pb"}) {
    const absl::Status status = ReadAnyMesh(folder_ + "/" + path, 0.001).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    EXPECT_THAT(std::string(status.message()), HasSubstr("--unit-scale: " + folder_ + "/" + path));
  }
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

TEST_F(SceneInputTest, MissingFilesAreNamedTogetherWithWrongValues) {
  const std::string path = Write(
      "a.scene.json",
      "{\"mesh\": {\"file\": \"none.msh\"},\n"
      "\"materials\": [{\"youngs_modulus\": -1, \"poisson_ratio\": 0.3, \"density\": 1}],\n"
      "\"colliders\": [{\"name\": \"a\", \"surface\": {\"file\": \"none.obj\"}}],\n"
      "\"impurities\": {\"layers\": [{\"potency\": 1, \"paint\": {\"file\": \"none.ply\"}}]}}");
  const absl::Status status = LoadScene(path).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
  EXPECT_THAT(std::string(status.message()),
              testing::AllOf(HasSubstr(path + ":1: mesh.file: "),
                             HasSubstr(path + ":2: materials[0].youngs_modulus: -1"),
                             HasSubstr(path + ":3: colliders[0].surface.file: "),
                             HasSubstr(path + ":4: impurities.layers[0].paint.file: ")));
  // Each once, though servers refuse files for another reason.
  EXPECT_THAT(std::string(status.message()), testing::Not(HasSubstr("path of the client")));
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

// A square of n x n pairs of triangles, 1 m wide, on top of the unit box.
std::string TexturedSquare(int n) {
  std::string text;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= n; ++j) {
      const double x = i / static_cast<double>(n), y = j / static_cast<double>(n);
      absl::StrAppend(&text, "v ", x, " ", y, " 1\nvt ", x, " ", y, "\n");
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const int a = i * (n + 1) + j + 1, b = a + n + 1;
      absl::StrAppend(&text, "f ", a, "/", a, " ", b, "/", b, " ", b + 1, "/", b + 1, "\nf ", a,
                      "/", a, " ", b + 1, "/", b + 1, " ", a + 1, "/", a + 1, "\n");
    }
  }
  return text;
}

TEST_F(SceneInputTest, TexturesOfFourThousandTexelsOnFineSurfacesFitIntoOneMessage) {
  Write("square.obj", TexturedSquare(220));
  Write("grain.png", *EncodePng(Image(4096, 256)));
  const auto input = LoadScene(
      Write("a.scene.json",
            absl::StrCat(
                "{\"mesh\": {\"box\": {\"size\": [1, 1, 1], \"resolution\": {\"cell_size\": 0.1}}},"
                "\"impurities\": {\"layers\": [{\"potency\": 1, \"paint\": {\"file\": "
                "\"square.obj\", \"depth\": 0.2, \"texture\": {\"file\": \"grain.png\"}}}]}, ",
                kMaterial, "}")));
  ASSERT_TRUE(input.ok()) << input.status();
  EXPECT_LT(input->file.scene.ByteSizeLong(), size_t{2} << 20);
  const v1::SurfacePaint& paint = input->file.scene.impurities().layers(0).paint();
  EXPECT_EQ(paint.texture().width(), 1024);
  EXPECT_EQ(paint.texture().height(), 256);
  EXPECT_GT(paint.triangles_size(), 3 * 50);
  EXPECT_EQ(paint.texture().uvs_size(), 2 * paint.triangles_size());
  // What is simulated here is what is sent.
  const auto& read = std::get<SurfacePaint>(input->scene.impurities->layers[0].source);
  EXPECT_EQ(3 * read.triangles.size(), static_cast<size_t>(paint.triangles_size()));
  EXPECT_EQ(3 * read.vertices.size(), static_cast<size_t>(paint.vertices_size()));
  for (size_t k = 0; k < read.triangles.size(); ++k) {
    for (size_t corner = 0; corner < 3; ++corner) {
      const Vec3& vertex = read.vertices[static_cast<size_t>(read.triangles[k][corner])];
      EXPECT_FLOAT_EQ(read.texture->uvs[k][2 * corner], static_cast<float>(vertex[0]));
      EXPECT_FLOAT_EQ(read.texture->uvs[k][2 * corner + 1], static_cast<float>(vertex[1]));
    }
  }
}

TEST_F(SceneInputTest, ALayerThatNoMessageHoldsIsNamed) {
  std::string shares = "0";
  for (int i = 1; i < 550'000; ++i) shares += ",0";
  const absl::Status status =
      LoadScene(
          Write("a.scene.json",
                absl::StrCat(
                    "{\"mesh\": {\"box\": {\"size\": [1, 1, 1], \"resolution\": "
                    "{\"cell_size\": 0.5}}},\n\"impurities\": {\"layers\": [\n{\"noise\": {}, "
                    "\"potency\": 1},\n{\"potency\": 1, \"node_values\": {\"shares\": [",
                    shares, "]}}]}, ", kMaterial, "}")))
          .status();
  EXPECT_THAT(std::string(status.message()),
              HasSubstr(":4: impurities.layers[1]: holds 4.2 MiB; a scene with all its layers "
                        "travels in 3.9 MiB"));
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

TEST_F(SceneInputTest, RenderMeshIsReadAndHeldToTheBodyOfAFile) {
  Write("body.msh",
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n"
        "$EndNodes\n$Elements\n1\n1 4 0 1 2 3 4\n$EndElements\n");
  Write("fine.obj",
        "v 0 0 0\nv 1000 0 0\nv 0 1000 0\nv 0 0 1000\nvt 0 0\nvt 1 0\nvt 0 1\n"
        "f 1/1 3/2 2/3\nf 1/1 2/2 4/3\nf 2/1 3/2 4/3\n");
  const auto load = [&](absl::string_view render_mesh) {
    return LoadScene(Write("a.scene.json",
                           absl::StrCat("{\"mesh\": {\"file\": \"body.msh\"},\n\"render_mesh\": {",
                                        render_mesh, "},\n", kMaterial, "}")));
  };
  const auto input = load("\"file\": \"fine.obj\", \"unit_scale\": 0.001");
  ASSERT_TRUE(input.ok()) << input.status();
  ASSERT_TRUE(input->render_mesh.has_value());
  EXPECT_EQ(input->render_mesh->uvs.size(), 3u);
  ASSERT_EQ(input->warnings.size(), 1u);
  EXPECT_EQ(input->warnings[0].field, "render_mesh.file");
  EXPECT_THAT(input->warnings[0].description, HasSubstr("is not closed: 3 edges"));
  const auto message_of = [&](absl::string_view render_mesh) {
    return std::string(load(render_mesh).status().message());
  };
  EXPECT_THAT(message_of("\"file\": \"fine.obj\""),
              HasSubstr(":2: render_mesh.points: spans 1732.05 m, the body 1.73205 m"));
  EXPECT_THAT(message_of("\"file\": \"none.obj\""),
              testing::AllOf(HasSubstr(":2: render_mesh.file: "), HasSubstr("none.obj")));
  EXPECT_THAT(message_of("\"unit_scale\": 2"), HasSubstr(":2: render_mesh: names no source"));
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
  // What the command line said is not the file's fault.
  auto& of_call = *bad_request.add_field_violations();
  of_call.set_field("session_id");
  of_call.set_description("\"ab\" is short");
  status.SetPayload("type.googleapis.com/google.rpc.BadRequest",
                    absl::Cord(bad_request.SerializeAsString()));
  EXPECT_EQ(WithLines(*file, status).message(),
            "--session: \"ab\" is short\na.scene.json:2: seed: is unlucky");
}

}  // namespace
}  // namespace cleave
