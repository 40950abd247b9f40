#include "client/io/mesh/gmsh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "core/base/bytes.h"

namespace cleave {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Two tets in two groups, node numbers with gaps and out of order, a triangle and a point.
constexpr char kAscii22[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$Comments\nfree text $Nodes\n$EndComments\n"
    "$PhysicalNames\n3\n2 5 \"skin\"\n3 5 \"left part\"\n3 9 \"right\"\n$EndPhysicalNames\n"
    "$Nodes\n5\n10 0 0 0\n3 1 0 0\n7 0 1 0\n8 0 0 1\n100 1 1 1.5e0\n$EndNodes\n"
    "$Elements\n4\n1 15 2 0 1 10\n2 2 2 5 1 10 3 7\n3 4 2 5 1 10 3 7 8\n4 4 3 9 2 0 3 7 8 100\n"
    "$EndElements\n";

constexpr char kAscii41[] =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n2\n3 5 \"left part\"\n3 9 \"right\"\n$EndPhysicalNames\n"
    "$Entities\n1 0 1 2\n1 0 0 0 0\n1 0 0 0 1 1 1 1 5 0\n"
    "1 0 0 0 1 1 1 2 5 6 1 1\n2 0 0 0 1 1 1 1 -9 0\n$EndEntities\n"
    "$Nodes\n3 5 3 100\n2 1 1 3\n10\n3\n7\n0 0 0 0.5 0.5\n1 0 0 0.5 0.5\n0 1 0 0.5 0.5\n"
    "3 1 0 1\n8\n0 0 1\n3 2 0 1\n100\n1 1 1.5\n$EndNodes\n"
    "$Elements\n4 4 1 4\n0 1 15 1\n1 10\n2 1 2 1\n2 10 3 7\n3 1 4 1\n3 10 3 7 8\n"
    "3 2 4 1\n4 3 7 8 100\n$EndElements\n$NodeData\nwhatever\n$EndNodeData\n";

void ExpectTheTwoTets(const absl::StatusOr<TetMesh>& mesh) {
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_THAT(mesh->rest_positions, ElementsAre(Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0},
                                                Vec3{0, 0, 1}, Vec3{1, 1, 1.5}));
  EXPECT_THAT(mesh->tets,
              ElementsAre(std::array<int32_t, 4>{0, 1, 2, 3}, std::array<int32_t, 4>{1, 2, 3, 4}));
  EXPECT_THAT(mesh->tet_regions, ElementsAre(5, 9));
  ASSERT_EQ(mesh->regions.size(), 2u);
  EXPECT_EQ(mesh->regions[0].name, "left part");
  EXPECT_EQ(mesh->regions[1].id, 9);
}

std::string Binary22() {
  std::string file = "$MeshFormat\n2.2 1 8\n";
  ByteWriter out(file);
  out.Put<int32_t>(1);
  file += "\n$EndMeshFormat\n$PhysicalNames\n2\n3 5 \"left part\"\n3 9 \"right\"\n";
  file += "$EndPhysicalNames\n$Nodes\n5\n";
  const std::vector<std::pair<int32_t, Vec3>> nodes = {
      {10, {0, 0, 0}}, {3, {1, 0, 0}}, {7, {0, 1, 0}}, {8, {0, 0, 1}}, {100, {1, 1, 1.5}}};
  for (const auto& [number, position] : nodes) {
    out.Put(number);
    for (const double x : position) out.Put(x);
  }
  file += "\n$EndNodes\n$Elements\n3\n";
  for (const int32_t x :
       {2,      1, 2, /**/ 2, 5, 1, 10, 3, 7, /**/ 4, 2, 2, /**/ 3, 5, 1, 10, 3, 7, 8,
        /**/ 4, 9, 2, 3,      7, 8, 100}) {
    out.Put(x);
  }
  file += "\n$EndElements\n";
  return file;
}

// `flip` writes every number in the other byte order.
std::string Binary41(bool flip = false) {
  std::string file = "$MeshFormat\n4.1 1 8\n";
  const auto put = [&](auto value) {
    std::string raw;
    ByteWriter(raw).Put(value);
    if (flip) std::reverse(raw.begin(), raw.end());
    file += raw;
  };
  const auto ints = [&](std::initializer_list<int32_t> values) {
    for (const int32_t value : values) put(value);
  };
  const auto sizes = [&](std::initializer_list<uint64_t> values) {
    for (const uint64_t value : values) put(value);
  };
  const auto doubles = [&](std::initializer_list<double> values) {
    for (const double value : values) put(value);
  };
  ints({1});
  file += "\n$EndMeshFormat\n$PhysicalNames\n2\n3 5 \"left part\"\n3 9 \"right\"\n";
  file += "$EndPhysicalNames\n$Entities\n";
  sizes({0, 0, 0, 2});
  for (const int32_t volume : {1, 2}) {
    ints({volume});
    doubles({0, 0, 0, 1, 1, 1});
    sizes({1});
    ints({volume == 1 ? 5 : 9});
    sizes({2});
    ints({1, -2});
  }
  file += "\n$EndEntities\n$Nodes\n";
  sizes({2, 5, 3, 100});
  ints({3, 1, 0});
  sizes({4, 10, 3, 7, 8});
  doubles({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  ints({3, 2, 0});
  sizes({1, 100});
  doubles({1, 1, 1.5});
  file += "\n$EndNodes\n$Elements\n";
  sizes({2, 2, 3, 4});
  ints({3, 1, 4});
  sizes({1, 3, 10, 3, 7, 8});
  ints({3, 2, 4});
  sizes({1, 4, 3, 7, 8, 100});
  file += "\n$EndElements\n";
  return file;
}

TEST(Gmsh, ReadsVersion22Ascii) { ExpectTheTwoTets(ParseGmsh(kAscii22)); }
TEST(Gmsh, ReadsVersion22Binary) { ExpectTheTwoTets(ParseGmsh(Binary22())); }
TEST(Gmsh, ReadsVersion41Ascii) { ExpectTheTwoTets(ParseGmsh(kAscii41)); }
TEST(Gmsh, ReadsVersion41BinaryOfEitherOrder) {
  ExpectTheTwoTets(ParseGmsh(Binary41()));
  ExpectTheTwoTets(ParseGmsh(Binary41(true)));
}
TEST(Gmsh, ReadsLineEndsOfOtherSystems) {
  ExpectTheTwoTets(ParseGmsh(absl::StrReplaceAll(kAscii22, {{"\n", "\r\n"}})));
}

TEST(Gmsh, WithoutPhysicalGroupsHasNoRegions) {
  const absl::StatusOr<TetMesh> mesh = ParseGmsh(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n3 0 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n"
      "0 1 0\n0 0 1\n$EndNodes\n$Elements\n1 1 1 1\n3 0 4 1\n1 1 2 3 4\n$EndElements\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_THAT(mesh->tet_regions, IsEmpty());
  EXPECT_EQ(mesh->tet_count(), 1);
}

std::string MessageOf(absl::string_view bytes) {
  return std::string(ParseGmsh(bytes).status().message());
}
std::string With(absl::string_view from, absl::string_view to) {
  EXPECT_THAT(kAscii22, HasSubstr(std::string(from)));
  return absl::StrReplaceAll(kAscii22, {{from, to}});
}

TEST(Gmsh, NamesLineAndExpectation) {
  EXPECT_THAT(MessageOf(With("7 0 1 0", "7 0 one 0")),
              HasSubstr("line 17: expected a coordinate, found `one`"));
  EXPECT_THAT(MessageOf(With("3 7 8 100", "3 7 8 101")),
              HasSubstr("element 4 names node 101, which the file does not hold"));
  EXPECT_THAT(MessageOf(With("3 1 0 0", "10 1 0 0")), HasSubstr("two nodes have the number 10"));
  EXPECT_THAT(MessageOf(With("$EndNodes\n", "$EndNode\n")), HasSubstr("expected `$EndNodes`"));
  EXPECT_THAT(MessageOf(With("3 9 \"right\"", "3 9 right")), HasSubstr("double quotes"));
  EXPECT_THAT(MessageOf(With("3 4 2 5 1", "3 4 2 5000000000 1")), HasSubstr("31 bits"));
}

TEST(Gmsh, RefusesOtherElementsByName) {
  EXPECT_THAT(MessageOf(With("3 4 2 5", "3 11 2 5")),
              HasSubstr("element 3 is a 10-node tetrahedron"));
  EXPECT_THAT(MessageOf(With("3 4 2 5", "3 5 2 5")), HasSubstr("element 3 is a hexahedron"));
  EXPECT_THAT(MessageOf(With("3 4 2 5", "3 77 2 5")), HasSubstr("type 77"));
  EXPECT_THAT(MessageOf(absl::StrReplaceAll(kAscii41, {{"3 1 4 1\n", "3 1 6 1\n"}})),
              HasSubstr("volume 1 is a prism"));
}

TEST(Gmsh, RefusesOtherVersionsAndFilesWithoutTets) {
  EXPECT_THAT(MessageOf(With("2.2 0 8", "4.0 0 8")), HasSubstr("version 4.0"));
  EXPECT_THAT(MessageOf(With("2.2 0 8", "2.2 0 3")), HasSubstr("3 bytes"));
  EXPECT_THAT(MessageOf("$NOD\n1\n"), HasSubstr("expected `$MeshFormat`"));
  EXPECT_THAT(MessageOf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"), HasSubstr("no $Nodes section"));
  EXPECT_THAT(MessageOf("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n0\n$EndNodes\n$Elements\n0\n"
                        "$EndElements\n"),
              HasSubstr("holds no tetrahedra"));
}

TEST(Gmsh, BelievesNoCount) {
  for (const char* count : {"100000000000000", "9223372036854775807"}) {
    EXPECT_FALSE(ParseGmsh(With("$Nodes\n5", absl::StrCat("$Nodes\n", count))).ok());
    EXPECT_FALSE(ParseGmsh(With("$Elements\n4", absl::StrCat("$Elements\n", count))).ok());
    EXPECT_FALSE(
        ParseGmsh(With("$PhysicalNames\n3", absl::StrCat("$PhysicalNames\n", count))).ok());
  }
  // Every 8-byte number of a binary file in turn claims to be immense.
  const std::string binary = Binary41();
  for (size_t at = 0; at + 8 <= binary.size(); ++at) {
    std::string lying = binary;
    lying.replace(at, 8, std::string("\x00\xA0\x72\x4E\x18\x09\x00\x00", 8));
    ParseGmsh(lying).status().IgnoreError();
  }
}

TEST(Gmsh, RefusesFilesThatAreCutAnywhere) {
  for (const std::string& whole :
       {std::string(kAscii22), std::string(kAscii41), Binary22(), Binary41()}) {
    const size_t needed = whole.find("$EndElements") + 12;
    for (size_t size = 0; size < needed; ++size)
      EXPECT_FALSE(ParseGmsh(absl::string_view(whole).substr(0, size)).ok()) << size;
  }
}

}  // namespace
}  // namespace cleave
