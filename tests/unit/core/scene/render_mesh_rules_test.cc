#include "core/scene/render_mesh_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/scene/limits.h"

namespace cleave {
namespace {

using testing::HasSubstr;

std::string MessageOf(const Faults& faults) { return std::string(faults.ToStatus().message()); }

const std::vector<Vec3> kBody = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

RenderMesh Triangle() {
  RenderMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(RenderMesh, OneInOtherUnitsOrElsewhereIsRefused) {
  RenderMesh mesh = Triangle();
  mesh.points = {{0.1, 0, 0}, {1.5, 0, 0}, {0, 1.5, 0}};
  EXPECT_TRUE(CheckRenderMeshFits(mesh, kBody).ok());
  for (const double scale : {1000.0, 0.001, 1e308}) {
    RenderMesh scaled = mesh;
    for (Vec3& p : scaled.points) {
      for (double& coordinate : p) coordinate *= scale;
    }
    EXPECT_THAT(MessageOf(CheckRenderMeshFits(scaled, kBody)), HasSubstr("in the same units?"));
  }
  for (Vec3& p : mesh.points) p[2] += 1.5;
  EXPECT_EQ(MessageOf(CheckRenderMeshFits(mesh, kBody)),
            "points: lies beside the body: along z in [1.5, 1.5] m, the body in [0, 1] m");
}

TEST(RenderMesh, PointsFarFromTheBodyAreRefusedByNumber) {
  RenderMesh mesh = Triangle();
  mesh.points.push_back({0, 0, -0.86});  // half of the diagonal is 0.866
  mesh.points.push_back({1.7, 1.7, 0});
  EXPECT_EQ(
      MessageOf(CheckRenderMeshFits(mesh, kBody)),
      "points[4]: is 0.989949 m away from the body's bounding box; at most 0.866025 m, half of "
      "its diagonal, is allowed");
  mesh.points.pop_back();
  EXPECT_TRUE(CheckRenderMeshFits(mesh, kBody).ok());
}

TEST(RenderMesh, FaultsAreNamedAndOpenEdgesCounted) {
  EXPECT_EQ(MessageOf(CheckRenderMesh({})), "triangles: is empty");
  RenderMesh mesh = Triangle();
  EXPECT_TRUE(CheckRenderMesh(mesh).ok());
  EXPECT_EQ(CountOpenEdges(mesh.triangles), 3);
  mesh.triangles.push_back({2, 1, 0});
  EXPECT_EQ(CountOpenEdges(mesh.triangles), 0);
  mesh.triangles.push_back({0, 1, 3});
  EXPECT_EQ(MessageOf(CheckRenderMesh(mesh)), "triangles[2]: point 3 is outside [0, 3)");
  mesh.triangles[2] = {0, std::numeric_limits<int32_t>::min(), 1};
  EXPECT_THAT(MessageOf(CheckRenderMesh(mesh)), HasSubstr("point -2147483648 is outside"));
}

TEST(RenderMesh, EveryKindOfFaultIsNamedAtOnce) {
  RenderMesh mesh = Triangle();
  mesh.triangles.push_back({7, 1, 0});
  mesh.points[1][2] = std::nan("");
  mesh.uvs.resize(1);
  mesh.uvs[0][2][1] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(MessageOf(CheckRenderMesh(mesh)),
            "uvs: has 1 items, not 2\npoints[1]: is not finite\nuvs[0]: is not finite\n"
            "triangles[1]: point 7 is outside [0, 3)");
}

TEST(RenderMesh, MoreTrianglesThanCanBeShownAreRefusedUnseen) {
  RenderMesh mesh = Triangle();
  mesh.triangles.resize(static_cast<size_t>(limits::kMaxRenderTriangles) + 1, {9, 9, 9});
  EXPECT_EQ(MessageOf(CheckRenderMesh(mesh)),
            "triangles: has 8000001 items; at most 8000000 are allowed");
}

TEST(RenderMesh, ASceneNamesItAsAnAssetInAScale) {
  const auto message_of = [](const RenderMeshSource& source) {
    Faults faults;
    CheckRenderMeshSource(source, faults);
    return MessageOf(faults);
  };
  EXPECT_EQ(message_of({MeshAsset{std::string(64, 'a')}, 0.001}), "");
  EXPECT_THAT(message_of({}), HasSubstr("render_mesh: names no source; one of file, asset"));
  EXPECT_THAT(message_of({MeshFile{"fine.obj"}, 1}),
              HasSubstr("render_mesh.file: \"fine.obj\" is a path of the client"));
  EXPECT_THAT(message_of({MeshAsset{std::string(64, 'G')}, 1}),
              HasSubstr("is not 64 lower-case hex digits"));
  EXPECT_THAT(message_of({MeshAsset{std::string(64, 'a')}, std::nan("")}),
              HasSubstr("render_mesh.unit_scale: nan is outside (0, "));
}

}  // namespace
}  // namespace cleave
