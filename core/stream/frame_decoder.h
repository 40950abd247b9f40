#ifndef CLEAVE_CORE_STREAM_FRAME_DECODER_H_
#define CLEAVE_CORE_STREAM_FRAME_DECODER_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/base/vec3.h"
#include "core/stream/frame.h"
#include "core/stream/frame_header.h"
#include "core/stream/interpolation_decoder.h"
#include "core/stream/piece_labels.h"
#include "core/stream/stream_header.h"
#include "core/stream/stream_mesh.h"
#include "core/stream/stream_state.h"

namespace cleave {

// What a decoder is willing to hold; a header that asks for more is refused before anything is
// allocated.
struct DecoderLimits {
  uint64_t max_nodes = 64'000'000;
  uint64_t max_edges = 450'000'000;
};

// Turns the bytes of FrameEncoder back into frames. Bytes may come from anyone: every count is
// checked before memory is taken for it. Loops run on the current TBB arena. Not thread-safe.
class FrameDecoder {
 public:
  // `mesh` is that of which the stream is, rest positions to the bit. Errors: as
  // ParseStreamHeader; ResourceExhausted (limits); FailedPrecondition (another mesh).
  static absl::StatusOr<FrameDecoder> Create(absl::string_view header_bytes, const StreamMesh& mesh,
                                             const DecoderLimits& limits = {});

  // Decodes one whole frame. A key frame applies to any state (that is how one seeks), the others
  // only to the state that they were made from. Errors, after which the decoder is as before:
  // DataLoss (damaged, or the state hash does not come out); FailedPrecondition (the frame has
  // another base frame, epoch or tolerance than the state: apply an earlier frame or a key frame
  // first); Unimplemented (unknown section or coder).
  absl::Status Apply(absl::string_view frame_bytes);

  const StreamHeader& header() const { return header_; }
  // The last applied frame; positions are origin + integer * step in doubles, with
  // predictor 3 those that were encoded. In a surface view it tells which nodes count. Without one,
  // frame().frame is -1.
  const Frame& frame() const { return frame_; }
  // Of each node, m: the largest error that its coordinates in frame() may have. More than the
  // frame's tolerance only outside of a region of interest.
  std::vector<double> Tolerances() const;
  uint32_t epoch() const { return state_.epoch; }
  // Of the last applied frame; with (epoch, frame) it names where to resume. 0 without one.
  uint64_t state_hash() const { return state_hash_; }
  const StreamState& state() const { return state_; }

 private:
  FrameDecoder() = default;
  absl::Status CheckBase(const FrameHeader& frame) const;
  absl::StatusOr<std::vector<int32_t>> DecodeLabels(const Section& section) const;
  absl::Status DecodeTopology(const FrameParts& parts, StreamState& next, size_t& section) const;
  absl::Status DecodePositions(const FrameParts& parts, size_t section, StreamState& next) const;
  bool exact() const { return header_.predictor_id == kPredictorExact; }
  absl::Status DecodeChunk(const Section& section, const std::vector<int32_t>& rest,
                           std::vector<int32_t>& positions) const;
  void Accept(StreamState& next, const FrameHeader& frame);
  void ShowVisible();

  StreamHeader header_;
  std::string header_bytes_;
  std::vector<Vec3> rest_positions_;  // with predictor 1
  std::vector<int32_t> rest_;         // on the grid of rest_tolerance_
  std::vector<int64_t> exact_rest_;   // ranks, with predictor 3
  double rest_tolerance_ = 0;         // m
  StreamState state_;
  StreamState scratch_;  // where the next frame is decoded, so that a bad one changes nothing
  uint64_t state_hash_ = 0;
  std::optional<InterpolationDecoder> interpolation_;  // with predictor 2
  std::optional<PieceLabels> labels_;                  // with predictor 2
  Frame frame_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_FRAME_DECODER_H_
