#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/match.h"
#include "absl/strings/str_replace.h"
#include "client/io/mesh/medit.h"
#include "client/io/mesh/mesh_file.h"
#include "client/io/mesh/tetgen.h"
#include "client/io/mesh/vega.h"
#include "client/io/mesh/vtk_legacy.h"
#include "client/io/mesh/vtu.h"
#include "client/io/mesh/vtu_arrays.h"
#include "tests/unit/client/io/mesh/sample_files.h"

namespace cleave {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

void ExpectTheTwoTets(const absl::StatusOr<TetMesh>& mesh, int32_t left = 5, int32_t right = 9) {
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->rest_positions, samples::Positions());
  EXPECT_THAT(mesh->tets,
              ElementsAre(std::array<int32_t, 4>{0, 1, 2, 3}, std::array<int32_t, 4>{1, 2, 3, 4}));
  EXPECT_THAT(mesh->tet_regions, ElementsAre(left, right));
}

std::string MessageOf(const absl::StatusOr<TetMesh>& mesh) {
  EXPECT_FALSE(mesh.ok());
  return std::string(mesh.status().message());
}

std::string With(absl::string_view file, absl::string_view from, absl::string_view to) {
  EXPECT_TRUE(absl::StrContains(file, from)) << from;
  return absl::StrReplaceAll(file, {{from, to}});
}

TEST(EveryFormat, TellsTheSameBody) {
  for (const auto& [name, bytes] : samples::All()) {
    SCOPED_TRACE(name);
    const bool vega = absl::EndsWith(name, ".veg");  // numbers regions itself
    ExpectTheTwoTets(ParseMeshFile(bytes, name), vega ? 1 : 5, vega ? 2 : 9);
    // The content alone tells the format.
    EXPECT_TRUE(ParseMeshFile(bytes, "noname").ok());
  }
  ExpectTheTwoTets(ParseTetGen(samples::kTetGenNode, samples::kTetGenEle));
}

// A file cut anywhere is refused, or holds the whole body where only what is passed over was lost.
TEST(EveryFormat, IsRefusedOrWholeWhenCutAnywhere) {
  for (const auto& [name, bytes] : samples::All()) {
    SCOPED_TRACE(name);
    size_t refused = 0;
    for (size_t size = 0; size < bytes.size(); ++size) {
      const absl::StatusOr<TetMesh> mesh =
          ParseMeshFile(absl::string_view(bytes).substr(0, size), name);
      refused += mesh.ok() ? 0 : 1;
      if (!mesh.ok()) {
        EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << mesh.status();
        continue;
      }
      EXPECT_EQ(mesh->node_count(), 5);
    }
    EXPECT_GT(refused, bytes.size() / 2);
  }
  const absl::string_view node = samples::kTetGenNode;
  const absl::string_view ele = samples::kTetGenEle;
  for (size_t size = 0; size < node.find("0.5 0\n# end"); ++size)
    EXPECT_FALSE(ParseTetGen(node.substr(0, size), ele).ok()) << size;
  for (size_t size = 0; size < ele.find("9\n# end"); ++size)
    EXPECT_FALSE(ParseTetGen(node, ele.substr(0, size)).ok()) << size;
}

// Each place that a number could stand at claims to be immense in turn.
TEST(EveryFormat, BelievesNoNumber) {
  for (const auto& [name, bytes] : samples::All()) {
    SCOPED_TRACE(name);
    for (const size_t width : {4, 8}) {
      for (const char* immense :
           {"\x7F\xFF\xFF\xFF\xFF\xFF\xFF\xFF", "\xFF\xFF\xFF\x7F\xFF\xFF\xFF\x7F",
            "\x00\x00\xA0\x72\x4E\x18\x09\x00"}) {
        for (size_t at = 0; at + width <= bytes.size(); ++at) {
          std::string lying = bytes;
          lying.replace(at, width, immense, width);
          ParseMeshFile(lying, name).status().IgnoreError();
        }
      }
    }
    for (size_t at = 0; at < bytes.size(); ++at) {
      if (bytes[at] < '0' || bytes[at] > '9') continue;
      std::string lying = bytes;
      lying.replace(at, 1, "100000000000000");
      ParseMeshFile(lying, name).status().IgnoreError();
    }
  }
}

TEST(VtkLegacy, SaysWhatIsWrong) {
  const auto message = [](absl::string_view from, absl::string_view to) {
    return MessageOf(ParseVtkLegacy(With(samples::kVtkAscii, from, to)));
  };
  EXPECT_THAT(message("UNSTRUCTURED_GRID", "POLYDATA"), HasSubstr("the dataset is POLYDATA"));
  EXPECT_THAT(message("5 10 10", "5 12 10"), HasSubstr("cell 1 is a hexahedron"));
  EXPECT_THAT(message("5 10 10", "5 24 10"), HasSubstr("10-node tetrahedron"));
  EXPECT_THAT(message("5 10 10", "5 99 10"), HasSubstr("VTK type 99"));
  EXPECT_THAT(message("CELL_TYPES 3\n5 10 10", "CELL_TYPES 2\n5 10"),
              HasSubstr("2 cell types for 3 cells"));
  EXPECT_THAT(message("4 1 2 3 4", "4 1 2 3 5"), HasSubstr("names node 5"));
  EXPECT_THAT(message("0 5 9", "0 5.5 9"), HasSubstr("region of cell 1 is 5.5"));
  EXPECT_THAT(message("POINTS 5", "POINTS 6"), HasSubstr("line 11: expected a coordinate"));
}

TEST(Vtu, SaysWhatIsWrong) {
  const std::string ascii = samples::Vtu(samples::VtuFormat::kAscii);
  const auto message = [&](absl::string_view from, absl::string_view to) {
    return MessageOf(ParseVtu(With(ascii, from, to)));
  };
  EXPECT_THAT(message("</Cells>", "</Cell>"), HasSubstr("not well-formed XML"));
  EXPECT_THAT(message("\"UnstructuredGrid\"", "\"PolyData\""), HasSubstr("`PolyData`"));
  EXPECT_THAT(message("NumberOfPoints=\"5\"", "NumberOfPoints=\"100000000000000\""),
              HasSubstr("piece 0: Points: cannot hold"));
  EXPECT_THAT(message("NumberOfPoints=\"5\"", "NumberOfPoints=\"6\""),
              HasSubstr("piece 0: Points: expected 18 values, found 15"));
  EXPECT_THAT(message("Name=\"offsets\"", "Name=\"ends\""), HasSubstr("no array `offsets`"));
  EXPECT_THAT(message("5 10 10", "5 14 10"), HasSubstr("cell 1 is a pyramid"));
  EXPECT_THAT(message("1 2 3 4 ", "1 2 3 5 "), HasSubstr("names point 5 of 5"));
  EXPECT_THAT(message("format=\"ascii\"", "format=\"hdf\""), HasSubstr("format `hdf`"));
  EXPECT_THAT(MessageOf(ParseVtu(
                  With(samples::Vtu(samples::VtuFormat::kInline, true), "vtkZLib", "vtkLZ4"))),
              HasSubstr("vtkLZ4DataCompressor"));
}

TEST(Vtu, PutsPiecesOneAfterTheOther) {
  const std::string one = samples::Vtu(samples::VtuFormat::kAscii);
  const size_t begin = one.find("<Piece NumberOfPoints=\"5\"");
  const size_t end = one.find("<Piece NumberOfPoints=\"0\"");
  std::string two = one;
  two.insert(end, one.substr(begin, end - begin));
  const absl::StatusOr<TetMesh> mesh = ParseVtu(two);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->node_count(), 10);
  EXPECT_THAT(mesh->tets,
              ElementsAre(std::array<int32_t, 4>{0, 1, 2, 3}, std::array<int32_t, 4>{1, 2, 3, 4},
                          std::array<int32_t, 4>{5, 6, 7, 8}, std::array<int32_t, 4>{6, 7, 8, 9}));
  EXPECT_THAT(mesh->tet_regions, ElementsAre(5, 9, 5, 9));
}

TEST(Vtu, InflatesNoMoreThanDeflateCouldPack) {
  // One block of a few bytes that claims to unpack to a gigabyte.
  samples::BinaryFile header;
  header.Put<uint32_t>({1, 1u << 30, 0, 8}).Text("12345678");
  const std::string xml = absl::StrCat(
      "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkZLibDataCompressor\"><UnstructuredGrid>"
      "<Piece NumberOfPoints=\"89478485\" NumberOfCells=\"0\"><Points><DataArray type=\"Float32\" "
      "NumberOfComponents=\"3\" format=\"binary\">",
      absl::Base64Escape(header.bytes()),
      "</DataArray></Points></Piece></UnstructuredGrid></VTKFile>");
  EXPECT_THAT(MessageOf(ParseVtu(xml)), HasSubstr("block 0 of 8 bytes claims to unpack to"));
}

TEST(DecodeBase64, TakesPaddingBetweenParts) {
  EXPECT_EQ(DecodeBase64("QQ==QkM=\n REVG", 100).value(), "ABCDEF");
  EXPECT_EQ(DecodeBase64("QUJDREVG", 4).value(), "ABCD");
  EXPECT_FALSE(DecodeBase64("QQ=A", 100).ok());
  EXPECT_FALSE(DecodeBase64("Q?==", 100).ok());
  EXPECT_FALSE(DecodeBase64("QUJ", 100).ok());
  EXPECT_FALSE(DecodeBase64("====", 100).ok());
}

TEST(TetGen, SaysWhichFileIsWrong) {
  EXPECT_THAT(MessageOf(ParseTetGen("5 2 0 0\n", samples::kTetGenEle)),
              HasSubstr(".node file, line 1: the dimension is 2"));
  EXPECT_THAT(MessageOf(ParseTetGen(samples::kTetGenNode, "1 10 0\n1 1 2 3 4 5 6 7 8 9 10\n")),
              HasSubstr("10-node tetrahedron"));
  EXPECT_THAT(MessageOf(ParseTetGen(samples::kTetGenNode, "1 4 0\n1 1 2 x 4\n")),
              HasSubstr(".ele file, line 2: expected a node of a tetrahedron, found `x`"));
  EXPECT_THAT(MessageOf(ParseTetGen(samples::kTetGenNode, "1 4 0\n1 0 1 2 3\n")),
              HasSubstr("element 1 names node 0"));
}

TEST(Medit, SaysWhatIsWrong) {
  const auto message = [](absl::string_view from, absl::string_view to) {
    return MessageOf(ParseMeditText(With(samples::kMeditText, from, to)));
  };
  EXPECT_THAT(message("Dimension\n3", "Dimension\n2"), HasSubstr("the dimension is 2"));
  EXPECT_THAT(message("Triangles\n1\n1 2 3 7", "Hexahedra\n1\n1 2 3 4 5 1 2 3 0"),
              HasSubstr("hexahedron"));
  EXPECT_THAT(message("Tetrahedra\n2\n", "Tetrahedra\n3\n"), HasSubstr("found `End`"));
  EXPECT_THAT(MessageOf(ParseMeditBinary("not one")), HasSubstr("byte 0"));
  std::string backwards = samples::MeditBinary(2);
  backwards[12] = 1;  // the first list's next
  EXPECT_THAT(MessageOf(ParseMeditBinary(backwards)), HasSubstr("behind"));
}

TEST(Vega, SaysWhatIsWrong) {
  const auto message = [](absl::string_view from, absl::string_view to) {
    return MessageOf(ParseVega(With(samples::kVega, from, to)));
  };
  EXPECT_THAT(message("TET\n2 4 0", "CUBIC\n2 8 0"), HasSubstr("hexahedron"));
  EXPECT_THAT(message("*SET right\n2", "*SET right\n3"), HasSubstr("names element 3"));
  EXPECT_THAT(message("*REGION\nright", "*REGION\nwrong"), HasSubstr("set `wrong`"));
  EXPECT_THAT(message("*MATERIAL BODY", "*INCLUDE other.veg"), HasSubstr("*INCLUDE"));
  EXPECT_THAT(message("5 1 1 1.5", "5 1 1 high"), HasSubstr("line 8: expected a coordinate"));
}

}  // namespace
}  // namespace cleave
