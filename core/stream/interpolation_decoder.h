#ifndef CLEAVE_CORE_STREAM_INTERPOLATION_DECODER_H_
#define CLEAVE_CORE_STREAM_INTERPOLATION_DECODER_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "core/stream/frame_header.h"
#include "core/stream/interpolation_predictor.h"
#include "core/stream/stream_header.h"
#include "core/stream/stream_state.h"

namespace cleave {

// The part of FrameDecoder that decodes positions of predictor 2. Not thread-safe; loops run on the
// current TBB arena.
class InterpolationDecoder {
 public:
  InterpolationDecoder(const StreamHeader& header, const StreamMesh& mesh);

  // Decodes the sections behind the topology of a key or delta frame that follows `state` into
  // next.positions and next.residuals; next.broken_edges are the frame's. Places that it brings
  // into view get a place in `state`. Error: DataLoss.
  absl::Status Decode(const FrameHeader& frame, std::span<const Section> sections,
                      StreamState& state, StreamState& next);

  // The frame of the last Decode is not taken: any may follow that follows `state`.
  void Reject(StreamState& state);

  // The frame that was decoded, or a hold, is now the last.
  void Accept(FrameKind kind);

  const NodeOrder& order() const { return predictor_.order(); }
  const Stencils& stencils() const { return predictor_.stencils(); }

 private:
  absl::Status DecodePlanes(const Section& section, std::span<const int32_t> moving);

  StreamHeader header_;
  InterpolationPredictor predictor_;
  std::vector<int32_t> shown_;      // places that the last Decode gave a place in its state
  LargeVector<Int32x4> residuals_;  // steps, by place: x, y, z, 0
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_INTERPOLATION_DECODER_H_
