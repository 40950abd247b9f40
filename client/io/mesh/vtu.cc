#include "client/io/mesh/vtu.h"

#include <pugixml.hpp>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/io/mesh/mesh_builder.h"
#include "client/io/mesh/vtk_cells.h"
#include "client/io/mesh/vtu_arrays.h"
#include "core/base/status.h"

namespace cleave {
namespace {

absl::Status In(absl::string_view place, const absl::Status& status) {
  if (status.ok()) return status;
  return absl::Status(status.code(), absl::StrCat(place, ": ", status.message()));
}

absl::StatusOr<uint64_t> CountOf(const pugi::xml_node& piece, const char* name) {
  const absl::string_view text = piece.attribute(name).value();
  uint64_t count = 0;
  if (!absl::SimpleAtoi(text, &count)) {
    return absl::InvalidArgumentError(
        absl::StrCat(name, "=\"", text.substr(0, 40), "\" is not a count"));
  }
  return count;
}

class VtuReader {
 public:
  explicit VtuReader(const VtuArrays& arrays) : arrays_(arrays), cells_(builder_) {}

  absl::StatusOr<TetMesh> Read(const pugi::xml_node& grid) {
    int64_t piece = 0;
    for (const pugi::xml_node& node : grid.children("Piece"))
      CLEAVE_RETURN_IF_ERROR(In(absl::StrCat("piece ", piece++), ReadPiece(node)));
    return builder_.Finish();
  }

 private:
  template <typename Value>
  absl::Status ReadCellArray(const pugi::xml_node& cells, const char* name, uint64_t count,
                             std::vector<Value>& values) {
    const pugi::xml_node array = cells.find_child_by_attribute("DataArray", "Name", name);
    if (!array) return absl::InvalidArgumentError(absl::StrCat("Cells has no array `", name, "`"));
    return In(name, arrays_.Read(array, count, values));
  }

  absl::Status ReadPiece(const pugi::xml_node& piece) {
    CLEAVE_ASSIGN_OR_RETURN(const uint64_t points, CountOf(piece, "NumberOfPoints"));
    CLEAVE_ASSIGN_OR_RETURN(const uint64_t cells, CountOf(piece, "NumberOfCells"));
    const int64_t first_point = builder_.node_count();
    const int64_t first_cell = cells_.cell_count();

    if (points > 0) {
      const pugi::xml_node array = piece.child("Points").child("DataArray");
      if (!array) return absl::InvalidArgumentError("Points has no array");
      const absl::string_view components = array.attribute("NumberOfComponents").value();
      if (components != "3") {
        return absl::InvalidArgumentError(
            absl::StrCat("Points: NumberOfComponents is `", components.substr(0, 40), "`, not 3"));
      }
      if (points > UINT64_MAX / 64)
        return absl::InvalidArgumentError(absl::StrCat("cannot hold ", points, " points"));
      std::vector<double> coordinates;
      CLEAVE_RETURN_IF_ERROR(In("Points", arrays_.Read(array, 3 * points, coordinates)));
      for (size_t i = 0; i < coordinates.size(); i += 3) {
        builder_.AddNode(builder_.node_count(),
                         {coordinates[i], coordinates[i + 1], coordinates[i + 2]});
      }
    }
    if (cells == 0) return absl::OkStatus();

    const pugi::xml_node lists = piece.child("Cells");
    std::vector<int64_t> offsets;
    std::vector<int64_t> types;
    std::vector<int64_t> connectivity;
    CLEAVE_RETURN_IF_ERROR(ReadCellArray(lists, "offsets", cells, offsets));
    CLEAVE_RETURN_IF_ERROR(ReadCellArray(lists, "types", cells, types));
    const int64_t size = offsets.back();
    if (size < 0) return absl::InvalidArgumentError(absl::StrCat("offsets: the last is ", size));
    CLEAVE_RETURN_IF_ERROR(
        ReadCellArray(lists, "connectivity", static_cast<uint64_t>(size), connectivity));
    int64_t begin = 0;
    for (size_t cell = 0; cell < offsets.size(); ++cell) {
      const int64_t end = offsets[cell];
      if (end < begin || end > size) {
        return absl::InvalidArgumentError(
            absl::StrCat("offsets: cell ", cell, " spans [", begin, ", ", end, ") of ", size));
      }
      const auto nodes = std::span(connectivity)
                             .subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin));
      for (const int64_t node : nodes) {
        if (node < 0 || static_cast<uint64_t>(node) >= points) {
          return absl::InvalidArgumentError(
              absl::StrCat("connectivity: cell ", cell, " names point ", node, " of ", points));
        }
      }
      CLEAVE_RETURN_IF_ERROR(cells_.Add(types[cell], nodes, first_point));
      begin = end;
    }

    for (const pugi::xml_node& array : piece.child("CellData").children("DataArray")) {
      const char* name = array.attribute("Name").value();
      const absl::string_view components = array.attribute("NumberOfComponents").value();
      if (!IsRegionArray(name) || !(components.empty() || components == "1")) continue;
      std::vector<double> regions;
      CLEAVE_RETURN_IF_ERROR(In(name, arrays_.Read(array, cells, regions)));
      for (size_t cell = 0; cell < regions.size(); ++cell) {
        CLEAVE_RETURN_IF_ERROR(
            cells_.SetRegion(first_cell + static_cast<int64_t>(cell), regions[cell]));
      }
      break;
    }
    return absl::OkStatus();
  }

  const VtuArrays& arrays_;
  MeshBuilder builder_;
  VtkCells cells_;
};

// Opens a file and calls read(grid, arrays) with its UnstructuredGrid.
template <typename Read>
auto WithGrid(absl::string_view bytes, const Read& read)
    -> decltype(read(pugi::xml_node(), std::declval<const VtuArrays&>())) {
  // Appended data need not be XML: the document is read without it.
  std::string xml(bytes);
  absl::string_view appended;
  const size_t tag = bytes.find("<AppendedData");
  if (tag != absl::string_view::npos) {
    const size_t close = bytes.find('>', tag);
    if (close == absl::string_view::npos)
      return absl::InvalidArgumentError(absl::StrCat("byte ", tag, ": AppendedData has no end"));
    const size_t underscore = bytes.find('_', close);
    if (underscore == absl::string_view::npos)
      return absl::InvalidArgumentError(absl::StrCat("byte ", close, ": expected `_` before data"));
    appended = bytes.substr(underscore + 1);
    xml = absl::StrCat(bytes.substr(0, close + 1), "</AppendedData></VTKFile>");
  }
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer_inplace(xml.data(), xml.size());
  if (!parsed) {
    return absl::InvalidArgumentError(
        absl::StrCat("byte ", parsed.offset, ": not well-formed XML: ", parsed.description()));
  }
  const pugi::xml_node file = document.child("VTKFile");
  const absl::string_view type = file.attribute("type").value();
  const pugi::xml_node grid = file.child("UnstructuredGrid");
  if (!grid || type != "UnstructuredGrid") {
    return absl::InvalidArgumentError(
        absl::StrCat("the file holds a VTK `", type.substr(0, 40),
                     "`; tetrahedra come in an UnstructuredGrid (.vtu, not .pvtu)"));
  }
  const absl::string_view encoding = file.child("AppendedData").attribute("encoding").value();
  if (encoding == "base64") {
    // What follows the data, at the latest the closing tag, is not Base64.
    appended = appended.substr(0, appended.find('<'));
  }
  CLEAVE_ASSIGN_OR_RETURN(const VtuArrays arrays,
                          VtuArrays::Of(file, appended, encoding != "base64"));
  return read(grid, arrays);
}

}  // namespace

absl::StatusOr<TetMesh> ParseVtu(absl::string_view bytes) {
  return WithGrid(bytes, [](const pugi::xml_node& grid, const VtuArrays& arrays) {
    return VtuReader(arrays).Read(grid);
  });
}

absl::StatusOr<std::vector<double>> ParseVtuPointArray(absl::string_view bytes,
                                                       const std::string& name) {
  using Result = absl::StatusOr<std::vector<double>>;
  return WithGrid(bytes, [&](const pugi::xml_node& grid, const VtuArrays& arrays) -> Result {
    std::vector<double> values;
    for (const pugi::xml_node& piece : grid.children("Piece")) {
      CLEAVE_ASSIGN_OR_RETURN(const uint64_t points, CountOf(piece, "NumberOfPoints"));
      if (points == 0) continue;
      std::vector<pugi::xml_node> found;
      std::vector<std::string> names;
      for (const pugi::xml_node& array : piece.child("PointData").children("DataArray")) {
        const absl::string_view components = array.attribute("NumberOfComponents").value();
        if (!components.empty() && components != "1") continue;
        names.emplace_back(array.attribute("Name").value());
        if (name.empty() || names.back() == name) found.push_back(array);
      }
      if (found.size() != 1) {
        return absl::InvalidArgumentError(absl::StrCat(
            name.empty() ? "no point array stands out: name one in `array`"
                         : absl::StrCat("points have no array \"", name, "\" of one component"),
            "; they have ", names.empty() ? "none" : absl::StrJoin(names, ", ")));
      }
      std::vector<double> part;
      CLEAVE_RETURN_IF_ERROR(
          In(found[0].attribute("Name").value(), arrays.Read(found[0], points, part)));
      values.insert(values.end(), part.begin(), part.end());
    }
    return values;
  });
}

}  // namespace cleave
