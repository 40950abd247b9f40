#ifndef CLEAVE_CLIENT_CPP_EMBEDDED_SERVER_H_
#define CLEAVE_CLIENT_CPP_EMBEDDED_SERVER_H_

#include <sys/types.h>

#include <memory>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace cleave {

// How a private server is started.
struct EmbeddedServerOptions {
  std::string program;                 // path of cleaved; empty: found by FindServerProgram
  std::string data_dir;                // where its sessions stay; made if missing
  std::vector<std::string> arguments;  // further arguments
};

// A server of our own on a unix socket in a private folder. Its sessions live in `data_dir` and
// outlive it. It runs in a process group of its own, so that Ctrl-C reaches only us, and gets
// SIGTERM from the kernel when the thread that started it ends, however it ends: start it from a
// thread that outlives it (main's). Not thread-safe.
class EmbeddedServer {
 public:
  // Starts the program; it may not answer yet (Client::Connect waits). Errors: NotFound for the
  // program, Internal with the system's reason.
  static absl::StatusOr<std::unique_ptr<EmbeddedServer>> Start(
      const EmbeddedServerOptions& options);
  // Stops it; failures show in the server's log.
  ~EmbeddedServer();
  EmbeddedServer(const EmbeddedServer&) = delete;
  EmbeddedServer& operator=(const EmbeddedServer&) = delete;

  // What Client::Connect takes: "unix:/tmp/cleave-XXXXXX/socket".
  std::string address() const;
  // Where the server's own words go.
  const std::string& log_path() const { return log_path_; }
  pid_t pid() const { return pid_; }

  // OK while it runs; else Unavailable with how it ended and the last lines of its log.
  absl::Status Check();

  // Asks it to stop (SIGTERM), waits, and kills it when it has not ended after `patience_seconds`.
  absl::Status Stop(double patience_seconds);

 private:
  EmbeddedServer() = default;
  absl::Status Ended(int wait_status) const;

  pid_t pid_ = -1;
  std::string socket_dir_;
  std::string log_path_;
};

// cleaved beside the running program, else in the build tree's or the installation's place for it,
// else on PATH. Errors: NotFound that lists where was looked.
absl::StatusOr<std::string> FindServerProgram();

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CPP_EMBEDDED_SERVER_H_
