#include "client/io/mesh/gmsh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "tests/unit/client/io/mesh/sample_files.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::string MessageOf(absl::string_view bytes) {
  return std::string(ParseGmsh(bytes).status().message());
}
std::string With(absl::string_view from, absl::string_view to) {
  EXPECT_THAT(samples::kGmsh22Ascii, HasSubstr(std::string(from)));
  return absl::StrReplaceAll(samples::kGmsh22Ascii, {{from, to}});
}

TEST(Gmsh, WithoutPhysicalGroupsHasNoRegions) {
  const absl::StatusOr<TetMesh> mesh = ParseGmsh(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 4 1 4\n3 0 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n"
      "0 1 0\n0 0 1\n$EndNodes\n$Elements\n1 1 1 1\n3 0 4 1\n1 1 2 3 4\n$EndElements\n");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_THAT(mesh->tet_regions, IsEmpty());
  EXPECT_EQ(mesh->tet_count(), 1);
}

TEST(Gmsh, PhysicalVolumesNameRegions) {
  for (const std::string& file : {std::string(samples::kGmsh22Ascii), samples::Gmsh41Binary()}) {
    const absl::StatusOr<TetMesh> mesh = ParseGmsh(file);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    ASSERT_EQ(mesh->regions.size(), 2u);
    EXPECT_EQ(mesh->regions[0].id, 5);
    EXPECT_EQ(mesh->regions[0].name, "left part");
    EXPECT_EQ(mesh->regions[1].id, 9);
    EXPECT_EQ(mesh->regions[1].name, "right");
  }
}

TEST(Gmsh, ReadsLineEndsOfOtherSystems) {
  EXPECT_TRUE(ParseGmsh(absl::StrReplaceAll(samples::kGmsh22Ascii, {{"\n", "\r\n"}})).ok());
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
  EXPECT_THAT(MessageOf(absl::StrReplaceAll(samples::kGmsh41Ascii, {{"3 1 4 1\n", "3 1 6 1\n"}})),
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
}

}  // namespace
}  // namespace cleave
