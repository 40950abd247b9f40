#ifndef CLEAVE_TESTS_UNIT_CLIENT_IO_EXPORT_VTU_READER_H_
#define CLEAVE_TESTS_UNIT_CLIENT_IO_EXPORT_VTU_READER_H_

#include <zlib.h>

#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"
#include "core/base/status.h"
#include "tests/unit/client/io/xml_reader.h"

namespace cleave::testing {

// A VTU file read back: arrays by section and name ("CellData.region").
struct ReadVtu {
  int64_t points = 0;
  int64_t cells = 0;
  double time = 0;
  std::map<std::string, std::string> bytes;

  template <typename T>
  std::vector<T> Values(const std::string& name) const {
    const auto found = bytes.find(name);
    if (found == bytes.end()) return {};
    std::vector<T> values(found->second.size() / sizeof(T));
    std::memcpy(values.data(), found->second.data(), values.size() * sizeof(T));
    return values;
  }
};

// Decodes the appended array that comes next.
inline absl::StatusOr<std::string> TakeArray(ByteReader& reader) {
  const auto blocks = reader.Get<uint64_t>();
  const auto block_bytes = reader.Get<uint64_t>();
  const auto last_bytes = reader.Get<uint64_t>();
  if (!reader.ok() || blocks > reader.left() / 8) return absl::DataLossError("bad block table");
  if (blocks > 0 && last_bytes >= block_bytes) return absl::DataLossError("bad last block");
  std::vector<uint64_t> sizes(blocks);
  for (uint64_t& size : sizes) size = reader.Get<uint64_t>();
  std::string out;
  for (uint64_t i = 0; i < blocks; ++i) {
    const absl::string_view packed = reader.GetBytes(sizes[i]);
    const uint64_t wanted = i + 1 == blocks && last_bytes > 0 ? last_bytes : block_bytes;
    std::string block(wanted, '\0');
    uLongf size = wanted;
    if (!reader.ok() ||
        uncompress(reinterpret_cast<Bytef*>(block.data()), &size,
                   reinterpret_cast<const Bytef*>(packed.data()), packed.size()) != Z_OK ||
        size != wanted) {
      return absl::DataLossError("bad zlib block");
    }
    out += block;
  }
  return out;
}

// Reads a file of EncodeVtu as strictly as VTK's documents put it: header attributes, sections in
// place, offsets that meet the arrays end to end, byte counts that fit types and components.
inline absl::StatusOr<ReadVtu> ReadVtuFile(absl::string_view file) {
  const absl::string_view mark = "<AppendedData encoding=\"raw\">\n_";
  const absl::string_view tail = "\n</AppendedData>\n</VTKFile>\n";
  const size_t start = file.find(mark);
  if (start == absl::string_view::npos || file.size() < tail.size() ||
      file.substr(file.size() - tail.size()) != tail) {
    return absl::DataLossError("no appended section");
  }
  const absl::string_view data =
      file.substr(start + mark.size(), file.size() - tail.size() - start - mark.size());
  const std::string head = absl::StrCat(file.substr(0, start), "</VTKFile>");
  CLEAVE_ASSIGN_OR_RETURN(const XmlElement root, XmlReader::Read(head));
  const std::map<std::string, std::string> wanted_header = {
      {"type", "UnstructuredGrid"},
      {"version", "1.0"},
      {"byte_order", "LittleEndian"},
      {"header_type", "UInt64"},
      {"compressor", "vtkZLibDataCompressor"}};
  if (root.name != "VTKFile" || root.attributes != wanted_header) {
    return absl::DataLossError("bad VTKFile element");
  }
  const XmlElement* grid = root.Child("UnstructuredGrid");
  const XmlElement* piece = grid == nullptr ? nullptr : grid->Child("Piece");
  const XmlElement* fields = grid == nullptr ? nullptr : grid->Child("FieldData");
  if (piece == nullptr || fields == nullptr || fields->children.size() != 1) {
    return absl::DataLossError("no piece or no time");
  }
  ReadVtu vtu;
  if (!absl::SimpleAtoi(piece->attributes.at("NumberOfPoints"), &vtu.points) ||
      !absl::SimpleAtoi(piece->attributes.at("NumberOfCells"), &vtu.cells) ||
      !absl::SimpleAtod(fields->children[0].text, &vtu.time)) {
    return absl::DataLossError("bad counts");
  }
  ByteReader reader(data);
  for (const XmlElement& section : piece->children) {
    const int64_t items =
        section.name == "PointData" || section.name == "Points" ? vtu.points : vtu.cells;
    for (const XmlElement& array : section.children) {
      const auto& attributes = array.attributes;
      if (attributes.at("offset") != absl::StrCat(data.size() - reader.left())) {
        return absl::DataLossError("arrays do not meet end to end");
      }
      CLEAVE_ASSIGN_OR_RETURN(std::string bytes, TakeArray(reader));
      const std::string& type = attributes.at("type");
      const int64_t size = type == "UInt8" ? 1 : type == "Float32" || type == "Int32" ? 4 : 8;
      int64_t components = 1;
      const auto count = attributes.find("NumberOfComponents");
      if ((count != attributes.end() && !absl::SimpleAtoi(count->second, &components)) ||
          (attributes.at("Name") != "connectivity" &&
           static_cast<int64_t>(bytes.size()) != items * components * size)) {
        return absl::DataLossError(absl::StrCat(attributes.at("Name"), " has a wrong size"));
      }
      vtu.bytes[absl::StrCat(section.name, ".", attributes.at("Name"))] = std::move(bytes);
    }
  }
  if (reader.left() != 0) return absl::DataLossError("bytes after the last array");
  return vtu;
}

}  // namespace cleave::testing

#endif  // CLEAVE_TESTS_UNIT_CLIENT_IO_EXPORT_VTU_READER_H_
