#include "client/io/export/ply.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "core/base/bytes.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;

ShownSurface TwoTriangles() {
  ShownSurface surface;
  surface.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 0, 0}, {6, 0, 0}, {5, 1, 0}};
  surface.triangles = {{0, 1, 2}, {3, 4, 5}};
  surface.pieces = {0, 1};
  surface.inside = {0, 1};
  surface.regions = {3, 4};
  return surface;
}

TEST(Ply, ReadsBackAsWritten) {
  const auto bytes = EncodePly(TwoTriangles(), "key");
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const std::string end = "end_header\n";
  const size_t data = bytes->find(end) + end.size();
  EXPECT_THAT(bytes->substr(0, data), HasSubstr("element vertex 6\n"));
  EXPECT_THAT(bytes->substr(0, data), HasSubstr("element face 2\n"));
  ByteReader reader(absl::string_view(*bytes).substr(data));
  std::vector<std::array<uint8_t, 3>> colors;
  for (const Vec3& point : TwoTriangles().points) {
    for (const double coordinate : point) {
      EXPECT_EQ(reader.Get<float>(), static_cast<float>(coordinate));
    }
    colors.push_back({reader.Get<uint8_t>(), reader.Get<uint8_t>(), reader.Get<uint8_t>()});
  }
  EXPECT_EQ(colors[0], colors[2]);
  EXPECT_NE(colors[0], colors[3]);
  for (const int32_t face : {0, 1}) {
    EXPECT_EQ(reader.Get<uint8_t>(), 3);
    for (const int32_t corner : {0, 1, 2}) EXPECT_EQ(reader.Get<int32_t>(), 3 * face + corner);
    EXPECT_EQ(reader.Get<int32_t>(), face);
    EXPECT_EQ(reader.Get<int32_t>(), 3 + face);
    EXPECT_EQ(reader.Get<uint8_t>(), face);
  }
  EXPECT_TRUE(reader.Finish("faces").ok());
}

TEST(Ply, CarriesWhatIsKnownOfThePoints) {
  ShownSurface surface = TwoTriangles();
  surface.rest_points.assign(6, {1, 2, 3});
  surface.velocities.assign(6, {4, 5, 6});
  surface.damages.assign(6, 0.5f);
  const auto bytes = EncodePly(surface, "key");
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const std::string end = "end_header\n";
  const size_t data = bytes->find(end) + end.size();
  EXPECT_THAT(bytes->substr(0, data),
              HasSubstr("property uchar blue\nproperty float rest_x\nproperty float rest_y\n"
                        "property float rest_z\nproperty float velocity_x\n"));
  EXPECT_THAT(bytes->substr(0, data),
              HasSubstr("property float velocity_z\nproperty float damage\nelement face 2\n"));
  ByteReader reader(absl::string_view(*bytes).substr(data));
  for (size_t i = 0; i < 6; ++i) {
    reader.GetBytes(15);
    for (const float value : {1.0f, 2.0f, 3.0f, 4.0f, 5.0f, 6.0f, 0.5f}) {
      EXPECT_EQ(reader.Get<float>(), value);
    }
  }
  reader.GetBytes(2 * 22);
  EXPECT_TRUE(reader.Finish("faces").ok());
}

TEST(Ply, FacesHaveTheirSourceAndTexture) {
  ShownSurface surface = TwoTriangles();
  surface.sources = {41, -1};
  surface.uvs = {CornerUvs{{{0, 1}, {2, 3}, {4, 5}}}, CornerUvs{}};
  const auto bytes = EncodePly(surface, "key");
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const std::string end =
      "property uchar inside\nproperty int source\nproperty list uchar float "
      "texcoord\nend_header\n";
  ASSERT_THAT(*bytes, HasSubstr(end));
  ByteReader reader(absl::string_view(*bytes).substr(bytes->find(end) + end.size()));
  reader.GetBytes(6 * 15);
  for (const int32_t face : {0, 1}) {
    reader.GetBytes(22);
    EXPECT_EQ(reader.Get<int32_t>(), face == 0 ? 41 : -1);
    EXPECT_EQ(reader.Get<uint8_t>(), 6);
    for (int i = 0; i < 6; ++i)
      EXPECT_EQ(reader.Get<float>(), face == 0 ? static_cast<float>(i) : 0);
  }
  EXPECT_TRUE(reader.Finish("faces").ok());
  surface.sources[0] = int64_t{1} << 31;
  EXPECT_THAT(std::string(EncodePly(surface, "key").status().message()), HasSubstr("sources[0]"));
}

TEST(Ply, BadSurfacesAreRefusedByName) {
  ShownSurface surface = TwoTriangles();
  surface.points[4][1] = std::numeric_limits<double>::quiet_NaN();
  surface.triangles[1][2] = 6;
  surface.regions.pop_back();
  const absl::Status status = EncodePly(surface, "key").status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("points[4]"));
  EXPECT_THAT(std::string(status.message()), HasSubstr("triangles[1]"));
  EXPECT_THAT(std::string(status.message()), HasSubstr("regions"));
}

}  // namespace
}  // namespace cleave
