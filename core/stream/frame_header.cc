#include "core/stream/frame_header.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"
#include "core/base/crc32c.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr absl::string_view kMagic = "CLVF";
constexpr size_t kSectionHeadBytes = kSectionHeaderBytes - sizeof(uint32_t);  // what crc32c covers

// What a reader can refuse without knowing the stream.
absl::Status CheckValues(const FrameHeader& header) {
  const auto bad = [](absl::string_view field, auto value) {
    return absl::DataLossError(absl::StrCat("frame header has ", field, " ", value));
  };
  if (header.kind != FrameKind::kKey && header.kind != FrameKind::kDelta &&
      header.kind != FrameKind::kHold) {
    return bad("kind", static_cast<int>(header.kind));
  }
  if (header.frame < 0) return bad("frame", header.frame);
  const bool key = header.kind == FrameKind::kKey;
  if (key ? header.base_frame != header.frame
          : header.base_frame < 0 || header.base_frame >= header.frame) {
    return bad("base frame", header.base_frame);
  }
  if (!std::isfinite(header.time)) return bad("time", header.time);
  if (!(header.tolerance >= 0)) return bad("tolerance", header.tolerance);
  if (header.fragments < 0) return bad("fragments", header.fragments);
  if (header.frame_bytes < kFrameHeaderBytes ||
      (header.frame_bytes - kFrameHeaderBytes) / kSectionHeaderBytes < header.section_count) {
    return bad("size", header.frame_bytes);
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<FrameHeader> ParseFrameHeader(absl::string_view bytes) {
  if (bytes.size() < kFrameHeaderBytes) return absl::DataLossError("frame header is truncated");
  ByteReader reader(bytes.substr(0, kFrameHeaderBytes));
  if (reader.GetBytes(kMagic.size()) != kMagic) {
    return absl::DataLossError("no frame: the magic is not CLVF");
  }
  FrameHeader header;
  header.section_count = reader.Get<uint32_t>();
  header.frame_bytes = reader.Get<uint64_t>();
  header.frame = reader.Get<int64_t>();
  header.base_frame = reader.Get<int64_t>();
  header.time = reader.Get<double>();
  header.tolerance = reader.Get<double>();
  header.fragments = reader.Get<int64_t>();
  header.broken_edges = reader.Get<uint64_t>();
  header.state_hash = reader.Get<uint64_t>();
  header.epoch = reader.Get<uint32_t>();
  header.kind = static_cast<FrameKind>(reader.Get<uint8_t>());
  reader.GetBytes(7);  // reserved
  if (reader.Get<uint32_t>() != Crc32c(bytes.substr(0, kFrameHeaderBytes - sizeof(uint32_t)))) {
    return absl::DataLossError("frame header fails its checksum");
  }
  CLEAVE_RETURN_IF_ERROR(CheckValues(header));
  return header;
}

void AppendFrameHeader(const FrameHeader& header, std::string& out) {
  const size_t begin = out.size();
  ByteWriter writer(out);
  writer.PutBytes(kMagic);
  writer.Put(header.section_count);
  writer.Put(header.frame_bytes);
  writer.Put(header.frame);
  writer.Put(header.base_frame);
  writer.Put(header.time);
  writer.Put(header.tolerance);
  writer.Put(header.fragments);
  writer.Put(header.broken_edges);
  writer.Put(header.state_hash);
  writer.Put(header.epoch);
  writer.Put(static_cast<uint8_t>(header.kind));
  out.append(7, '\0');
  writer.Put(Crc32c(absl::string_view(out).substr(begin)));
}

void AppendSection(const Section& section, std::string& out) {
  const size_t begin = out.size();
  ByteWriter writer(out);
  writer.Put(static_cast<uint16_t>(section.type));
  writer.Put(section.coder);
  writer.Put(static_cast<uint8_t>(section.prediction));
  writer.Put(section.raw_bytes);
  writer.Put(static_cast<uint32_t>(section.coded.size()));
  writer.Put(section.first);
  writer.Put(section.count);
  writer.Put(Crc32c(section.coded, Crc32c(absl::string_view(out).substr(begin))));
  writer.PutBytes(section.coded);
}

absl::StatusOr<FrameParts> SplitFrame(absl::string_view bytes) {
  FrameParts parts;
  CLEAVE_ASSIGN_OR_RETURN(parts.header, ParseFrameHeader(bytes));
  if (parts.header.frame_bytes != bytes.size()) {
    return absl::DataLossError(
        absl::StrCat("frame has ", bytes.size(), " bytes; it declares ", parts.header.frame_bytes));
  }
  ByteReader reader(bytes.substr(kFrameHeaderBytes));
  for (uint32_t index = 0; index < parts.header.section_count; ++index) {
    const absl::string_view head = bytes.substr(bytes.size() - reader.left(), kSectionHeadBytes);
    const auto type = reader.Get<uint16_t>();
    Section section;
    section.type = static_cast<SectionType>(type);
    section.coder = reader.Get<uint8_t>();
    section.prediction = static_cast<Prediction>(reader.Get<uint8_t>());
    section.raw_bytes = reader.Get<uint32_t>();
    const auto coded_bytes = reader.Get<uint32_t>();
    section.first = reader.Get<uint32_t>();
    section.count = reader.Get<uint32_t>();
    const auto checksum = reader.Get<uint32_t>();
    section.coded = reader.GetBytes(coded_bytes);
    if (!reader.ok()) return absl::DataLossError("frame's sections are longer than the frame");
    if (checksum != Crc32c(section.coded, Crc32c(head))) {
      return absl::DataLossError(absl::StrCat("section ", index, " fails its checksum"));
    }
    if (type >= static_cast<uint16_t>(SectionType::kTopologyDelta) &&
        type <= static_cast<uint16_t>(SectionType::kTopologyLabels)) {
      parts.sections.push_back(section);
    } else if ((type & kOptionalSection) == 0) {
      return absl::UnimplementedError(absl::StrCat("section type ", type, " is not known"));
    }
  }
  CLEAVE_RETURN_IF_ERROR(reader.Finish("frame"));
  return parts;
}

}  // namespace cleave
