#include "client/io/export/obj.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_split.h"

namespace cleave {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TetMesh TwoRegions() {
  TetMesh mesh;
  mesh.rest_positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.tets = {{0, 1, 2, 3}, {0, 1, 2, 3}};
  mesh.tet_regions = {4, 2};
  mesh.regions = {{4, "bread crust"}};
  return mesh;
}

// A tetrahedron of piece 1 with an inside face, and one of piece 0 in another region.
ShownSurface TwoTetrahedra() {
  ShownSurface surface;
  surface.frame = 3;
  surface.time = 0.25;
  for (const double x : {0.0, 5.0}) {
    surface.points.insert(surface.points.end(), {{x, 0, 0}, {x + 1, 0, 0}, {x, 1, 0}, {x, 0, 1}});
  }
  for (const int32_t first : {0, 4}) {
    surface.triangles.insert(surface.triangles.end(), {{first + 1, first + 2, first + 3},
                                                       {first, first + 3, first + 2},
                                                       {first, first + 1, first + 3},
                                                       {first, first + 2, first + 1}});
  }
  surface.rest_points = surface.points;
  surface.pieces = {1, 1, 1, 1, 0, 0, 0, 0};
  surface.inside = {0, 1, 0, 0, 0, 0, 0, 0};
  surface.regions = {4, 4, 4, 4, 2, 2, 2, 2};
  return surface;
}

TEST(Obj, ReadsBackAsWritten) {
  const ShownSurface surface = TwoTetrahedra();
  const auto bytes =
      EncodeObj(surface, SurfaceMaterials(TwoRegions()), {"key", "body", "body.mtl", true});
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  EXPECT_TRUE(absl::StartsWith(*bytes, "# key, time 0.25 s, frame 3"));
  std::vector<Vec3> points;
  std::vector<Vec3> normals;
  size_t textures = 0;
  std::vector<std::string> parts;  // group and material of each run of faces
  std::string group;
  std::vector<std::array<int, 3>> faces;
  for (const absl::string_view view : absl::StrSplit(*bytes, '\n')) {
    const std::string line(view);
    Vec3 v{};
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &v[0], &v[1], &v[2]) == 3) points.push_back(v);
    if (std::sscanf(line.c_str(), "vn %lf %lf %lf", &v[0], &v[1], &v[2]) == 3) normals.push_back(v);
    textures += absl::StartsWith(line, "vt ") ? 1 : 0;
    if (absl::StartsWith(line, "g ")) group = line.substr(2);
    if (absl::StartsWith(line, "usemtl ")) parts.push_back(group + " " + line.substr(7));
    std::array<std::array<int, 3>, 3> f{};
    if (std::sscanf(line.c_str(), "f %d/%d/%d %d/%d/%d %d/%d/%d", &f[0][0], &f[0][1], &f[0][2],
                    &f[1][0], &f[1][1], &f[1][2], &f[2][0], &f[2][1], &f[2][2]) == 9) {
      faces.push_back({f[0][0] - 1, f[1][0] - 1, f[2][0] - 1});
      for (const auto& [point, uv, normal] : f) {
        EXPECT_LE(static_cast<size_t>(uv), textures);
        ASSERT_LE(static_cast<size_t>(normal), normals.size());
        const Vec3& n = normals[static_cast<size_t>(normal) - 1];
        EXPECT_NEAR(std::hypot(n[0], n[1], n[2]), 1, 1e-3);
      }
    }
  }
  EXPECT_EQ(points, surface.points);
  EXPECT_THAT(parts, ElementsAre("piece_0 outside_2", "piece_1 outside_bread_crust",
                                 "piece_1 inside_bread_crust"));
  ASSERT_EQ(faces.size(), 8u);
  EXPECT_THAT(faces[0], ElementsAre(5, 6, 7));
  EXPECT_THAT(faces[7], ElementsAre(0, 3, 2));  // the inside one is last
}

TEST(Obj, MaterialsTellOutsideFromInsideByRegion) {
  const std::string text = EncodeMtl(SurfaceMaterials(TwoRegions()));
  for (const char* name : {"outside_2", "inside_2", "outside_bread_crust", "inside_bread_crust"}) {
    EXPECT_THAT(text, HasSubstr(std::string("newmtl ") + name + "\nKd "));
  }
  TetMesh alike = TwoRegions();
  alike.regions = {{2, "a b"}, {4, "a-b"}};
  const SurfaceMaterials materials(alike);
  EXPECT_EQ(materials.list()[materials.IndexOf(2, false)].name, "outside_a_b");
  EXPECT_EQ(materials.list()[materials.IndexOf(4, true)].name, "inside_a_b_4");
}

TEST(Obj, TextureIsTheRestShapeAlongTheAxisThatIsFaced) {
  EXPECT_EQ(FacedAxis({0, 0, 0}, {1, 0, 0}, {0, 1, 0.1}), 2u);
  EXPECT_EQ(FacedAxis({0, 0, 0}, {0, 1, 0}, {0, 0, 1}), 0u);
  EXPECT_EQ(FacedAxis({0, 0, 0}, {1, 0, 0}, {0, 0, 1}), 1u);
  EXPECT_EQ(RestUv({1, 2, 3}, 1), (std::array<double, 2>{3, 1}));
}

TEST(Obj, SurfacesWithoutFacesOrRestPointsAreRefused) {
  const SurfaceMaterials materials(TwoRegions());
  EXPECT_THAT(std::string(EncodeObj({}, materials, {}).status().message()),
              HasSubstr("no triangles"));
  ShownSurface surface = TwoTetrahedra();
  surface.rest_points.pop_back();
  EXPECT_THAT(std::string(EncodeObj(surface, materials, {}).status().message()),
              HasSubstr("rest_points: has 7 items, not 8"));
  surface.rest_points.clear();
  EXPECT_THAT(std::string(EncodeObj(surface, materials, {}).status().message()),
              HasSubstr("rest_points: are not known"));
}

}  // namespace
}  // namespace cleave
