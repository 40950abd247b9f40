#ifndef CLEAVE_CLIENT_IO_EXPORT_VTU_H_
#define CLEAVE_CLIENT_IO_EXPORT_VTU_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/base/vec3.h"

namespace cleave {

// An array of a VTU file, its values little-endian as they go to disk.
struct VtuArray {
  std::string name;
  absl::string_view type;  // VTK's name: Float32, Float64, Int32, Int64, UInt64, UInt8
  int components = 1;
  std::string bytes;
};

inline absl::string_view VtuTypeName(float) { return "Float32"; }
inline absl::string_view VtuTypeName(double) { return "Float64"; }
inline absl::string_view VtuTypeName(int32_t) { return "Int32"; }
inline absl::string_view VtuTypeName(int64_t) { return "Int64"; }
inline absl::string_view VtuTypeName(uint64_t) { return "UInt64"; }
inline absl::string_view VtuTypeName(uint8_t) { return "UInt8"; }

// An array of one component a value.
template <typename T>
VtuArray MakeVtuArray(absl::string_view name, std::span<const T> values) {
  return VtuArray{std::string(name), VtuTypeName(T{}), 1,
                  std::string(reinterpret_cast<const char*>(values.data()), values.size_bytes())};
}
// An array of three Float32 components a value.
VtuArray MakeVtuVectors(absl::string_view name, std::span<const Vec3> values);

// VTK's numbers of the cell types that Cleave writes.
inline constexpr uint8_t kVtuLine = 3;
inline constexpr uint8_t kVtuTriangle = 5;
inline constexpr uint8_t kVtuTetrahedron = 10;
inline constexpr uint8_t kVtuHexahedron = 12;

// An unstructured grid as one VTU piece.
struct VtuGrid {
  double time = 0;                    // s, stored as the field TimeValue, which ParaView reads
  std::vector<Vec3> points;           // m
  std::vector<int64_t> connectivity;  // point ids of all cells, end to end
  std::vector<int64_t> offsets;       // a cell each: where its ids end in `connectivity`
  std::vector<uint8_t> types;         // a cell each
  std::vector<VtuArray> point_data;
  std::vector<VtuArray> cell_data;
  std::string texture_coordinates;  // which of `point_data` they are; empty: none
};

// The bytes of a VTU file (VTK XML 1.0, UInt64 headers): appended raw data in zlib blocks that are
// compressed in parallel. `comment` goes into an XML comment on the second line and must not hold
// "--". Errors: InvalidArgument where an array does not fit the points or cells, or a name needs
// escaping in XML. Source: VTK file formats, "XML file formats", appended data.
absl::StatusOr<std::string> EncodeVtu(const VtuGrid& grid, absl::string_view comment);

// One line of a series.
struct PvdEntry {
  double time = 0;   // s
  std::string file;  // relative to the PVD file
};

// The bytes of a ParaView collection that plays the files over time. Errors: InvalidArgument for a
// name with a control character.
absl::StatusOr<std::string> EncodePvd(const std::vector<PvdEntry>& entries);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_EXPORT_VTU_H_
