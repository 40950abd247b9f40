#ifndef CLEAVE_CORE_STREAM_POSITION_CHUNK_H_
#define CLEAVE_CORE_STREAM_POSITION_CHUNK_H_

#include <algorithm>
#include <cstdint>
#include <string>

#include "core/stream/frame_header.h"
#include "core/stream/stream_header.h"

namespace cleave {

// What is coded of the positions of StreamHeader.chunk_nodes nodes; of the last chunk, of the rest.
struct PositionChunk {
  Prediction prediction = Prediction::kRest;
  uint32_t raw_bytes = 0;
  std::string coded;
};

// Appends the index-th chunk to a frame. The chunks of a frame come in order.
inline void AppendPositionChunk(const StreamHeader& stream, int64_t index,
                                const PositionChunk& chunk, FrameHeader& header,
                                std::string& body) {
  const auto nodes = static_cast<int64_t>(stream.node_count);
  const int64_t first = index * stream.chunk_nodes;
  AppendSection(
      {.type = SectionType::kPositions,
       .coder = static_cast<uint8_t>(stream.coder_id),
       .prediction = chunk.prediction,
       .raw_bytes = chunk.raw_bytes,
       .first = static_cast<uint32_t>(first),
       .count = static_cast<uint32_t>(std::min<int64_t>(stream.chunk_nodes, nodes - first)),
       .coded = chunk.coded},
      body);
  ++header.section_count;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_POSITION_CHUNK_H_
