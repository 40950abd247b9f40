#ifndef CLEAVE_SERVER_GATEWAY_FRAME_CHOICE_H_
#define CLEAVE_SERVER_GATEWAY_FRAME_CHOICE_H_

#include <optional>

#include "absl/status/statusor.h"
#include "cleave/v1/frame.pb.h"
#include "cleave/worker/v1/control.pb.h"
#include "core/base/faults.h"
#include "core/stream/rungs.h"
#include "core/stream/stream_header.h"

namespace cleave {

// Which of a session's frames a viewer is given. Tolerances are against the simulation.
struct FrameChoice {
  std::optional<Rung> rung;                      // absent: a tolerance that is no rung's
  double tolerance = 0;                          // m
  double outside_tolerance = 0;                  // m, outside of the region; 0: there is none
  std::optional<worker::v1::Encoding> encoding;  // absent: the frames as they are kept
};

// What can be wrong with a request's accuracy and region whatever the session.
void CheckFrameChoice(const v1::StreamFramesRequest& request, Faults& faults);

// Chooses for a request whose frames are kept in this stream. Precondition: CheckFrameChoice found
// nothing. Errors, for the client: FailedPrecondition (FINER_THAN_KEPT), InvalidArgument
// (PARAM_OUT_OF_RANGE).
absl::StatusOr<FrameChoice> ChooseFrames(const v1::StreamFramesRequest& request,
                                         const StreamHeader& kept);

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_FRAME_CHOICE_H_
