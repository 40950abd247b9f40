#include "client/io/mesh/vtk_legacy.h"

#include <bit>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/io/mesh/mesh_builder.h"
#include "client/io/mesh/scanner.h"
#include "client/io/mesh/vtk_cells.h"
#include "core/base/status.h"

namespace cleave {
namespace {

class VtkLegacyReader {
 public:
  explicit VtkLegacyReader(absl::string_view bytes) : scan_(bytes), cells_(builder_) {}

  absl::StatusOr<TetMesh> Read() {
    CLEAVE_RETURN_IF_ERROR(ReadHeader());
    while (scan_.ok() && !scan_.AtEnd()) {
      const std::string keyword = absl::AsciiStrToUpper(scan_.Token("a keyword"));
      if (keyword == "POINTS") {
        ReadPoints();
      } else if (keyword == "CELLS") {
        offsets_format_ ? ReadOffsets() : ReadCells();
      } else if (keyword == "CELL_TYPES") {
        ReadTypes();
      } else if (keyword == "FIELD") {
        CLEAVE_RETURN_IF_ERROR(ReadField(false));
      } else if (keyword == "METADATA") {
        SkipMetadata();
      } else if (keyword == "CELL_DATA" || keyword == "POINT_DATA") {
        CLEAVE_RETURN_IF_ERROR(AddCells());
        CLEAVE_RETURN_IF_ERROR(ReadAttributes(keyword == "CELL_DATA"));
        break;
      } else {
        scan_.Fail(absl::StrCat("`", keyword.substr(0, 40), "` is not a keyword of a mesh"));
      }
    }
    CLEAVE_RETURN_IF_ERROR(scan_.status());
    CLEAVE_RETURN_IF_ERROR(AddCells());
    return builder_.Finish();
  }

 private:
  absl::Status ReadHeader() {
    const absl::string_view first = scan_.RestOfLine();
    constexpr absl::string_view kStart = "# vtk DataFile Version ";
    if (!absl::StartsWith(first, kStart)) scan_.Fail(absl::StrCat("expected `", kStart, "`"));
    const absl::string_view version = first.substr(std::min(first.size(), kStart.size()));
    offsets_format_ = absl::StartsWith(version, "5");
    scan_.RestOfLine();  // title
    const std::string kind = absl::AsciiStrToUpper(scan_.Token("ASCII or BINARY"));
    if (scan_.ok() && kind != "ASCII" && kind != "BINARY") scan_.Fail("expected ASCII or BINARY");
    binary_ = kind == "BINARY";
    scan_.SetSwapped(std::endian::native == std::endian::little);  // the files are big-endian
    scan_.Expect("DATASET");
    const absl::string_view dataset = scan_.Token("a kind of dataset");
    if (scan_.ok() && !absl::EqualsIgnoreCase(dataset, "UNSTRUCTURED_GRID")) {
      scan_.Fail(absl::StrCat("the dataset is ", dataset.substr(0, 40),
                              "; only UNSTRUCTURED_GRID holds tetrahedra"));
    }
    return scan_.status();
  }

  // One value of the named type, as a double or as an integer.
  template <typename Value>
  Value Get(absl::string_view type, absl::string_view what) {
    if (!binary_) {
      if constexpr (std::is_floating_point_v<Value>) {
        return scan_.Number(what);
      } else {
        return scan_.Integer(what);
      }
    }
    if (type == "double") return static_cast<Value>(scan_.Binary<double>(what));
    if (type == "float") return static_cast<Value>(scan_.Binary<float>(what));
    if (type == "int" || type == "vtkidtype" || type == "vtktypeint32")
      return static_cast<Value>(scan_.Binary<int32_t>(what));
    if (type == "unsigned_int" || type == "vtktypeuint32")
      return static_cast<Value>(scan_.Binary<uint32_t>(what));
    if (type == "long" || type == "vtktypeint64" || type == "long_long")
      return static_cast<Value>(scan_.Binary<int64_t>(what));
    if (type == "unsigned_long" || type == "vtktypeuint64")
      return static_cast<Value>(scan_.Binary<uint64_t>(what));
    if (type == "short" || type == "vtktypeint16")
      return static_cast<Value>(scan_.Binary<int16_t>(what));
    if (type == "unsigned_short" || type == "vtktypeuint16")
      return static_cast<Value>(scan_.Binary<uint16_t>(what));
    if (type == "char" || type == "vtktypeint8")
      return static_cast<Value>(scan_.Binary<int8_t>(what));
    if (type == "unsigned_char" || type == "vtktypeuint8")
      return static_cast<Value>(scan_.Binary<uint8_t>(what));
    scan_.FailAtByte(absl::StrCat("values of type ", type.substr(0, 40), " cannot be read"));
    return Value{};
  }

  std::string Type() { return absl::AsciiStrToLower(scan_.Token("a type of values")); }

  // Ends the line before the data of a binary file.
  void StartData() {
    if (binary_) scan_.RestOfLine();
  }

  void ReadPoints() {
    const int64_t count = scan_.Count("the number of points");
    const std::string type = Type();
    StartData();
    for (int64_t point = 0; point < count && scan_.ok(); ++point) {
      Vec3 position;
      for (double& coordinate : position) coordinate = Get<double>(type, "a coordinate");
      if (scan_.ok()) builder_.AddNode(point, position);
    }
  }

  // Version 2 to 4: for each cell the number of its points, then the points.
  void ReadCells() {
    const int64_t count = scan_.Count("the number of cells");
    const int64_t size = scan_.Count("the length of the cell list");
    StartData();
    offsets_.assign(1, 0);
    for (int64_t cell = 0; cell < count && scan_.ok(); ++cell) {
      const auto points = Get<int64_t>("int", "the number of points of a cell");
      if (points < 0 || points > size) {
        scan_.Fail(absl::StrCat("cell ", cell, " claims ", points, " points"));
        return;
      }
      for (int64_t k = 0; k < points && scan_.ok(); ++k)
        connectivity_.push_back(Get<int64_t>("int", "a point of a cell"));
      offsets_.push_back(static_cast<int64_t>(connectivity_.size()));
    }
  }

  // Version 5: where each cell ends, then the points of all.
  void ReadOffsets() {
    const int64_t offsets = scan_.Count("the number of offsets");
    const int64_t points = scan_.Count("the length of the connectivity");
    scan_.Expect("OFFSETS");
    std::string type = Type();
    StartData();
    offsets_.clear();
    for (int64_t i = 0; i < offsets && scan_.ok(); ++i)
      offsets_.push_back(Get<int64_t>(type, "an offset"));
    scan_.Expect("CONNECTIVITY");
    type = Type();
    StartData();
    for (int64_t i = 0; i < points && scan_.ok(); ++i)
      connectivity_.push_back(Get<int64_t>(type, "a point of a cell"));
  }

  void ReadTypes() {
    const int64_t count = scan_.Count("the number of cell types");
    StartData();
    for (int64_t cell = 0; cell < count && scan_.ok(); ++cell)
      types_.push_back(Get<int64_t>("int", "a cell type"));
  }

  // Hands the cells to the builder; they are complete only before attributes or the end.
  absl::Status AddCells() {
    CLEAVE_RETURN_IF_ERROR(scan_.status());
    if (added_) return absl::OkStatus();
    added_ = true;
    const size_t cells = offsets_.empty() ? 0 : offsets_.size() - 1;
    if (types_.size() != cells) {
      return absl::InvalidArgumentError(
          absl::StrCat("there are ", types_.size(), " cell types for ", cells, " cells"));
    }
    const auto size = static_cast<int64_t>(connectivity_.size());
    for (size_t cell = 0; cell < cells; ++cell) {
      const int64_t begin = offsets_[cell];
      const int64_t end = offsets_[cell + 1];
      if (begin < 0 || end < begin || end > size) {
        return absl::InvalidArgumentError(
            absl::StrCat("cell ", cell, " spans [", begin, ", ", end, ") of ", size, " points"));
      }
      CLEAVE_RETURN_IF_ERROR(
          cells_.Add(types_[cell],
                     std::span(connectivity_)
                         .subspan(static_cast<size_t>(begin), static_cast<size_t>(end - begin)),
                     0));
    }
    return absl::OkStatus();
  }

  // `of_cells` tells whose attributes come next, and again at each CELL_DATA and POINT_DATA.
  absl::Status ReadAttributes(bool of_cells) {
    int64_t count = scan_.Count("the number of attribute values");
    while (scan_.ok() && !scan_.AtEnd()) {
      const std::string keyword = absl::AsciiStrToUpper(scan_.Token("an attribute"));
      if (keyword == "CELL_DATA" || keyword == "POINT_DATA") {
        of_cells = keyword == "CELL_DATA";
        count = scan_.Count("the number of attribute values");
      } else if (keyword == "SCALARS") {
        const absl::string_view name = scan_.Token("the name of an attribute");
        const std::string type = Type();
        int64_t components = 1;
        if (!absl::EqualsIgnoreCase(scan_.PeekToken(), "LOOKUP_TABLE"))
          components = scan_.Count("the number of components");
        scan_.Token("LOOKUP_TABLE");
        scan_.Token("the name of a table");
        CLEAVE_RETURN_IF_ERROR(ReadArray(name, type, components, count, of_cells));
      } else if (keyword == "FIELD") {
        CLEAVE_RETURN_IF_ERROR(ReadField(of_cells));
      } else if (keyword == "VECTORS" || keyword == "NORMALS" || keyword == "TENSORS") {
        scan_.Token("the name of an attribute");
        const std::string type = Type();
        CLEAVE_RETURN_IF_ERROR(ReadArray("", type, keyword == "TENSORS" ? 9 : 3, count, false));
      } else if (keyword == "METADATA") {
        SkipMetadata();
      } else {
        return absl::OkStatus();
      }
    }
    return scan_.status();
  }

  absl::Status ReadField(bool of_cells) {
    scan_.Token("the name of a field");
    const int64_t arrays = scan_.Count("the number of arrays");
    for (int64_t i = 0; i < arrays && scan_.ok(); ++i) {
      const absl::string_view name = scan_.Token("the name of an array");
      if (name == "METADATA") {
        SkipMetadata();
        --i;
        continue;
      }
      const int64_t components = scan_.Count("the number of components");
      const int64_t count = scan_.Count("the number of values");
      const std::string type = Type();
      CLEAVE_RETURN_IF_ERROR(ReadArray(name, type, components, count, of_cells));
    }
    return scan_.status();
  }

  absl::Status ReadArray(absl::string_view name, absl::string_view type, int64_t components,
                         int64_t count, bool of_cells) {
    StartData();
    const bool regions = of_cells && !has_regions_ && components == 1 && IsRegionArray(name);
    if (regions && count != cells_.cell_count()) {
      scan_.Fail(absl::StrCat("`", name.substr(0, 40), "` has ", count, " values for ",
                              cells_.cell_count(), " cells"));
    }
    for (int64_t i = 0; i < count && scan_.ok(); ++i) {
      for (int64_t k = 0; k < components && scan_.ok(); ++k) {
        const auto value = Get<double>(type, "an attribute's value");
        if (regions && scan_.ok()) CLEAVE_RETURN_IF_ERROR(cells_.SetRegion(i, value));
      }
      if (components == 0) break;
    }
    has_regions_ = has_regions_ || regions;
    return scan_.status();
  }

  // Metadata ends at an empty line.
  void SkipMetadata() {
    scan_.RestOfLine();
    while (scan_.ok() && scan_.left() > 0 && !scan_.RestOfLine().empty()) {
    }
  }

  Scanner scan_;
  MeshBuilder builder_;
  VtkCells cells_;
  bool offsets_format_ = false;
  bool binary_ = false;
  bool added_ = false;
  bool has_regions_ = false;
  std::vector<int64_t> offsets_;
  std::vector<int64_t> connectivity_;
  std::vector<int64_t> types_;
};

}  // namespace

absl::StatusOr<TetMesh> ParseVtkLegacy(absl::string_view bytes) {
  return VtkLegacyReader(bytes).Read();
}

}  // namespace cleave
