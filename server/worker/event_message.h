#ifndef CLEAVE_SERVER_WORKER_EVENT_MESSAGE_H_
#define CLEAVE_SERVER_WORKER_EVENT_MESSAGE_H_

#include "cleave/v1/frame.pb.h"
#include "core/simulation/simulation.h"

namespace cleave {

// What broke in a frame, as it crosses the wire.
v1::FrameEvents EventMessage(const FrameReport& report);

}  // namespace cleave

#endif  // CLEAVE_SERVER_WORKER_EVENT_MESSAGE_H_
