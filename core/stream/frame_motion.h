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
#include "core/stream/stream_header.h"

namespace cleave {

// A group whose places go on from the activities that they have.
inline constexpr uint8_t kGoesOn = 255;

// What a frame says about its prediction, for predictor 2: FORMAT.md, "Motion".
struct FrameMotion {
  std::vector<uint8_t> held;  // by piece: 1 if it stays where it is; empty: none does
  // By piece: 1 if its steps are 2 to the power of `shift` times as long; empty: none's are.
  std::vector<uint8_t> coarse;
  uint8_t shift = 0;
  std::vector<Continuation> continuations;  // by group; not in a key frame
  // With coder 2, by group: the class with which all its places begin, or kGoesOn; empty: all go
  // on. In a key frame each group has a class.
  std::vector<uint8_t> classes;

  int32_t ShiftOf(int32_t piece) const {
    return !coarse.empty() && coarse[static_cast<size_t>(piece)] != 0 ? shift : 0;
  }
  bool Holds(int32_t piece) const { return !held.empty() && held[static_cast<size_t>(piece)] != 0; }
};

// Appends a motion section for this many groups.
void AppendMotion(bool key, const FrameMotion& motion, int64_t groups, FrameHeader& header,
                  std::string& body);

// Reads one for a frame of this stream that has so many pieces and groups. Errors: DataLoss.
absl::StatusOr<FrameMotion> ReadMotion(bool key, const StreamHeader& stream, const Section& section,
                                       int64_t pieces, int64_t groups);

// What coder 2 begins a frame with: the history of the frame before, or the prior counts in a key
// frame; but the motion's classes, where it has any. The counts are faded already; the frame's own
// come on top.
void BeginResiduals(bool key, const NodeOrder& order, const FrameMotion& motion,
                    const ResidualHistory& history, ResidualHistory& next);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_FRAME_MOTION_H_
