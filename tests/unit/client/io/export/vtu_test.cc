#include "client/io/export/vtu.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/client/io/export/vtu_reader.h"

namespace cleave {
namespace {

using ::cleave::testing::ReadVtuFile;
using ::cleave::testing::XmlReader;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

VtuGrid OneTetAndOneTriangle() {
  VtuGrid grid;
  grid.time = 0.125;
  grid.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  grid.connectivity = {0, 1, 2, 3, 0, 1, 2};
  grid.offsets = {4, 7};
  grid.types = {kVtuTetrahedron, kVtuTriangle};
  const std::vector<int32_t> regions = {7, -2};
  grid.cell_data.push_back(MakeVtuArray<int32_t>("region", regions));
  grid.point_data.push_back(MakeVtuVectors("displacement", grid.points));
  return grid;
}

TEST(Vtu, ReadsBackAsWritten) {
  const auto bytes = EncodeVtu(OneTetAndOneTriangle(), "cleave 1");
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const auto vtu = ReadVtuFile(*bytes);
  ASSERT_TRUE(vtu.ok()) << vtu.status();
  EXPECT_EQ(vtu->points, 4);
  EXPECT_EQ(vtu->cells, 2);
  EXPECT_EQ(vtu->time, 0.125);
  EXPECT_THAT(vtu->Values<float>("Points.Points"), ElementsAre(0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1));
  EXPECT_THAT(vtu->Values<int64_t>("Cells.connectivity"), ElementsAre(0, 1, 2, 3, 0, 1, 2));
  EXPECT_THAT(vtu->Values<int64_t>("Cells.offsets"), ElementsAre(4, 7));
  EXPECT_THAT(vtu->Values<uint8_t>("Cells.types"), ElementsAre(10, 5));
  EXPECT_THAT(vtu->Values<int32_t>("CellData.region"), ElementsAre(7, -2));
  EXPECT_EQ(vtu->Values<float>("PointData.displacement").size(), 12u);
}

TEST(Vtu, ArraysOfManyBlocksAndWholeLastBlocksReadBack) {
  for (const size_t points : {21845u, 65536u, 70001u}) {
    VtuGrid grid;
    for (size_t i = 0; i < points; ++i) {
      grid.points.push_back({std::sin(static_cast<double>(i)), static_cast<double>(i), 0});
    }
    const auto bytes = EncodeVtu(grid, "many");
    ASSERT_TRUE(bytes.ok()) << bytes.status();
    const auto vtu = ReadVtuFile(*bytes);
    ASSERT_TRUE(vtu.ok()) << vtu.status();
    const std::vector<float> values = vtu->Values<float>("Points.Points");
    ASSERT_EQ(values.size(), 3 * points);
    for (size_t i = 0; i < points; ++i) ASSERT_EQ(values[3 * i + 1], static_cast<float>(i));
  }
}

TEST(Vtu, AnEmptyGridIsAFile) {
  const auto bytes = EncodeVtu(VtuGrid{}, "empty");
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const auto vtu = ReadVtuFile(*bytes);
  ASSERT_TRUE(vtu.ok()) << vtu.status();
  EXPECT_EQ(vtu->points, 0);
}

TEST(Vtu, ArraysThatDoNotFitAreNamed) {
  VtuGrid grid = OneTetAndOneTriangle();
  grid.cell_data[0].bytes.pop_back();
  grid.offsets.back() = 6;
  grid.point_data[0].name = "a<b";
  const absl::Status status = EncodeVtu(grid, "x").status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("cell_data.region"));
  EXPECT_THAT(std::string(status.message()), HasSubstr("offsets"));
  EXPECT_THAT(std::string(status.message()), HasSubstr("a<b"));
}

TEST(Pvd, ListsFilesByTime) {
  const auto bytes = EncodePvd({{0, "a_0.vtu"}, {0.1, "a_1.vtu"}});
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const auto root = XmlReader::Read(*bytes);
  ASSERT_TRUE(root.ok()) << root.status();
  EXPECT_EQ(root->attributes.at("type"), "Collection");
  const auto entries = root->All("DataSet");
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(std::stod(entries[1]->attributes.at("timestep")), 0.1);
  EXPECT_EQ(entries[1]->attributes.at("file"), "a_1.vtu");
  const auto escaped = EncodePvd({{0, "<a> & \"b\".vtu"}});
  ASSERT_TRUE(escaped.ok()) << escaped.status();
  EXPECT_THAT(*escaped, HasSubstr("file=\"&lt;a&gt; &amp; &quot;b&quot;.vtu\""));
  EXPECT_THAT(std::string(EncodePvd({{0, "a\nb.vtu"}}).status().message()),
              HasSubstr("\"a\\nb.vtu\" holds a control character"));
}

}  // namespace
}  // namespace cleave
