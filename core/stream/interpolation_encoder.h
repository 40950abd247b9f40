#ifndef CLEAVE_CORE_STREAM_INTERPOLATION_ENCODER_H_
#define CLEAVE_CORE_STREAM_INTERPOLATION_ENCODER_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "core/base/vec3.h"
#include "core/stream/frame_header.h"
#include "core/stream/frame_motion.h"
#include "core/stream/interpolation_predictor.h"
#include "core/stream/stream_header.h"
#include "core/stream/stream_state.h"

namespace cleave {

// The part of FrameEncoder that codes positions with predictor 2. Not thread-safe; loops run on the
// current TBB arena.
class InterpolationEncoder {
 public:
  InterpolationEncoder(const StreamHeader& header, const StreamMesh& mesh);

  const NodeOrder& order() const { return predictor_.order(); }
  const Stencils& stencils() const { return predictor_.stencils(); }
  const Pieces& pieces() const { return predictor_.pieces(); }

  // Takes the positions (m) of the next frame. Error, which changes nothing that matters:
  // OutOfRange for a coordinate that is not on the grid, naming the first such node.
  absl::Status SetTargets(const std::vector<Vec3>& positions, double tolerance);

  // True if every node may stay where `state` has it.
  bool AllHold(const StreamState& state) const;

  // Brings stencils and pieces to the broken edges of the frame whose targets are set and that
  // follows `state`.
  void SetBroken(std::span<const int32_t> broken, const StreamState& state);

  // Appends the motion and positions sections of that frame, a key or delta, and gives the
  // positions and the history that a decoder will have.
  void Encode(bool key, const StreamState& state, FrameHeader& header, std::string& body,
              std::vector<int32_t>& next, ResidualHistory& next_history);

  // The frame that was encoded, or a hold, is now the last.
  void Accept(FrameKind kind);

 private:
  bool Stays(const StreamState& state, size_t place) const;
  void ChooseHolds(const StreamState& state);
  Continuation Choose(int64_t group, std::span<const int32_t> next);
  void ChooseClasses();
  void AppendPositions(bool fresh, const ResidualHistory& history, FrameHeader& header,
                       std::string& body, ResidualHistory& next) const;

  StreamHeader header_;
  InterpolationPredictor predictor_;
  bool history_is_new_ = true;
  double tolerance_ = 0;            // m, of the targets
  std::vector<double> targets_;     // grid units, by place
  std::vector<int32_t> residuals_;  // steps, by place
  std::vector<uint8_t> moves_;      // by place
  FrameMotion motion_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_INTERPOLATION_ENCODER_H_
