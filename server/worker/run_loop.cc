#include "server/worker/run_loop.h"

#include "core/base/status.h"
#include "server/worker/failure.h"

namespace cleave {
namespace {

absl::Status CatchUp(RecordedSimulation& session, Controller& control) {
  while (session.frame() < session.head() && control.KeepGoing()) {
    const absl::Status status = session.CatchUp(control.stop());
    if (absl::IsCancelled(status)) continue;
    CLEAVE_RETURN_IF_ERROR(status);
  }
  return absl::OkStatus();
}

absl::Status FollowOrders(RecordedSimulation& session, Controller& control, bool leave_when_idle) {
  while (true) {
    CLEAVE_ASSIGN_OR_RETURN(const Order order, control.Take(session.head()));
    if (order == Order::kQuit) return session.Checkpoint();
    if (order == Order::kRest) {
      CLEAVE_RETURN_IF_ERROR(session.Checkpoint());
      if (leave_when_idle) return control.failure();
      control.Wait();
      continue;
    }
    const absl::StatusOr<FrameReport> report = session.Advance(control.stop());
    if (absl::IsCancelled(report.status())) continue;
    if (!report.ok()) {
      control.Failed(FailureOf(report.status()));
      continue;
    }
    CLEAVE_RETURN_IF_ERROR(session.Commit(*report));
    control.Committed(session.head(), ProgressOf(*report), report->new_broken_edges > 0);
  }
}

}  // namespace

absl::Status RunSession(RecordedSimulation& session, Controller& control, bool leave_when_idle) {
  if (session.head() >= 0) control.Report(v1::SESSION_STATE_RECOVERING, session.head());
  absl::Status status = session.Begin();
  if (status.ok()) status = CatchUp(session, control);
  if (status.ok()) status = FollowOrders(session, control, leave_when_idle);
  return status;
}

}  // namespace cleave
