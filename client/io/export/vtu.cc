#include "client/io/export/vtu.h"

#include <zlib.h>

#include <algorithm>
#include <cstddef>

#include "absl/strings/escaping.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "core/base/bytes.h"
#include "core/base/faults.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace cleave {
namespace {

// Large enough that the block table is nothing, small enough that a frame keeps all cores busy.
constexpr size_t kBlockBytes = 256 * 1024;

bool IsControl(char c) { return static_cast<unsigned char>(c) < 32; }

bool NeedsEscape(absl::string_view text) {
  return std::any_of(text.begin(), text.end(), [](char c) {
    return c == '<' || c == '>' || c == '&' || c == '"' || IsControl(c);
  });
}

size_t TypeSize(absl::string_view type) {
  if (type == "UInt8") return 1;
  return type == "Float32" || type == "Int32" ? 4 : 8;
}

// VTK's compressed layout: block count, block size, size of the last block where it is shorter (0
// where it is whole), compressed sizes, then the blocks.
absl::Status AppendCompressed(absl::string_view bytes, std::string& out) {
  const size_t blocks = (bytes.size() + kBlockBytes - 1) / kBlockBytes;
  std::vector<std::string> compressed(blocks);
  std::vector<int> results(blocks, Z_OK);
  ParallelFor(static_cast<int64_t>(blocks), 1, [&](int64_t begin, int64_t end) {
    for (auto i = static_cast<size_t>(begin); i < static_cast<size_t>(end); ++i) {
      const absl::string_view block = bytes.substr(i * kBlockBytes, kBlockBytes);
      uLongf size = compressBound(block.size());
      compressed[i].resize(size);
      results[i] = compress2(reinterpret_cast<Bytef*>(compressed[i].data()), &size,
                             reinterpret_cast<const Bytef*>(block.data()), block.size(), 4);
      compressed[i].resize(size);
    }
  });
  for (const int result : results) {
    if (result != Z_OK) return absl::ResourceExhaustedError("zlib found no memory for a block");
  }
  ByteWriter writer(out);
  writer.Put<uint64_t>(blocks);
  writer.Put<uint64_t>(kBlockBytes);
  writer.Put<uint64_t>(bytes.size() % kBlockBytes);
  for (const std::string& block : compressed) writer.Put<uint64_t>(block.size());
  for (const std::string& block : compressed) writer.PutBytes(block);
  return absl::OkStatus();
}

// Collects array elements and their appended data side by side.
class Arrays {
 public:
  absl::Status Add(const VtuArray& array) {
    absl::StrAppendFormat(&xml_, "<DataArray type=\"%s\" Name=\"%s\" ", array.type, array.name);
    // VTK leaves the count out of scalars, and some readers take a count of 1 for a matrix.
    if (array.components != 1) {
      absl::StrAppendFormat(&xml_, "NumberOfComponents=\"%d\" ", array.components);
    }
    absl::StrAppendFormat(&xml_, "format=\"appended\" offset=\"%u\"/>\n", data_.size());
    return AppendCompressed(array.bytes, data_);
  }
  absl::Status AddSection(absl::string_view tag, const std::vector<VtuArray>& arrays,
                          absl::string_view texture_coordinates = "") {
    absl::StrAppend(&xml_, "<", tag);
    if (!texture_coordinates.empty()) {
      absl::StrAppend(&xml_, " TCoords=\"", texture_coordinates, "\"");
    }
    absl::StrAppend(&xml_, ">\n");
    for (const VtuArray& array : arrays) CLEAVE_RETURN_IF_ERROR(Add(array));
    absl::StrAppend(&xml_, "</", tag, ">\n");
    return absl::OkStatus();
  }
  const std::string& xml() const { return xml_; }
  const std::string& data() const { return data_; }

 private:
  std::string xml_;
  std::string data_;
};

void CheckArrays(absl::string_view section, const std::vector<VtuArray>& arrays, size_t items,
                 Faults& faults) {
  for (const VtuArray& array : arrays) {
    const std::string field = absl::StrCat(section, ".", array.name);
    const size_t wanted = items * static_cast<size_t>(array.components) * TypeSize(array.type);
    if (array.bytes.size() != wanted) {
      faults.Error(field, absl::StrCat("has ", array.bytes.size(), " bytes, not ", wanted));
    }
    if (NeedsEscape(array.name)) faults.Error(field, "the name holds a character XML reserves");
  }
}

}  // namespace

VtuArray MakeVtuVectors(absl::string_view name, std::span<const Vec3> values) {
  std::vector<float> floats(values.size() * 3);
  for (size_t i = 0; i < values.size(); ++i) {
    for (size_t k = 0; k < 3; ++k) floats[3 * i + k] = static_cast<float>(values[i][k]);
  }
  VtuArray array = MakeVtuArray<float>(name, floats);
  array.components = 3;
  return array;
}

absl::StatusOr<std::string> EncodeVtu(const VtuGrid& grid, absl::string_view comment) {
  Faults faults;
  const size_t cells = grid.types.size();
  CheckArrays("point_data", grid.point_data, grid.points.size(), faults);
  CheckArrays("cell_data", grid.cell_data, cells, faults);
  const int64_t ids = static_cast<int64_t>(grid.connectivity.size());
  if (grid.offsets.size() != cells || (cells > 0 && grid.offsets.back() != ids)) {
    faults.Error("offsets", absl::StrCat("do not split ", ids, " ids over ", cells, " cells"));
  }
  const auto is_texture = [&](const VtuArray& array) {
    return array.name == grid.texture_coordinates;
  };
  if (!grid.texture_coordinates.empty() &&
      std::none_of(grid.point_data.begin(), grid.point_data.end(), is_texture)) {
    faults.Error("texture_coordinates",
                 absl::StrCat("no array \"", grid.texture_coordinates, "\" in point_data"));
  }
  if (comment.find("--") != absl::string_view::npos) faults.Error("comment", "holds \"--\"");
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());

  Arrays arrays;
  CLEAVE_RETURN_IF_ERROR(arrays.AddSection("PointData", grid.point_data, grid.texture_coordinates));
  CLEAVE_RETURN_IF_ERROR(arrays.AddSection("CellData", grid.cell_data));
  CLEAVE_RETURN_IF_ERROR(arrays.AddSection("Points", {MakeVtuVectors("Points", grid.points)}));
  CLEAVE_RETURN_IF_ERROR(
      arrays.AddSection("Cells", {MakeVtuArray<int64_t>("connectivity", grid.connectivity),
                                  MakeVtuArray<int64_t>("offsets", grid.offsets),
                                  MakeVtuArray<uint8_t>("types", grid.types)}));
  return absl::StrCat(
      "<?xml version=\"1.0\"?>\n<!-- ", comment, " -->\n",
      "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
      "header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid>\n",
      "<FieldData>\n<DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
      "format=\"ascii\">",
      absl::StrFormat("%.17g", grid.time), "</DataArray>\n</FieldData>\n",
      absl::StrFormat("<Piece NumberOfPoints=\"%u\" NumberOfCells=\"%u\">\n", grid.points.size(),
                      cells),
      arrays.xml(), "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_",
      arrays.data(), "\n</AppendedData>\n</VTKFile>\n");
}

absl::StatusOr<std::string> EncodePvd(const std::vector<PvdEntry>& entries) {
  std::string out =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" "
      "byte_order=\"LittleEndian\">\n<Collection>\n";
  for (const PvdEntry& entry : entries) {
    if (std::any_of(entry.file.begin(), entry.file.end(), IsControl)) {
      return absl::InvalidArgumentError(
          absl::StrCat("file name \"", absl::CEscape(entry.file), "\" holds a control character"));
    }
    absl::StrAppendFormat(
        &out, "<DataSet timestep=\"%.17g\" group=\"\" part=\"0\" file=\"%s\"/>\n", entry.time,
        absl::StrReplaceAll(entry.file,
                            {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}, {"\"", "&quot;"}}));
  }
  absl::StrAppend(&out, "</Collection>\n</VTKFile>\n");
  return out;
}

}  // namespace cleave
