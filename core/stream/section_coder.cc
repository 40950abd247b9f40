#include "core/stream/section_coder.h"

#include <zstd.h>

#include <bit>
#include <memory>
#include <type_traits>

#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"

namespace cleave {
namespace {

constexpr int kZstdLevel = 1;

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

template <typename Int>
std::string Split(std::span<const Int> residuals) {
  using Bits = std::make_unsigned_t<Int>;
  const auto zigzag = [](Int value) {
    return (static_cast<Bits>(value) << 1) ^ static_cast<Bits>(value >> (8 * sizeof(Int) - 1));
  };
  Bits all = 0;
  for (const Int residual : residuals) all |= zigzag(residual);
  const size_t planes = (static_cast<size_t>(std::bit_width(all)) + 7) / 8;
  const size_t nodes = residuals.size() / 3;
  std::string bytes(planes * residuals.size(), '\0');
  char* out = bytes.data();
  for (size_t plane = 0; plane < planes; ++plane) {
    for (size_t axis = 0; axis < 3; ++axis) {
      for (size_t node = 0; node < nodes; ++node) {
        *out++ = static_cast<char>(zigzag(residuals[3 * node + axis]) >> (8 * plane));
      }
    }
  }
  return bytes;
}

template <typename Int>
void Unite(absl::string_view planes, std::span<Int> residuals) {
  using Bits = std::make_unsigned_t<Int>;
  const size_t nodes = residuals.size() / 3;
  const size_t plane_count = residuals.empty() ? 0 : planes.size() / residuals.size();
  const auto* in = reinterpret_cast<const unsigned char*>(planes.data());
  for (size_t axis = 0; axis < 3; ++axis) {
    for (size_t node = 0; node < nodes; ++node) {
      Bits value = 0;
      for (size_t plane = 0; plane < plane_count; ++plane) {
        value |= Bits{in[(plane * 3 + axis) * nodes + node]} << (8 * plane);
      }
      residuals[3 * node + axis] = static_cast<Int>((value >> 1) ^ (~(value & 1) + 1));
    }
  }
}

}  // namespace

std::string CodeParts(absl::string_view raw, uint32_t parts) {
  std::string coded;
  if (raw.empty()) return coded;
  const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  ByteWriter writer(coded);
  const size_t part_bytes = raw.size() / parts;
  coded.reserve(raw.size() + parts * sizeof(uint32_t));
  std::string buffer(ZSTD_compressBound(part_bytes), '\0');
  for (uint32_t part = 0; part < parts; ++part) {
    const absl::string_view source = raw.substr(part * part_bytes, part_bytes);
    const size_t size = context == nullptr
                            ? part_bytes
                            : ZSTD_compressCCtx(context.get(), buffer.data(), buffer.size(),
                                                source.data(), source.size(), kZstdLevel);
    const bool stored = ZSTD_isError(size) != 0 || size >= part_bytes;
    writer.Put(static_cast<uint32_t>(stored ? part_bytes : size));
    writer.PutBytes(stored ? source : absl::string_view(buffer.data(), size));
  }
  return coded;
}

absl::Status DecodeParts(absl::string_view coded, uint32_t parts, std::span<char> raw) {
  ByteReader reader(coded);
  if (!raw.empty()) {
    const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
    if (context == nullptr) return absl::ResourceExhaustedError("no memory to decompress with");
    const size_t part_bytes = raw.size() / parts;
    for (uint32_t part = 0; part < parts; ++part) {
      const std::span<char> target = raw.subspan(part * part_bytes, part_bytes);
      const absl::string_view source = reader.GetBytes(reader.Get<uint32_t>());
      if (!reader.ok()) return absl::DataLossError("a part is longer than its section");
      if (source.size() == part_bytes) {
        source.copy(target.data(), part_bytes);
        continue;
      }
      // One frame, of exactly the declared size, decoded in one call: no window is allocated.
      if (ZSTD_getFrameContentSize(source.data(), source.size()) != part_bytes ||
          ZSTD_findFrameCompressedSize(source.data(), source.size()) != source.size()) {
        return absl::DataLossError("a part is not one zstd frame of the declared size");
      }
      const size_t size = ZSTD_decompressDCtx(context.get(), target.data(), part_bytes,
                                              source.data(), source.size());
      if (ZSTD_isError(size) != 0 || size != part_bytes) {
        return absl::DataLossError("a part does not decompress");
      }
    }
  }
  return reader.Finish("section");
}

std::string ToBytePlanes(std::span<const int32_t> residuals) { return Split(residuals); }
std::string ToBytePlanes(std::span<const int64_t> residuals) { return Split(residuals); }

void FromBytePlanes(absl::string_view planes, std::span<int32_t> residuals) {
  Unite(planes, residuals);
}
void FromBytePlanes(absl::string_view planes, std::span<int64_t> residuals) {
  Unite(planes, residuals);
}

std::string ToGaps(std::span<const int32_t> ids) {
  std::string bytes;
  int64_t previous = -1;
  for (const int32_t id : ids) {
    auto gap = static_cast<uint64_t>(id - previous - 1);
    for (; gap >= 0x80; gap >>= 7) bytes.push_back(static_cast<char>(gap | 0x80));
    bytes.push_back(static_cast<char>(gap));
    previous = id;
  }
  return bytes;
}

absl::Status FromGaps(absl::string_view bytes, uint32_t count, int64_t first, int64_t end,
                      std::vector<int32_t>& ids) {
  size_t at = 0;
  int64_t previous = -1;
  for (uint32_t index = 0; index < count; ++index) {
    uint64_t gap = 0;
    for (int shift = 0;; shift += 7) {
      if (at == bytes.size()) return absl::DataLossError("edge list is truncated");
      const auto byte = static_cast<unsigned char>(bytes[at++]);
      gap |= uint64_t{byte & 0x7Fu} << shift;
      if ((byte & 0x80) == 0) {
        if (byte == 0 && shift > 0) return absl::DataLossError("edge list has a padded number");
        break;
      }
      if (shift == 28) return absl::DataLossError("edge list has a number above 5 bytes");
    }
    const int64_t id = previous + 1 + static_cast<int64_t>(gap);
    if (id < first || id >= end) {
      return absl::DataLossError(
          absl::StrCat("broken edge ", id, " is outside [", first, ", ", end, ")"));
    }
    ids.push_back(static_cast<int32_t>(id));
    previous = id;
  }
  if (at != bytes.size()) return absl::DataLossError("edge list is longer than its count");
  return absl::OkStatus();
}

}  // namespace cleave
