#ifndef CLEAVE_CORE_STREAM_FRAME_ENCODER_H_
#define CLEAVE_CORE_STREAM_FRAME_ENCODER_H_

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/vec3.h"
#include "core/stream/frame.h"
#include "core/stream/frame_header.h"
#include "core/stream/interpolation_encoder.h"
#include "core/stream/piece_labels.h"
#include "core/stream/region.h"
#include "core/stream/stream_header.h"
#include "core/stream/stream_mesh.h"
#include "core/stream/stream_state.h"

namespace cleave {

// One encoded frame: the bytes for the log and the wire, and the header that they begin with.
struct EncodedFrame {
  FrameHeader header;
  std::string bytes;
};

// Turns frames into bytes, each predicted from what the decoder will hold, so that errors never
// accumulate: |decoded - x| <= tolerance at every node of every frame (stream_header.h says what
// holds after rounding to float32). A frame is a key frame when its number is a multiple of the
// header's keyframe interval, when it is the first, and when the epoch or tolerance changed. The
// bytes depend on the header, the rest positions, the state and the frame only, not on threads.
// Loops run on the current TBB arena. Not thread-safe.
class FrameEncoder {
 public:
  // `state` is that of a FrameDecoder (or encoder) of the same stream, to go on after its last
  // frame as if there had been no break; absent: start with a key frame. Errors: FailedPrecondition
  // when the mesh or state is not of this stream; InvalidArgument.
  static absl::StatusOr<FrameEncoder> Create(const StreamHeader& header, const StreamMesh& mesh,
                                             std::optional<StreamState> state = std::nullopt);

  // What to write before the first frame.
  const std::string& header_bytes() const { return header_bytes_; }

  // Errors, after which the encoder is as before: InvalidArgument for a wrong number of positions,
  // a frame number that does not rise, broken edges that are unsorted, out of range or fewer than
  // before, a time that is not finite; OutOfRange for a coordinate that is NaN, infinite or more
  // than about 2^31 tolerances (predictor 2: 2^25; predictor 3: nothing finite is too far) from the
  // origin, naming the first such node.
  absl::StatusOr<EncodedFrame> Encode(const Frame& frame);

  // Makes the next frame a key frame of this epoch (after a rewind frame numbers may fall). Error:
  // InvalidArgument unless the epoch rises; epoch 0 needs no call.
  absl::Status StartEpoch(uint32_t epoch);

  // Holds from the next frame on, which becomes a key frame. Error: InvalidArgument, as
  // MakeStreamHeader.
  absl::Status SetTolerance(double tolerance);

  // From the next frame on, in a stream with regions: pieces outside may be as coarse as the region
  // says, those inside keep the tolerance; each frame tells which are which. None: all keep it. An
  // encoder that goes on from a state has none until it is told. Error: InvalidArgument.
  absl::Status SetRegion(std::optional<Region> region);

  // After the last encoded frame. Feed it to Create to go on elsewhere.
  const StreamState& state() const { return state_; }

 private:
  FrameEncoder() = default;
  void PlaceRegion();
  bool exact() const { return header_.predictor_id == kPredictorExact; }
  bool GoesOn() const { return state_.frame >= 0 && epoch_ == state_.epoch; }
  absl::Status CheckFrame(const Frame& frame) const;
  absl::Status CheckEdges(const std::vector<int32_t>& edges) const;
  absl::Status Quantise(const std::vector<Vec3>& positions);
  // In temporal_encoder.cc.
  absl::Status QuantiseOnGrid(const std::vector<Vec3>& positions);
  void AppendPositions(bool key, FrameHeader& header, std::string& body) const;

  void AppendCheckpoint(std::span<const int32_t> edges, FrameHeader& header,
                        std::string& body) const;
  void AppendTopology(SectionType type, std::span<const int32_t> edges, FrameHeader& header,
                      std::string& body) const;

  StreamHeader header_;
  std::string header_bytes_;
  std::vector<Vec3> rest_positions_;  // with predictor 1
  std::vector<int32_t> rest_;         // on the grid of tolerance_; with predictor 1
  std::vector<int64_t> exact_rest_;   // ranks, with predictor 3
  double tolerance_ = 0;              // m, of the next frame
  uint32_t epoch_ = 0;                // of the next frame
  std::optional<Region> region_;      // of the next frame
  StreamState state_;
  std::vector<int32_t> next_;                          // quantised positions of the frame in work
  std::vector<int64_t> next_exact_;                    // ranks of them, with predictor 3
  std::optional<InterpolationEncoder> interpolation_;  // with predictor 2
  std::optional<PieceLabels> labels_;                  // with predictor 2
  ResidualHistory next_residuals_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_FRAME_ENCODER_H_
