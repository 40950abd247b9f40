#ifndef CLEAVE_TESTS_UNIT_CLIENT_IO_MESH_SAMPLE_FILES_H_
#define CLEAVE_TESTS_UNIT_CLIENT_IO_MESH_SAMPLE_FILES_H_

#include <zlib.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"
#include "core/base/vec3.h"

// One small body in every format that is read: two tets on a common face, the first in region 5
// ("left part"), the second in region 9 ("right"), with things that readers pass over.

namespace cleave::samples {

// Node numbers with gaps and out of order, a triangle and a point.
inline constexpr char kGmsh22Ascii[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
    "$Comments\nfree text $Nodes\n$EndComments\n"
    "$PhysicalNames\n3\n2 5 \"skin\"\n3 5 \"left part\"\n3 9 \"right\"\n$EndPhysicalNames\n"
    "$Nodes\n5\n10 0 0 0\n3 1 0 0\n7 0 1 0\n8 0 0 1\n100 1 1 1.5e0\n$EndNodes\n"
    "$Elements\n4\n1 15 2 0 1 10\n2 2 2 5 1 10 3 7\n3 4 2 5 1 10 3 7 8\n4 4 3 9 2 0 3 7 8 100\n"
    "$EndElements\n";

inline constexpr char kGmsh41Ascii[] =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n2\n3 5 \"left part\"\n3 9 \"right\"\n$EndPhysicalNames\n"
    "$Entities\n1 0 1 2\n1 0 0 0 0\n1 0 0 0 1 1 1 1 5 0\n"
    "1 0 0 0 1 1 1 2 5 6 1 1\n2 0 0 0 1 1 1 1 -9 0\n$EndEntities\n"
    "$Nodes\n3 5 3 100\n2 1 1 3\n10\n3\n7\n0 0 0 0.5 0.5\n1 0 0 0.5 0.5\n0 1 0 0.5 0.5\n"
    "3 1 0 1\n8\n0 0 1\n3 2 0 1\n100\n1 1 1.5\n$EndNodes\n"
    "$Elements\n4 4 1 4\n0 1 15 1\n1 10\n2 1 2 1\n2 10 3 7\n3 1 4 1\n3 10 3 7 8\n"
    "3 2 4 1\n4 3 7 8 100\n$EndElements\n$NodeData\nwhatever\n$EndNodeData\n";

inline const std::vector<Vec3>& Positions() {
  static const auto* const kPositions =
      new std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1.5}};
  return *kPositions;
}

// Appends values to a file as they lie in memory, or with their bytes reversed.
class BinaryFile {
 public:
  explicit BinaryFile(bool flip = false) : flip_(flip) {}
  BinaryFile& Text(absl::string_view text) {
    bytes_.append(text.data(), text.size());
    return *this;
  }
  template <typename T>
  BinaryFile& Put(std::initializer_list<T> values) {
    for (const T value : values) {
      std::string raw;
      ByteWriter(raw).Put(value);
      if (flip_) std::reverse(raw.begin(), raw.end());
      bytes_ += raw;
    }
    return *this;
  }
  template <typename T>
  BinaryFile& PutPositions() {
    for (const Vec3& p : Positions())
      Put<T>({static_cast<T>(p[0]), static_cast<T>(p[1]), static_cast<T>(p[2])});
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  bool flip_;
  std::string bytes_;
};

inline std::string Gmsh22Binary() {
  BinaryFile file;
  file.Text("$MeshFormat\n2.2 1 8\n").Put<int32_t>({1}).Text("\n$EndMeshFormat\n");
  file.Text("$PhysicalNames\n2\n3 5 \"left part\"\n3 9 \"right\"\n$EndPhysicalNames\n$Nodes\n5\n");
  const int32_t numbers[] = {10, 3, 7, 8, 100};
  for (size_t i = 0; i < 5; ++i) {
    const Vec3& p = Positions()[i];
    file.Put<int32_t>({numbers[i]}).Put<double>({p[0], p[1], p[2]});
  }
  file.Text("\n$EndNodes\n$Elements\n3\n");
  file.Put<int32_t>({2, 1, 2, 2, 5, 1, 10, 3, 7});
  file.Put<int32_t>({4, 2, 2, 3, 5, 1, 10, 3, 7, 8, 4, 9, 2, 3, 7, 8, 100});
  return file.Text("\n$EndElements\n").bytes();
}

inline std::string Gmsh41Binary(bool flip = false) {
  BinaryFile file(flip);
  file.Text("$MeshFormat\n4.1 1 8\n").Put<int32_t>({1}).Text("\n$EndMeshFormat\n");
  file.Text("$PhysicalNames\n2\n3 5 \"left part\"\n3 9 \"right\"\n$EndPhysicalNames\n$Entities\n");
  file.Put<uint64_t>({0, 0, 0, 2});
  for (const int32_t volume : {1, 2}) {
    file.Put<int32_t>({volume}).Put<double>({0, 0, 0, 1, 1, 1}).Put<uint64_t>({1});
    file.Put<int32_t>({volume == 1 ? 5 : 9}).Put<uint64_t>({2}).Put<int32_t>({1, -2});
  }
  file.Text("\n$EndEntities\n$Nodes\n").Put<uint64_t>({2, 5, 3, 100});
  file.Put<int32_t>({3, 1, 0}).Put<uint64_t>({4, 10, 3, 7, 8});
  file.Put<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});
  file.Put<int32_t>({3, 2, 0}).Put<uint64_t>({1, 100}).Put<double>({1, 1, 1.5});
  file.Text("\n$EndNodes\n$Elements\n").Put<uint64_t>({2, 2, 3, 4});
  file.Put<int32_t>({3, 1, 4}).Put<uint64_t>({1, 3, 10, 3, 7, 8});
  file.Put<int32_t>({3, 2, 4}).Put<uint64_t>({1, 4, 3, 7, 8, 100});
  return file.Text("\n$EndElements\n").bytes();
}

inline constexpr char kVtkAscii[] =
    "# vtk DataFile Version 3.0\na title\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    "FIELD FieldData 1\nTIME 1 1 double\n0.5\n"
    "POINTS 5 double\n0 0 0 1 0 0 0 1 0\n0 0 1 1 1 1.5\n"
    "CELLS 3 14\n3 0 1 2\n4 0 1 2 3\n4 1 2 3 4\nCELL_TYPES 3\n5 10 10\n"
    "CELL_DATA 3\nSCALARS quality float 1\nLOOKUP_TABLE default\n0.5 0.5 0.25\n"
    "SCALARS material int\nLOOKUP_TABLE default\n0 5 9\n"
    "POINT_DATA 5\nVECTORS velocity float\n0 0 0 0 0 0 0 0 0 0 0 0 0 0 0\n"
    "COLOR_SCALARS whatever 1\n";

inline std::string VtkBinary() {
  BinaryFile file(true);
  file.Text("# vtk DataFile Version 3.0\na title\nBINARY\nDATASET UNSTRUCTURED_GRID\n");
  file.Text("POINTS 5 float\n").PutPositions<float>().Text("\nCELLS 3 14\n");
  file.Put<int32_t>({3, 0, 1, 2, 4, 0, 1, 2, 3, 4, 1, 2, 3, 4}).Text("\nCELL_TYPES 3\n");
  file.Put<int32_t>({5, 10, 10}).Text("\nCELL_DATA 3\nFIELD FieldData 2\nquality 2 3 double\n");
  file.Put<double>({1, 2, 3, 4, 5, 6}).Text("\nregion 1 3 short\n").Put<int16_t>({0, 5, 9});
  return file.Text("\n").bytes();
}

inline std::string VtkVersion5() {
  BinaryFile file(true);
  file.Text("# vtk DataFile Version 5.1\na title\nBINARY\nDATASET UNSTRUCTURED_GRID\n");
  file.Text("POINTS 5 double\n")
      .PutPositions<double>()
      .Text("\nCELLS 4 11\nOFFSETS vtktypeint64\n");
  file.Put<int64_t>({0, 3, 7, 11}).Text("\nCONNECTIVITY vtktypeint64\n");
  file.Put<int64_t>({0, 1, 2, 0, 1, 2, 3, 1, 2, 3, 4}).Text("\nCELL_TYPES 3\n");
  file.Put<int32_t>({5, 10, 10}).Text("\nCELL_DATA 3\nSCALARS material vtkIdType\n");
  file.Text("LOOKUP_TABLE default\n").Put<int32_t>({0, 5, 9});
  return file.Text("\nMETADATA\nINFORMATION 0\n\n").bytes();
}

enum class VtuFormat { kAscii, kInline, kAppendedRaw, kAppendedBase64 };

// A .vtu of two pieces, the second empty.
inline std::string Vtu(VtuFormat format, bool zlib = false, bool wide = false, bool flip = false) {
  std::string appended;
  const auto word = [&](uint64_t value) {
    BinaryFile file(flip);
    wide ? file.Put<uint64_t>({value}) : file.Put<uint32_t>({static_cast<uint32_t>(value)});
    return file.bytes();
  };
  // The stored form of an array's bytes: its header and its data.
  const auto stored = [&](const std::string& data) -> std::pair<std::string, std::string> {
    if (!zlib) return {word(data.size()), data};
    constexpr size_t kBlock = 40;
    std::string sizes;
    std::string packed;
    const size_t blocks = (data.size() + kBlock - 1) / kBlock;
    for (size_t block = 0; block < blocks; ++block) {
      const std::string piece = data.substr(block * kBlock, kBlock);
      uLongf size = compressBound(piece.size());
      std::string out(size, '\0');
      compress(reinterpret_cast<Bytef*>(out.data()), &size,
               reinterpret_cast<const Bytef*>(piece.data()), piece.size());
      packed += out.substr(0, size);
      sizes += word(size);
    }
    return {absl::StrCat(word(blocks), word(kBlock), word(data.size() % kBlock), sizes), packed};
  };
  const auto array = [&](absl::string_view attributes, absl::string_view text,
                         const std::string& data) {
    const std::string open = absl::StrCat("<DataArray ", attributes, " format=\"");
    if (format == VtuFormat::kAscii)
      return absl::StrCat(open, "ascii\">\n", text, "\n</DataArray>\n");
    const auto [header, body] = stored(data);
    const std::string encoded = absl::StrCat(absl::Base64Escape(header), absl::Base64Escape(body));
    if (format == VtuFormat::kInline)
      return absl::StrCat(open, "binary\">\n  ", encoded, "\n</DataArray>\n");
    const std::string element =
        absl::StrCat(open, "appended\" offset=\"", appended.size(), "\"/>\n");
    appended += format == VtuFormat::kAppendedRaw ? header + body : encoded;
    return element;
  };
  const auto numbers = [&](absl::string_view name, const std::vector<int64_t>& values, bool bytes) {
    BinaryFile file(flip);
    std::string text;
    for (const int64_t value : values) {
      bytes ? file.Put<uint8_t>({static_cast<uint8_t>(value)}) : file.Put<int64_t>({value});
      absl::StrAppend(&text, value, " ");
    }
    return array(absl::StrCat("type=\"", bytes ? "UInt8" : "Int64", "\" Name=\"", name, "\""), text,
                 file.bytes());
  };
  const auto points = [&](size_t begin, size_t end) {
    BinaryFile file(flip);
    std::string text;
    for (size_t i = begin; i < end; ++i) {
      for (const double x : Positions()[i]) {
        file.Put<float>({static_cast<float>(x)});
        absl::StrAppend(&text, x, " ");
      }
    }
    return array("type=\"Float32\" Name=\"Points\" NumberOfComponents=\"3\"", text, file.bytes());
  };
  std::string xml = absl::StrCat(
      "<?xml version=\"1.0\"?>\n<!-- a > b -->\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
      "byte_order=\"",
      flip ? "BigEndian" : "LittleEndian", "\" header_type=\"", wide ? "UInt64" : "UInt32", "\"",
      zlib ? " compressor=\"vtkZLibDataCompressor\"" : "", ">\n<UnstructuredGrid>\n");
  absl::StrAppend(&xml, "<Piece NumberOfPoints=\"5\" NumberOfCells=\"3\">\n<CellData>\n",
                  numbers("RegionId", {0, 5, 9}, false), "</CellData>\n<Points>\n", points(0, 5),
                  "</Points>\n<Cells>\n",
                  numbers("connectivity", {0, 1, 2, 0, 1, 2, 3, 1, 2, 3, 4}, false),
                  numbers("offsets", {3, 7, 11}, false), numbers("types", {5, 10, 10}, true),
                  "</Cells>\n</Piece>\n<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\"/>\n",
                  "</UnstructuredGrid>\n");
  if (format == VtuFormat::kAppendedRaw || format == VtuFormat::kAppendedBase64) {
    absl::StrAppend(&xml, "<AppendedData encoding=\"",
                    format == VtuFormat::kAppendedRaw ? "raw" : "base64", "\">\n _", appended,
                    "\n</AppendedData>\n");
  }
  return absl::StrCat(xml, "</VTKFile>\n");
}

inline constexpr char kTetGenNode[] =
    "# made by hand\n5 3 1 1\n\n1 0 0 0  0.5 0\n2 1 0 0 0.5 1\n3 0 1 0 0.5 1 # corner\n"
    "4 0 0 1 0.5 0\n5 1 1 1.5 0.5 0\n# end\n";
inline constexpr char kTetGenEle[] = "2  4  1\n  1  1 2 3 4  5\n  2  2 3 4 5  9\n# end\n";

inline constexpr char kMeditText[] =
    "MeshVersionFormatted 2\n\nDimension\n3\n# a note\nVertices\n5\n0 0 0 1\n1 0 0 1\n0 1 0 1\n"
    "0 0 1 1\n1 1 1.5 1\nCorners\n2\n1\n2\nTriangles\n1\n1 2 3 7\nNormals 1\n0.0 -1 .5\n"
    "Tetrahedra\n2\n1 2 3 4 5\n2 3 4 5 9\nEnd\n";

inline std::string MeditBinary(int32_t version, bool flip = false) {
  BinaryFile file(flip);
  file.Put<int32_t>({1, version});
  // Each list: its code, where the next starts, its content.
  const auto list = [&](int32_t code, const std::string& content) {
    file.Put<int32_t>({code});
    const size_t next = file.bytes().size() + (version >= 3 ? 8 : 4) + content.size();
    version >= 3 ? file.Put<int64_t>({static_cast<int64_t>(next)})
                 : file.Put<int32_t>({static_cast<int32_t>(next)});
    file.Text(content);
  };
  BinaryFile dimension(flip);
  list(3, dimension.Put<int32_t>({3}).bytes());
  const auto integers = [&](BinaryFile& out, std::initializer_list<int32_t> values) {
    for (const int32_t value : values)
      version >= 4 ? out.Put<int64_t>({value}) : out.Put<int32_t>({value});
  };
  BinaryFile vertices(flip);
  integers(vertices, {5});
  for (const Vec3& p : Positions()) {
    for (const double x : p)
      version == 1 ? vertices.Put<float>({static_cast<float>(x)}) : vertices.Put<double>({x});
    integers(vertices, {1});
  }
  list(4, vertices.bytes());
  BinaryFile triangles(flip);
  integers(triangles, {1, 1, 2, 3, 7});
  list(6, triangles.bytes());
  BinaryFile tets(flip);
  integers(tets, {2, 1, 2, 3, 4, 5, 2, 3, 4, 5, 9});
  list(8, tets.bytes());
  file.Put<int32_t>({54});
  version >= 3 ? file.Put<int64_t>({0}) : file.Put<int32_t>({0});
  return file.bytes();
}

inline constexpr char kVega[] =
    "# Vega mesh file.\n*VERTICES\n5 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n5 1 1 1.5\n\n"
    "*ELEMENTS\nTET\n2 4 0\n1 1 2 3 4\n2 2 3 4 5\n\n*MATERIAL BODY\nENU, 1000, 10000000, 0.45\n\n"
    "*SET right\n2\n*SET unused\n1, 2,\n*REGION\nallElements, BODY\n*REGION\nright, BODY\n";

// A name and the bytes of every sample but TetGen's pair.
inline std::vector<std::pair<std::string, std::string>> All() {
  std::vector<std::pair<std::string, std::string>> all = {{"gmsh22ascii.msh", kGmsh22Ascii},
                                                          {"gmsh22binary.msh", Gmsh22Binary()},
                                                          {"gmsh41ascii.msh", kGmsh41Ascii},
                                                          {"gmsh41binary.msh", Gmsh41Binary()},
                                                          {"gmsh41big.msh", Gmsh41Binary(true)},
                                                          {"ascii.vtk", kVtkAscii},
                                                          {"binary.vtk", VtkBinary()},
                                                          {"version5.vtk", VtkVersion5()},
                                                          {"text.mesh", kMeditText},
                                                          {"vega.veg", kVega}};
  for (const int32_t version : {1, 2, 3, 4}) {
    all.push_back({absl::StrCat("version", version, ".meshb"), MeditBinary(version)});
    all.push_back({absl::StrCat("version", version, "big.meshb"), MeditBinary(version, true)});
  }
  for (const VtuFormat format : {VtuFormat::kAscii, VtuFormat::kInline, VtuFormat::kAppendedRaw,
                                 VtuFormat::kAppendedBase64}) {
    const std::string name = absl::StrCat("format", static_cast<int>(format));
    all.push_back({absl::StrCat(name, ".vtu"), Vtu(format)});
    if (format == VtuFormat::kAscii) continue;
    all.push_back({absl::StrCat(name, "zlib.vtu"), Vtu(format, true)});
    all.push_back({absl::StrCat(name, "wide.vtu"), Vtu(format, true, true)});
    all.push_back({absl::StrCat(name, "big.vtu"), Vtu(format, false, false, true)});
  }
  return all;
}

}  // namespace cleave::samples

#endif  // CLEAVE_TESTS_UNIT_CLIENT_IO_MESH_SAMPLE_FILES_H_
