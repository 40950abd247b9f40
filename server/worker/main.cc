// cleave-worker: turns a session directory that holds a scene into one that also holds frames.

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/string_view.h"
#include "cleave/worker/v1/control.pb.h"
#include "core/base/status.h"
#include "core/stream/rungs.h"
#include "server/control/message_socket.h"
#include "server/files/durable_file.h"
#include "server/session/encoding.h"
#include "server/session/frame_log.h"
#include "server/session/journal.h"
#include "server/session/owner_lock.h"
#include "server/session/session_paths.h"
#include "server/worker/controller.h"
#include "server/worker/failure.h"
#include "server/worker/recorded_simulation.h"
#include "server/worker/run_loop.h"
#include "server/worker/rung_log.h"
#include "server/worker/rung_loop.h"
#include "server/worker/session_inputs.h"

namespace cleave {
namespace {

constexpr char kUsage[] =
    R"(cleave-worker DIRECTORY [--rung RUNG | --encoding HEX] [--threads T] [--control-fd N]

Simulates the session in DIRECTORY up to its scene's frame count and exits. Started again on the
same directory it goes on behind the last committed frame. SIGTERM and SIGINT save and exit.

  --rung RUNG      encode the frames that are there more coarsely (preview, standard, fine) instead
  --encoding HEX   the same as this cleave.worker.v1.Encoding says (the gateway does so)
  --threads T      threads to use; without it what the session says, else all of the machine
  --control-fd N   take commands from this socket instead (the gateway does so)
)";

struct Arguments {
  std::string directory;
  int threads = 0;
  int control_fd = -1;
  std::optional<Rung> rung;
  std::optional<worker::v1::Encoding> encoding;
};

bool ParseArguments(int argc, char** argv, Arguments& arguments) {
  for (int i = 1; i < argc; ++i) {
    const absl::string_view argument = argv[i];
    int* number = argument == "--threads"      ? &arguments.threads
                  : argument == "--control-fd" ? &arguments.control_fd
                                               : nullptr;
    if (argument == "--rung") {
      if (++i == argc) return false;
      arguments.rung = ParseRung(argv[i]);
      if (!arguments.rung.has_value()) return false;
    } else if (argument == "--encoding") {
      if (++i == argc ||
          !arguments.encoding.emplace().ParseFromString(absl::HexStringToBytes(argv[i])))
        return false;
    } else if (number != nullptr) {
      if (++i == argc || !absl::SimpleAtoi(argv[i], number) || *number < 0) return false;
    } else if (arguments.directory.empty() && argument.substr(0, 1) != "-") {
      arguments.directory = std::string(argument);
    } else {
      return false;
    }
  }
  return !arguments.directory.empty();
}

// A worker that lost its gateway may still be saving when the next one starts: wait for it, but not
// longer than our own gateway wants us.
absl::StatusOr<OwnerLock> WaitForLock(const std::string& path, const FileDescriptor& control) {
  constexpr int kPollMilliseconds = 20;
  while (true) {
    absl::StatusOr<OwnerLock> lock = OwnerLock::Acquire(path);
    if (!absl::IsUnavailable(lock.status()) || !control.valid()) return lock;
    pollfd hung_up = {control.get(), POLLRDHUP, 0};
    if (poll(&hung_up, 1, kPollMilliseconds) > 0) return lock;
  }
}

absl::Status Simulate(const SessionPaths& paths, const Arguments& arguments, Controller& control,
                      bool batch) {
  CLEAVE_ASSIGN_OR_RETURN(SessionInputs inputs, LoadSessionInputs(paths));
  int threads = arguments.threads > 0 ? arguments.threads : inputs.threads;
  if (threads == 0) threads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism,
                                        static_cast<size_t>(threads));
  if (batch) CLEAVE_RETURN_IF_ERROR(control.RunTo(inputs.scene.timing.frame_count));
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<RecordedSimulation> session,
                          RecordedSimulation::Open(paths, std::move(inputs), threads));
  return RunSession(*session, control, batch);
}

absl::StatusOr<worker::v1::Encoding> EncodingOf(const SessionPaths& paths,
                                                const Arguments& arguments) {
  if (arguments.encoding.has_value()) return *arguments.encoding;
  CLEAVE_ASSIGN_OR_RETURN(const std::string kept, FrameLogReader(paths.frames()).ReadHeader());
  CLEAVE_ASSIGN_OR_RETURN(const StreamHeader header, ParseStreamHeader(kept));
  return EncodingOfRung(*arguments.rung, /*surface=*/false, header);
}

absl::Status FollowSession(const SessionPaths& paths, const Arguments& arguments,
                           const FileDescriptor& control) {
  CLEAVE_ASSIGN_OR_RETURN(const worker::v1::Encoding encoding, EncodingOf(paths, arguments));
  CLEAVE_RETURN_IF_ERROR(MakeDirectory(paths.rungs()));
  CLEAVE_ASSIGN_OR_RETURN(const OwnerLock lock,
                          WaitForLock(paths.rung_owner(encoding.name()), control));
  CLEAVE_ASSIGN_OR_RETURN(const SessionInputs inputs, LoadSessionInputs(paths));
  // One thread unless told otherwise: the cores are the simulation's.
  const tbb::global_control parallelism(tbb::global_control::max_allowed_parallelism,
                                        static_cast<size_t>(std::max(1, arguments.threads)));
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<RungLog> log,
                          RungLog::Open(paths, inputs, encoding));
  return EncodeRung(*log, control);
}

absl::Status WorkOnRung(const Arguments& arguments) {
  const FileDescriptor control(arguments.control_fd);
  absl::Status status;
  try {
    status = FollowSession({arguments.directory}, arguments, control);
  } catch (const std::bad_alloc&) {
    status = absl::InternalError("the machine has not enough memory for this rung");
  }
  if (!status.ok() && control.valid()) {
    worker::v1::Event event;
    event.mutable_status()->set_state(v1::SESSION_STATE_FAILED);
    *event.mutable_status()->mutable_error() = FailureOf(status);
    SendMessage(control, event).IgnoreError();
  }
  return status;
}

absl::Status Work(const Arguments& arguments) {
  const SessionPaths paths{arguments.directory};
  FileDescriptor socket(arguments.control_fd);
  const bool batch = !socket.valid();
  CLEAVE_ASSIGN_OR_RETURN(const OwnerLock lock, WaitForLock(paths.owner(), socket));
  CLEAVE_ASSIGN_OR_RETURN(const JournalContents journal, ReadJournal(paths.journal()));
  CLEAVE_ASSIGN_OR_RETURN(JournalWriter writer, JournalWriter::Open(paths.journal(), journal));
  Controller control(std::move(socket));
  CLEAVE_RETURN_IF_ERROR(control.Start(std::move(writer), SummariseJournal(journal.records)));
  absl::Status status;
  try {
    status = Simulate(paths, arguments, control, batch);
  } catch (const std::bad_alloc&) {
    status = absl::InternalError("the machine has not enough memory for this session");
  }
  if (!status.ok()) control.Failed(FailureOf(status));
  return status;
}

}  // namespace
}  // namespace cleave

int main(int argc, char** argv) {
  cleave::Arguments arguments;
  if (!cleave::ParseArguments(argc, argv, arguments)) {
    std::fputs(cleave::kUsage, stderr);
    return 2;
  }
#ifdef __AVX2__
  if (!__builtin_cpu_supports("avx2")) {
    std::fputs("cleave-worker: this build needs a processor with AVX2\n", stderr);
    return 2;
  }
#endif
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
  const absl::Status status = arguments.rung.has_value() || arguments.encoding.has_value()
                                  ? cleave::WorkOnRung(arguments)
                                  : cleave::Work(arguments);
  if (status.ok()) return 0;
  std::fprintf(stderr, "cleave-worker: %s: %s\n", arguments.directory.c_str(),
               status.ToString().c_str());
  return 1;
}
