#ifndef CLEAVE_CORE_STREAM_INTERPOLATION_ENCODER_H_
#define CLEAVE_CORE_STREAM_INTERPOLATION_ENCODER_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "core/base/int4.h"
#include "core/base/vec3.h"
#include "core/stream/class_choice.h"
#include "core/stream/continuation_fit.h"
#include "core/stream/frame_header.h"
#include "core/stream/frame_motion.h"
#include "core/stream/interpolation_predictor.h"
#include "core/stream/position_chunk.h"
#include "core/stream/rans.h"
#include "core/stream/region.h"
#include "core/stream/residual_coder.h"
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

  // From the next targets on. What is not in the region may be coarser by 2 to the power of
  // `shift`.
  void SetRegion(const Region& region, int32_t shift);
  void ClearRegion() { region_.reset(); }

  // Brings stencils and pieces to the broken edges of the frame whose targets are set from these
  // positions and that follows `state`. Where that is no key frame, places that come into view get
  // a place in `state`.
  void SetBroken(bool key, std::span<const int32_t> broken, std::span<const Vec3> positions,
                 StreamState& state);

  // True if every node may stay where `state` has it, and as coarse. Precondition: no edge has
  // broken since; in a surface view or a stream with regions, SetBroken was called for the frame.
  bool AllHold(const StreamState& state);

  // Appends the motion and positions sections of that frame, a key or delta, and gives the
  // positions and the history that a decoder will have.
  void Encode(bool key, const StreamState& state, FrameHeader& header, std::string& body,
              std::vector<int32_t>& next, ResidualHistory& next_history);

  // Of each place in that frame, in streams with regions: FrameMotion::ShiftOf.
  void GetShifts(std::vector<uint8_t>& shifts) const;

  // The frame that was encoded, or a hold, is now the last.
  void Accept(FrameKind kind);

 private:
  // What is coded of a run of places; it keeps its memory from frame to frame.
  struct Chunk {
    std::vector<int32_t> moving;  // its places, where some hold
    RansWriter writer;
    PositionChunk section;
    SymbolCounts counts;
  };
  struct PlacedRegion {
    std::vector<int32_t> places;
    std::optional<std::array<Vec3, 2>> box;
    uint8_t shift;
  };
  double LargestTarget() const;
  void ChooseCoarse();
  int32_t ShiftOf(size_t place) const;
  bool ShiftsAre(const std::vector<uint8_t>& shifts) const;
  bool Stays(const StreamState& state, size_t place, int32_t shift) const;
  void ChooseHolds(const StreamState& state);
  Continuation Choose(int64_t group);
  void AppendPositions(const ResidualCoder* coder, FrameHeader& header, std::string& body,
                       ResidualHistory& next);

  StreamHeader header_;
  InterpolationPredictor predictor_;
  std::optional<PlacedRegion> region_;
  bool history_is_new_ = true;
  double tolerance_ = 0;            // m, of the targets
  LargeVector<Double4> targets_;    // grid units, by place: x, y, z, 0
  LargeVector<Int32x4> residuals_;  // steps, by place: x, y, z, 0
  std::vector<DetailSample> samples_;
  std::vector<Chunk> chunks_;
  FrameMotion motion_;
  ClassChoice class_choice_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_INTERPOLATION_ENCODER_H_
