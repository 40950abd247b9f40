#ifndef CLEAVE_SERVER_GATEWAY_WORKER_PROCESS_H_
#define CLEAVE_SERVER_GATEWAY_WORKER_PROCESS_H_

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cleave/worker/v1/control.pb.h"
#include "server/files/durable_file.h"

namespace cleave {

// One cleave-worker: its process, its control socket and the thread that reads from it and reaps
// the process at its end. Thread-safe.
class WorkerProcess {
 public:
  using Done = std::function<void(absl::Status)>;

  struct Options {
    std::string program;    // path of cleave-worker
    std::string directory;  // session directory
    int threads = 0;        // 0: the worker's default
    // Encodes this from the session's frames instead of simulating.
    std::optional<worker::v1::Encoding> encoding = std::nullopt;
  };
  // Called from the reading thread, one after the other, in the order of the worker's changes. The
  // acknowledgement of a command comes between the events before and after it.
  struct Listener {
    std::function<void(const worker::v1::Status&)> on_status;
    // The process has ended; nothing is called after it. `how` says how, for people.
    std::function<void(const std::string& how)> on_exit;
  };

  // Starts the program with posix_spawn: forking is not safe once gRPC has threads.
  static absl::StatusOr<std::shared_ptr<WorkerProcess>> Start(const Options& options,
                                                              Listener listener);
  ~WorkerProcess() = default;

  pid_t pid() const { return pid_; }

  // Sends a command; `done` is called from the reading thread with the acknowledgement, or with
  // Unavailable when the worker ends before it.
  void Send(worker::v1::Command command, Done done);

  // Asks the worker to save and exit.
  void Quit();
  // Ends it at once. It may have ended already.
  void Kill();

 private:
  WorkerProcess(pid_t pid, FileDescriptor socket, Listener listener)
      : pid_(pid), socket_(std::move(socket)), listener_(std::move(listener)) {}

  void Read();
  std::string Reap();

  const pid_t pid_;
  const FileDescriptor socket_;
  const Listener listener_;

  std::mutex mutex_;
  uint64_t last_sequence_ = 0;
  std::map<uint64_t, Done> unacknowledged_;
  bool ended_ = false;  // reaped: the pid may be somebody else's
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_WORKER_PROCESS_H_
