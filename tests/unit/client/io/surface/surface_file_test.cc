#include "client/io/surface/surface_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace cleave {
namespace {

using testing::HasSubstr;

// A pyramid of a square and four triangles, the base first.
constexpr char kObj[] = R"(# two groups, a normal and a texture coordinate
o pyramid
v 0 0 0
v 0 1 0
v 1 1 0
v 1 0 0
v 0.5 0.5 1
vn 0 0 -1
vt 0 0
usemtl below
f 1/1/1 2/1/1 3/1/1 4/1/1
g sides
usemtl sides
f 1 4 5
f 4 3 5
f 3 2 5
f 2 1 5
)";

constexpr char kPly[] = R"(ply
format ascii 1.0
element vertex 4
property float x
property float y
property float z
property float potency
element face 4
property list uchar int vertex_indices
end_header
0 0 0 1
1 0 0 0.5
0 1 0 0
0 0 1 0
3 0 2 1
3 0 1 3
3 1 2 3
3 0 3 2
)";

constexpr float kTetrahedron[4][3][3] = {{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}},
                                         {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}},
                                         {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                         {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}}};

// A glTF file in one: a triangle with texture coordinates, moved by its node.
std::string Glb() {
  const float numbers[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0, 0, 0.25f};
  const uint16_t ids[] = {0, 1, 2, 0};
  std::string data(reinterpret_cast<const char*>(numbers), sizeof(numbers));
  data.append(reinterpret_cast<const char*>(ids), sizeof(ids));
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"mesh":0,"translation":[0,0,2]}],"meshes":[{"primitives":[{"attributes":)"
      R"({"POSITION":0,"TEXCOORD_0":1},"indices":2}]}],"buffers":[{"byteLength":68}],)"
      R"("bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":24},)"
      R"({"buffer":0,"byteOffset":60,"byteLength":6}],"accessors":[{"bufferView":0,)"
      R"("componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},)"
      R"({"bufferView":1,"componentType":5126,"count":3,"type":"VEC2"},{"bufferView":2,)"
      R"("componentType":5123,"count":3,"type":"SCALAR"}]})";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string file = "glTF";
  const auto put = [&file](size_t value) {
    const auto word = static_cast<uint32_t>(value);
    file.append(reinterpret_cast<const char*>(&word), sizeof(word));
  };
  put(2);
  put(12 + 8 + json.size() + 8 + data.size());
  put(json.size());
  file += "JSON" + json;
  put(data.size());
  file += std::string("BIN\0", 4) + data;
  return file;
}

TEST(SurfaceFile, OfGltfStandsAsItsSceneSaysWithVUpwards) {
  const auto surface = ParseSurfaceFile(Glb(), "a.glb");
  ASSERT_TRUE(surface.ok()) << surface.status();
  ASSERT_EQ(surface->triangles.size(), 1u);
  EXPECT_EQ(surface->vertices[1], (Vec3{1, 0, 2}));
  ASSERT_EQ(surface->uvs.size(), 1u);
  // glTF counts v from the top of the picture.
  EXPECT_EQ(surface->uvs[0][0], (std::array<float, 2>{0, 1}));
  EXPECT_EQ(surface->uvs[0][1], (std::array<float, 2>{0.5f, 1}));
  EXPECT_EQ(surface->uvs[0][2], (std::array<float, 2>{0, 0.75f}));
}

TEST(SurfaceFile, OfGltfThatIsCutOrDamagedIsRefusedOrWhole) {
  const std::string file = Glb();
  for (size_t i = 0; i < file.size(); i += 29) {
    const auto cut = ParseSurfaceFile(absl::string_view(file).substr(0, i), "a.glb");
    EXPECT_FALSE(cut.ok()) << i;
    std::string damaged = file;
    damaged[i] = static_cast<char>(damaged[i] ^ 0x11);
    const auto read = ParseSurfaceFile(damaged, "a.glb");
    if (!read.ok()) continue;
    for (const auto& triangle : read->triangles) {
      for (const int32_t vertex : triangle)
        EXPECT_LT(static_cast<size_t>(vertex), read->vertices.size()) << i;
    }
  }
}

TEST(SurfaceFile, HasTextureCoordinatesWhereAllOfItsPartsDo) {
  constexpr char kTextured[] = R"(v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
vt 0 0
vt 0.5 0
vt 0 0.25
vt 1 1
f 1/1 3/2 2/3
f 1/1 2/4 4/3
)";
  const auto textured = ParseSurfaceFile(kTextured, "a.obj");
  ASSERT_TRUE(textured.ok()) << textured.status();
  ASSERT_EQ(textured->uvs.size(), 2u);
  EXPECT_EQ(textured->vertices.size(), 4u);  // a place with two coordinates is one vertex
  for (size_t i = 0; i < 2; ++i) {
    for (size_t k = 0; k < 3; ++k) {
      const int32_t vertex = textured->triangles[i][k];
      const Vec3& at = textured->vertices[static_cast<size_t>(vertex)];
      if (at == Vec3{1, 0, 0}) {
        EXPECT_EQ(textured->uvs[i][k],
                  (std::array<float, 2>{i == 0 ? 0.0f : 1.0f, i == 0 ? 0.25f : 1.0f}));
      }
      if (at == Vec3{0, 1, 0}) {
        EXPECT_EQ(textured->uvs[i][k], (std::array<float, 2>{0.5f, 0}));
      }
    }
  }
  EXPECT_TRUE(ParseSurfaceFile(kObj, "a.obj")->uvs.empty());  // its sides have none
}

std::string BinaryStl() {
  std::string bytes(80, '\0');
  const uint32_t count = 4;
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& triangle : kTetrahedron) {
    bytes.append(12, '\0');  // a normal, which readers work out
    bytes.append(reinterpret_cast<const char*>(triangle), sizeof triangle);
    bytes.append(2, '\0');
  }
  return bytes;
}

// The volume a closed surface encloses, m^3: positive where triangles turn as seen from outside.
double Volume(const SurfaceMesh& surface) {
  double volume = 0;
  for (const auto& t : surface.triangles) {
    const Vec3& a = surface.vertices[static_cast<size_t>(t[0])];
    const Vec3& b = surface.vertices[static_cast<size_t>(t[1])];
    const Vec3& c = surface.vertices[static_cast<size_t>(t[2])];
    volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
               a[2] * (b[0] * c[1] - b[1] * c[0])) /
              6;
  }
  return volume;
}

TEST(SurfaceFile, GroupsOfAnObjBecomeOneSurfaceOfTriangles) {
  const auto surface = ParseSurfaceFile(kObj, "pyramid.OBJ");
  ASSERT_TRUE(surface.ok()) << surface.status();
  EXPECT_EQ(surface->vertices.size(), 5u);
  EXPECT_EQ(surface->triangles.size(), 6u);
  EXPECT_NEAR(Volume(*surface), 1.0 / 3, 1e-12);
}

TEST(SurfaceFile, PlyIsRead) {
  const auto surface = ParseSurfaceFile(kPly, "a.ply");
  ASSERT_TRUE(surface.ok()) << surface.status();
  EXPECT_THAT(surface->vertices, testing::UnorderedElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0},
                                                               Vec3{0, 1, 0}, Vec3{0, 0, 1}));
  EXPECT_NEAR(Volume(*surface), 1.0 / 6, 1e-12);
}

TEST(SurfaceFile, TrianglesOfAnStlShareTheirVertices) {
  const auto surface = ParseSurfaceFile(BinaryStl(), "a.stl");
  ASSERT_TRUE(surface.ok()) << surface.status();
  EXPECT_EQ(surface->vertices.size(), 4u);
  EXPECT_EQ(surface->triangles.size(), 4u);
  EXPECT_NEAR(Volume(*surface), 1.0 / 6, 1e-12);
}

TEST(SurfaceFile, VerticesThatAreNearButNotEqualStayApart) {
  const auto surface = ParseSurfaceFile("v 0 0 0\nv 1e-9 0 0\nv 0 1e-9 0\nf 1 2 3\n", "speck.obj");
  ASSERT_TRUE(surface.ok()) << surface.status();
  EXPECT_EQ(surface->vertices.size(), 3u);
}

TEST(SurfaceFile, WhatIsNoSurfaceIsRefusedByName) {
  const auto refused = [](absl::string_view bytes, absl::string_view name) {
    const absl::Status status = ParseSurfaceFile(bytes, name).status();
    EXPECT_TRUE(absl::IsInvalidArgument(status)) << status;
    return std::string(status.message());
  };
  EXPECT_THAT(refused(kObj, "a.fbx"), HasSubstr(".obj, .ply, .stl and .glb are"));
  EXPECT_EQ(refused("", "a.obj"), "is empty");
  EXPECT_THAT(refused("ply\nnot really", "a.ply"), HasSubstr("cannot be read as PLY"));
  EXPECT_THAT(refused(BinaryStl().substr(0, 150), "a.stl"), HasSubstr("cannot be read as STL"));
  EXPECT_THAT(refused("v 0 0 0\nv 1 0 0\nl 1 2\n", "a.obj"),
              testing::AnyOf(HasSubstr("no triangle"), HasSubstr("cannot be read as OBJ")));
  EXPECT_THAT(refused("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "a.obj"),
              testing::AnyOf(HasSubstr("not a finite number"), HasSubstr("cannot be read as OBJ")));
}

TEST(SurfaceFile, AMissingFileIsNamed) {
  const absl::Status status = ReadSurfaceFile("/nowhere/no_such_surface.obj").status();
  EXPECT_TRUE(absl::IsNotFound(status)) << status;
  EXPECT_THAT(std::string(status.message()), HasSubstr("no_such_surface.obj"));
}

}  // namespace
}  // namespace cleave
