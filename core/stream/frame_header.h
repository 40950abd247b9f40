#ifndef CLEAVE_CORE_STREAM_FRAME_HEADER_H_
#define CLEAVE_CORE_STREAM_FRAME_HEADER_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace cleave {

// A key frame decodes alone (with the mesh), a delta on the frame before it, a hold repeats it.
enum class FrameKind : uint8_t { kKey = 1, kDelta = 2, kHold = 3 };

// What stands in front of every encoded frame; FORMAT.md, section "Frame header". Enough for an
// index row without decoding anything.
struct FrameHeader {
  uint32_t section_count = 0;
  uint64_t frame_bytes = 0;  // of the whole frame, this header included
  int64_t frame = 0;
  int64_t base_frame = 0;  // the frame that a delta or hold applies to; a key frame's own number
  double time = 0;         // s
  double tolerance = 0;    // m, of this frame; 0: to the bit
  int64_t fragments = 0;
  uint64_t broken_edges = 0;  // how many, after this frame
  uint64_t state_hash = 0;    // XXH3-64 of the state after this frame
  uint32_t epoch = 0;
  FrameKind kind = FrameKind::kKey;
};

inline constexpr size_t kFrameHeaderBytes = 88;
inline constexpr size_t kSectionHeaderBytes = 24;

// Reads the header that `bytes` begin with (more may follow). Errors: DataLoss (truncated, magic,
// checksum, values that no frame has).
absl::StatusOr<FrameHeader> ParseFrameHeader(absl::string_view bytes);

void AppendFrameHeader(const FrameHeader& header, std::string& out);

enum class SectionType : uint16_t {
  kTopologyDelta = 1,       // edges that broke since the base frame
  kTopologyCheckpoint = 2,  // all broken edges
  kPositions = 3,           // a chunk of nodes
  kMotion = 4,              // how predictor 2 predicts the frame: what holds, continuations
  kTopologyLabels = 5,      // broken edges between pieces, by the piece of each node
};
inline constexpr uint16_t kOptionalSection = 0x8000;  // set in a type that readers may skip

inline constexpr uint32_t kMaxTopologyEdges = 262144;  // a section; longer lists take several

// From what a chunk of positions is predicted.
enum class Prediction : uint8_t {
  kNone = 0,           // topology
  kRest = 1,           // the rest positions
  kLast = 2,           // the base frame
  kLinear = 3,         // base frame and the one before it, continued
  kInterpolation = 4,  // coarser nodes and their motion: predictor 2
};

// One section of a frame; `coded` points into the frame's bytes.
struct Section {
  SectionType type = SectionType::kPositions;
  uint8_t coder = 0;
  Prediction prediction = Prediction::kNone;
  uint32_t raw_bytes = 0;
  uint32_t first = 0;  // first node of a chunk; 0 for topology
  uint32_t count = 0;  // nodes or edges in it
  absl::string_view coded;
};

// Appends the section's header, checksum and coded bytes.
void AppendSection(const Section& section, std::string& out);

// A frame cut into its parts, every checksum and length checked, nothing decoded. Sections that are
// optional and not known are left out.
struct FrameParts {
  FrameHeader header;
  std::vector<Section> sections;
};

// `bytes` are exactly one frame. Errors: DataLoss; Unimplemented for a section that is not known
// and not optional.
absl::StatusOr<FrameParts> SplitFrame(absl::string_view bytes);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_FRAME_HEADER_H_
