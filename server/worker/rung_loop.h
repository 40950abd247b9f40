#ifndef CLEAVE_SERVER_WORKER_RUNG_LOOP_H_
#define CLEAVE_SERVER_WORKER_RUNG_LOOP_H_

#include "absl/status/status.h"
#include "server/files/durable_file.h"
#include "server/worker/rung_log.h"

namespace cleave {

// Encodes what the gateway says is committed, and tells it of every frame, until it says quit, is
// gone, or a signal comes (SIGTERM and SIGINT, which must be blocked). With an invalid `control`:
// what the session's log has, then returns.
absl::Status EncodeRung(RungLog& log, const FileDescriptor& control);

}  // namespace cleave

#endif  // CLEAVE_SERVER_WORKER_RUNG_LOOP_H_
