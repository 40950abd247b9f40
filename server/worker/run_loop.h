#ifndef CLEAVE_SERVER_WORKER_RUN_LOOP_H_
#define CLEAVE_SERVER_WORKER_RUN_LOOP_H_

#include "absl/status/status.h"
#include "server/worker/controller.h"
#include "server/worker/recorded_simulation.h"

namespace cleave {

// Brings the simulation to the committed head, then follows orders until told to quit, or until
// there is nothing to do when `leave_when_idle`. On the way out it saves a checkpoint. Errors end
// the run: they have been told to the gateway, and the directory is whole.
absl::Status RunSession(RecordedSimulation& session, Controller& control, bool leave_when_idle);

}  // namespace cleave

#endif  // CLEAVE_SERVER_WORKER_RUN_LOOP_H_
