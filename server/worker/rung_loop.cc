#include "server/worker/rung_loop.h"

#include <poll.h>
#include <signal.h>
#include <sys/signalfd.h>

#include <cerrno>
#include <limits>

#include "cleave/worker/v1/control.pb.h"
#include "core/base/status.h"
#include "server/control/message_socket.h"

namespace cleave {
namespace {

// A gateway that is gone shows as the end of the socket.
void SendHead(const FileDescriptor& control, const RungLog& log) {
  if (!control.valid()) return;
  worker::v1::Event event;
  event.mutable_status()->set_head_frame(log.head());
  SendMessage(control, event).IgnoreError();
}

void Acknowledge(const FileDescriptor& control, const worker::v1::Command& command) {
  worker::v1::Event event;
  event.mutable_acknowledged()->set_sequence(command.sequence());
  SendMessage(control, event).IgnoreError();
}

}  // namespace

absl::Status EncodeRung(RungLog& log, const FileDescriptor& control) {
  sigset_t stops;
  sigemptyset(&stops);
  sigaddset(&stops, SIGTERM);
  sigaddset(&stops, SIGINT);
  const FileDescriptor signals(signalfd(-1, &stops, SFD_CLOEXEC));
  if (!signals.valid()) return absl::ErrnoToStatus(errno, "cannot listen for signals");
  if (!control.valid()) CLEAVE_RETURN_IF_ERROR(log.Follow(std::numeric_limits<int64_t>::max()));
  SendHead(control, log);
  pollfd watched[2] = {{signals.get(), POLLIN, 0}, {control.get(), POLLIN, 0}};
  while (control.valid() || log.behind()) {
    if (poll(watched, control.valid() ? 2 : 1, log.behind() ? 0 : -1) < 0 && errno != EINTR)
      return absl::ErrnoToStatus(errno, "cannot listen to the gateway");
    if (watched[0].revents != 0) return absl::OkStatus();
    if (control.valid() && watched[1].revents != 0) {
      worker::v1::Command command;
      if (!ReceiveMessage(control, command).ok() || command.has_quit()) return absl::OkStatus();
      if (command.has_follow()) CLEAVE_RETURN_IF_ERROR(log.Follow(command.follow().head_frame()));
      Acknowledge(control, command);
    } else if (log.behind()) {
      CLEAVE_RETURN_IF_ERROR(log.EncodeNext());
      SendHead(control, log);
    }
  }
  return absl::OkStatus();
}

}  // namespace cleave
