#ifndef CLEAVE_SERVER_WORKER_EVENT_MESSAGE_H_
#define CLEAVE_SERVER_WORKER_EVENT_MESSAGE_H_

#include "cleave/v1/frame.pb.h"
#include "core/simulation/simulation.h"

namespace cleave {

// What broke in a frame, as it crosses the wire.
v1::FrameEvents EventMessage(const FrameReport& report);

// The event record of frame 0: the pieces that the mesh is made of, for those who join later.
v1::FrameEvents WholePiecesMessage(const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_SERVER_WORKER_EVENT_MESSAGE_H_
