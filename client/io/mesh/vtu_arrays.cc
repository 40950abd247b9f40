#include "client/io/mesh/vtu_arrays.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <type_traits>

#include "absl/strings/ascii.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/io/mesh/file_bytes.h"
#include "client/io/mesh/scanner.h"
#include "core/base/status.h"

namespace cleave {
namespace {

// Deflate cannot pack tighter than this; a header that announces more lies.
constexpr uint64_t kMostInflation = 1032;

int Base64Digit(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+') return 62;
  if (c == '/') return 63;
  return -1;
}

size_t SizeOf(absl::string_view type) {
  if (type == "Int8" || type == "UInt8") return 1;
  if (type == "Int16" || type == "UInt16") return 2;
  if (type == "Int32" || type == "UInt32" || type == "Float32") return 4;
  if (type == "Int64" || type == "UInt64" || type == "Float64") return 8;
  return 0;
}

template <typename Stored, typename Value>
absl::Status Convert(absl::string_view bytes, bool swapped, std::vector<Value>& values) {
  for (size_t at = 0; at < bytes.size(); at += sizeof(Stored)) {
    char buffer[sizeof(Stored)];
    std::memcpy(buffer, bytes.data() + at, sizeof(Stored));
    if (swapped) std::reverse(buffer, buffer + sizeof(Stored));
    Stored stored;
    std::memcpy(&stored, buffer, sizeof(Stored));
    if constexpr (std::is_integral_v<Value> && std::is_floating_point_v<Stored>) {
      return absl::InvalidArgumentError("holds decimal numbers where whole ones are expected");
    } else {
      if constexpr (std::is_integral_v<Value> && std::is_same_v<Stored, uint64_t>) {
        if (stored > static_cast<uint64_t>(std::numeric_limits<int64_t>::max()))
          return absl::InvalidArgumentError(absl::StrCat("holds ", stored));
      }
      values.push_back(static_cast<Value>(stored));
    }
  }
  return absl::OkStatus();
}

template <typename Value>
absl::Status ConvertFrom(absl::string_view type, absl::string_view bytes, bool swapped,
                         std::vector<Value>& values) {
  if (type == "Int8") return Convert<int8_t>(bytes, swapped, values);
  if (type == "UInt8") return Convert<uint8_t>(bytes, swapped, values);
  if (type == "Int16") return Convert<int16_t>(bytes, swapped, values);
  if (type == "UInt16") return Convert<uint16_t>(bytes, swapped, values);
  if (type == "Int32") return Convert<int32_t>(bytes, swapped, values);
  if (type == "UInt32") return Convert<uint32_t>(bytes, swapped, values);
  if (type == "Int64") return Convert<int64_t>(bytes, swapped, values);
  if (type == "UInt64") return Convert<uint64_t>(bytes, swapped, values);
  if (type == "Float32") return Convert<float>(bytes, swapped, values);
  return Convert<double>(bytes, swapped, values);
}

}  // namespace

absl::StatusOr<std::string> DecodeBase64(absl::string_view text, uint64_t max_bytes) {
  std::string bytes;
  uint32_t group = 0;
  int digits = 0;
  int padding = 0;
  for (const char c : text) {
    if (bytes.size() >= max_bytes) break;
    if (absl::ascii_isspace(static_cast<unsigned char>(c))) continue;
    const int digit = Base64Digit(c);
    if (digit < 0 && c != '=') {
      return absl::InvalidArgumentError(
          absl::StrCat("a character that is not Base64, code ", static_cast<unsigned char>(c)));
    }
    if (digit >= 0 && padding > 0)
      return absl::InvalidArgumentError("Base64 padding within a group of four");
    padding += c == '=' ? 1 : 0;
    group = group << 6 | static_cast<uint32_t>(std::max(digit, 0));
    if (++digits < 4) continue;
    if (padding > 2) return absl::InvalidArgumentError("a Base64 group of padding alone");
    for (int byte = 0; byte < 3 - padding; ++byte)
      bytes.push_back(static_cast<char>(group >> (16 - 8 * byte) & 0xFF));
    group = 0;
    digits = 0;
    padding = 0;
  }
  if (bytes.size() < max_bytes && digits != 0)
    return absl::InvalidArgumentError("Base64 that ends within a group of four");
  if (bytes.size() > max_bytes) bytes.resize(max_bytes);
  return bytes;
}

absl::StatusOr<VtuArrays> VtuArrays::Of(const pugi::xml_node& file, absl::string_view appended,
                                        bool appended_raw) {
  VtuArrays arrays;
  arrays.appended_ = appended;
  arrays.appended_raw_ = appended_raw;
  arrays.swapped_ = absl::string_view(file.attribute("byte_order").value()) == "BigEndian";
  const absl::string_view header = file.attribute("header_type").value();
  if (header == "UInt64") {
    arrays.word_bytes_ = 8;
  } else if (!header.empty() && header != "UInt32") {
    return absl::InvalidArgumentError(
        absl::StrCat("header_type `", header.substr(0, 40), "` is neither UInt32 nor UInt64"));
  }
  const absl::string_view compressor = file.attribute("compressor").value();
  arrays.compressed_ = !compressor.empty();
  if (arrays.compressed_ && compressor != "vtkZLibDataCompressor") {
    return absl::InvalidArgumentError(
        absl::StrCat("compressor `", compressor.substr(0, 40),
                     "` cannot be read; save with vtkZLibDataCompressor or without one"));
  }
  return arrays;
}

absl::Status VtuArrays::Read(const pugi::xml_node& array, uint64_t count,
                             std::vector<double>& values) const {
  return ReadAs(array, count, values);
}
absl::Status VtuArrays::Read(const pugi::xml_node& array, uint64_t count,
                             std::vector<int64_t>& values) const {
  return ReadAs(array, count, values);
}

template <typename Value>
absl::Status VtuArrays::ReadAs(const pugi::xml_node& array, uint64_t count,
                               std::vector<Value>& values) const {
  values.clear();
  const absl::string_view type = array.attribute("type").value();
  const size_t size = SizeOf(type);
  if (size == 0)
    return absl::InvalidArgumentError(absl::StrCat("type `", type.substr(0, 40), "` is not known"));
  if (count > kMaxMeshFileBytes / size)
    return absl::InvalidArgumentError(absl::StrCat("cannot hold ", count, " values"));

  if (absl::string_view(array.attribute("format").value()) == "ascii") {
    Scanner scan(array.child_value());
    while (values.size() < count && scan.ok() && !scan.AtEnd()) {
      if constexpr (std::is_integral_v<Value>) {
        values.push_back(scan.Integer("a whole number"));
      } else {
        values.push_back(scan.Number("a number"));
      }
    }
    CLEAVE_RETURN_IF_ERROR(scan.status());
  } else {
    CLEAVE_ASSIGN_OR_RETURN(std::string bytes, BytesOf(array, count * size));
    bytes.resize(bytes.size() / size * size);
    CLEAVE_RETURN_IF_ERROR(ConvertFrom(type, bytes, swapped_, values));
  }
  if (values.size() != count)
    return absl::InvalidArgumentError(
        absl::StrCat("expected ", count, " values, found ", values.size()));
  return absl::OkStatus();
}

uint64_t VtuArrays::Word(absl::string_view bytes, size_t index) const {
  uint64_t word = 0;
  for (size_t i = 0; i < word_bytes_; ++i) {
    const size_t place = swapped_ ? i : word_bytes_ - 1 - i;
    word = word << 8 | static_cast<unsigned char>(bytes[index * word_bytes_ + place]);
  }
  return word;
}

absl::StatusOr<std::string> VtuArrays::BytesOf(const pugi::xml_node& array, uint64_t size) const {
  const absl::string_view format = array.attribute("format").value();
  absl::string_view source;
  bool raw = false;
  if (format == "binary") {
    source = array.child_value();
  } else if (format == "appended") {
    uint64_t offset = 0;
    if (!absl::SimpleAtoi(array.attribute("offset").value(), &offset) ||
        offset > appended_.size()) {
      return absl::InvalidArgumentError(absl::StrCat(
          "offset `", absl::string_view(array.attribute("offset").value()).substr(0, 40),
          "` is outside the ", appended_.size(), " appended bytes"));
    }
    source = appended_.substr(offset);
    raw = appended_raw_;
  } else {
    return absl::InvalidArgumentError(
        absl::StrCat("format `", format.substr(0, 40), "` is none of ascii, binary and appended"));
  }
  // The first `wanted` bytes of what was stored, or fewer where it ends.
  const auto stored = [&](uint64_t wanted) -> absl::StatusOr<std::string> {
    if (raw) return std::string(source.substr(0, wanted));
    return DecodeBase64(source, wanted);
  };

  // A header, then the data: its size alone, or block sizes where it is compressed.
  const uint64_t head = (compressed_ ? 3 : 1) * word_bytes_;
  CLEAVE_ASSIGN_OR_RETURN(std::string bytes, stored(head));
  if (bytes.size() < head) return absl::InvalidArgumentError("ends within its header");
  if (!compressed_) {
    const uint64_t its_size = Word(bytes, 0);
    if (its_size != size) {
      return absl::InvalidArgumentError(
          absl::StrCat("expected ", size, " bytes, its header tells ", its_size));
    }
    CLEAVE_ASSIGN_OR_RETURN(bytes, stored(head + size));
    return bytes.substr(head);
  }
  const uint64_t blocks = Word(bytes, 0);
  if (blocks > source.size() / word_bytes_)
    return absl::InvalidArgumentError(absl::StrCat("claims ", blocks, " blocks"));
  const uint64_t full_head = head + blocks * word_bytes_;
  CLEAVE_ASSIGN_OR_RETURN(bytes, stored(full_head));
  if (bytes.size() < full_head) return absl::InvalidArgumentError("ends within its header");
  uint64_t total = full_head;
  for (uint64_t block = 0; block < blocks; ++block) {
    const uint64_t its_size = Word(bytes, 3 + block);
    if (its_size > source.size() || total > source.size())
      return absl::InvalidArgumentError(
          absl::StrCat("block ", block, " claims ", its_size, " bytes"));
    total += its_size;
  }
  CLEAVE_ASSIGN_OR_RETURN(bytes, stored(total));
  if (bytes.size() < total) return absl::InvalidArgumentError("ends within its blocks");
  return Inflate(bytes, size);
}

absl::StatusOr<std::string> VtuArrays::Inflate(absl::string_view stored, uint64_t size) const {
  const uint64_t blocks = Word(stored, 0);
  const uint64_t block_size = Word(stored, 1);
  const uint64_t last_size = Word(stored, 2);
  size_t at = (3 + blocks) * word_bytes_;
  std::string data;
  for (uint64_t block = 0; block < blocks; ++block) {
    const uint64_t packed = Word(stored, 3 + block);
    const uint64_t wanted = block + 1 == blocks && last_size > 0 ? last_size : block_size;
    if (wanted > size - data.size() || wanted > kMostInflation * (packed + 1)) {
      return absl::InvalidArgumentError(
          absl::StrCat("block ", block, " of ", packed, " bytes claims to unpack to ", wanted));
    }
    const size_t before = data.size();
    data.resize(before + wanted);
    auto unpacked = static_cast<uLongf>(wanted);
    const int result =
        uncompress(reinterpret_cast<Bytef*>(data.data() + before), &unpacked,
                   reinterpret_cast<const Bytef*>(stored.data() + at), static_cast<uLong>(packed));
    if (result != Z_OK || unpacked != wanted)
      return absl::InvalidArgumentError(absl::StrCat("block ", block, " cannot be unpacked"));
    at += packed;
  }
  return data;
}

}  // namespace cleave
