#ifndef CLEAVE_CORE_STREAM_FRAME_MOTION_H_
#define CLEAVE_CORE_STREAM_FRAME_MOTION_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/stream/frame_header.h"
#include "core/stream/interpolation_predictor.h"
#include "core/stream/residual_model.h"

namespace cleave {

// What a frame says about its prediction, for predictor 2: FORMAT.md, "Motion".
struct FrameMotion {
  std::vector<uint8_t> held;                // by piece: 1 if it stays where it is; empty: none does
  std::vector<Continuation> continuations;  // by group; not in a key frame
  std::vector<uint8_t> classes;  // by group, where the frame is fresh for coder 2; else empty

  bool Holds(int32_t piece) const { return !held.empty() && held[static_cast<size_t>(piece)] != 0; }
};

// Appends a motion section for this many groups.
void AppendMotion(bool key, const FrameMotion& motion, int64_t groups, FrameHeader& header,
                  std::string& body);

// Reads one for a frame of this many pieces and groups, with or without classes. Errors: DataLoss.
absl::StatusOr<FrameMotion> ReadMotion(bool key, bool has_classes, const Section& section,
                                       int64_t pieces, int64_t groups);

// What coder 2 begins a frame with: the history of the frame before, or, where the motion has
// classes, theirs and the prior counts. The counts are faded already; the frame's own come on top.
void BeginResiduals(const NodeOrder& order, const FrameMotion& motion,
                    const ResidualHistory& history, ResidualHistory& next);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_FRAME_MOTION_H_
