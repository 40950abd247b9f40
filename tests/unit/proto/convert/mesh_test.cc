#include "proto/convert/mesh.h"

#include <gtest/gtest.h>

#include "cleave/v1/scene.pb.h"

namespace cleave {
namespace {

TetMesh Sample() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.1, 0.2, 1e-300}};
  mesh.tets = {{0, 1, 2, 3}};
  mesh.tet_regions = {-4};
  mesh.regions = {{-4, "crust"}};
  return mesh;
}

TEST(Mesh, SurvivesTheRoundTripExactly) {
  const TetMesh mesh = Sample();
  const auto bytes = SerializeMesh(mesh);
  ASSERT_TRUE(bytes.ok());
  const auto back = ParseMesh(*bytes);
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->rest_positions, mesh.rest_positions);
  EXPECT_EQ(back->tets, mesh.tets);
  EXPECT_EQ(back->tet_regions, mesh.tet_regions);
  ASSERT_EQ(back->regions.size(), 1u);
  EXPECT_EQ(back->regions[0].name, "crust");
  EXPECT_EQ(*SerializeMesh(*back), *bytes);
}

TEST(Mesh, RefusesEveryTruncationOrGivesFewerWholeLists) {
  const std::string bytes = *SerializeMesh(Sample());
  for (size_t size = 0; size < bytes.size(); ++size) {
    const auto mesh = ParseMesh(absl::string_view(bytes).substr(0, size));
    if (mesh.ok()) {
      EXPECT_TRUE(mesh->tet_regions.empty() || mesh->tet_regions.size() == mesh->tets.size());
    }
  }
}

TEST(Mesh, ReportsListsOfWrongLengthAndIdsBeyond31Bits) {
  v1::TetMesh message;
  message.add_positions(1);
  for (int i = 0; i < 4; ++i) message.add_tets(0x80000000u);
  message.add_tet_regions(1);
  message.add_tet_regions(2);
  const auto mesh = ParseMesh(message.SerializeAsString());
  ASSERT_FALSE(mesh.ok());
  const std::string text(mesh.status().message());
  EXPECT_NE(text.find("positions: has 1 numbers"), std::string::npos);
  EXPECT_NE(text.find("tet_regions: has 2 items for 1 tets"), std::string::npos);
  EXPECT_NE(text.find("tets[0]: node id 2147483648 is beyond 31 bits"), std::string::npos);
}

RenderMesh SampleRender() {
  RenderMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1e-300}, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {2, 1, 3}};
  mesh.uvs = {{{{0, 0}, {1, 0.5f}, {0, 1}}}, {{{0.25f, 0}, {0, 0}, {-3, 7}}}};
  return mesh;
}

TEST(RenderMesh, SurvivesTheRoundTripExactly) {
  RenderMesh mesh = SampleRender();
  for (const bool has_uvs : {true, false}) {
    if (!has_uvs) mesh.uvs.clear();
    const auto bytes = SerializeRenderMesh(mesh);
    ASSERT_TRUE(bytes.ok());
    const auto back = ParseRenderMesh(*bytes);
    ASSERT_TRUE(back.ok()) << back.status();
    EXPECT_EQ(back->points, mesh.points);
    EXPECT_EQ(back->triangles, mesh.triangles);
    EXPECT_EQ(back->uvs, mesh.uvs);
    EXPECT_EQ(*SerializeRenderMesh(*back), *bytes);
  }
}

TEST(RenderMesh, RefusesEveryTruncationOrGivesFewerWholeLists) {
  const std::string bytes = *SerializeRenderMesh(SampleRender());
  for (size_t size = 0; size < bytes.size(); ++size) {
    const auto mesh = ParseRenderMesh(absl::string_view(bytes).substr(0, size));
    if (mesh.ok()) {
      EXPECT_TRUE(mesh->uvs.empty() || mesh->uvs.size() == mesh->triangles.size());
    }
  }
}

TEST(RenderMesh, ReportsListsOfWrongLengthAndIdsBeyond31Bits) {
  v1::RenderMesh message;
  message.add_points(1);
  for (int i = 0; i < 3; ++i) message.add_triangles(0x80000000u);
  for (int i = 0; i < 5; ++i) message.add_uvs(0);
  const std::string text(ParseRenderMesh(message.SerializeAsString()).status().message());
  EXPECT_NE(text.find("points: has 1 numbers, not three a point"), std::string::npos) << text;
  EXPECT_NE(text.find("uvs: has 5 numbers for 1 triangles; six each"), std::string::npos) << text;
  EXPECT_NE(text.find("triangles[0]: point id 2147483648 is beyond 31 bits"), std::string::npos);
  message.add_triangles(0);
  EXPECT_NE(ParseRenderMesh(message.SerializeAsString())
                .status()
                .message()
                .find("triangles: has 4 point ids, not three a triangle"),
            std::string::npos);
}

TEST(RenderMesh, IsNeverTakenForAMeshNorAMeshForIt) {
  const auto mesh = ParseMesh(*SerializeRenderMesh(SampleRender()));
  ASSERT_TRUE(mesh.ok());
  EXPECT_TRUE(mesh->rest_positions.empty());
  EXPECT_TRUE(mesh->tets.empty());
  const auto render = ParseRenderMesh(*SerializeMesh(Sample()));
  ASSERT_TRUE(render.ok());
  EXPECT_TRUE(render->points.empty());
  EXPECT_TRUE(render->triangles.empty());
}

TEST(ScaleMesh, ScalesEveryCoordinate) {
  TetMesh mesh = Sample();
  ScaleMesh(0.001, mesh);
  EXPECT_EQ(mesh.rest_positions[1], (Vec3{0.001, 0, 0}));
  RenderMesh render = SampleRender();
  ScaleMesh(0.001, render);
  EXPECT_EQ(render.points[1], (Vec3{0.001, 0, 0}));
}

}  // namespace
}  // namespace cleave
