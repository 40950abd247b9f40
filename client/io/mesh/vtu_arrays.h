#ifndef CLEAVE_CLIENT_IO_MESH_VTU_ARRAYS_H_
#define CLEAVE_CLIENT_IO_MESH_VTU_ARRAYS_H_

#include <cstdint>
#include <pugixml.hpp>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cleave {

// Decodes Base64 up to `max_bytes` of output; blanks are passed over, and padding may end any group
// of four, because VTK encodes headers and data one after the other. InvalidArgument for other
// characters.
absl::StatusOr<std::string> DecodeBase64(absl::string_view text, uint64_t max_bytes);

// How a VTK XML file stores its arrays, and the arrays themselves.
class VtuArrays {
 public:
  // `file` is the VTKFile element; `appended` what follows the underscore of AppendedData, raw or
  // in Base64. InvalidArgument for a compressor or a header type that cannot be read.
  static absl::StatusOr<VtuArrays> Of(const pugi::xml_node& file, absl::string_view appended,
                                      bool appended_raw);

  // The values of a DataArray, however it is stored: `count` of them. Memory is bounded by the
  // array's own bytes, not by what headers announce. Values that the type cannot hold are refused.
  absl::Status Read(const pugi::xml_node& array, uint64_t count, std::vector<double>& values) const;
  absl::Status Read(const pugi::xml_node& array, uint64_t count,
                    std::vector<int64_t>& values) const;

 private:
  template <typename Value>
  absl::Status ReadAs(const pugi::xml_node& array, uint64_t count,
                      std::vector<Value>& values) const;
  // The array's bytes as they were before encoding, at most `size` and a header's worth of them.
  absl::StatusOr<std::string> BytesOf(const pugi::xml_node& array, uint64_t size) const;
  absl::StatusOr<std::string> Inflate(absl::string_view stored, uint64_t size) const;
  uint64_t Word(absl::string_view bytes, size_t index) const;

  absl::string_view appended_;
  bool appended_raw_ = false;
  bool swapped_ = false;
  bool compressed_ = false;
  size_t word_bytes_ = 4;  // of the integers in headers
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_VTU_ARRAYS_H_
