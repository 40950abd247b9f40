#ifndef CLEAVE_CLIENT_CLI_SERVER_ACCESS_H_
#define CLEAVE_CLIENT_CLI_SERVER_ACCESS_H_

#include <CLI/App.hpp>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "client/cli/interrupt.h"
#include "client/cpp/client.h"
#include "client/cpp/embedded_server.h"

namespace cleave {

// Which server a verb talks to.
struct ServerOptions {
  std::string address;          // --server, else $CLEAVE_SERVER, else empty
  double connect_seconds = 10;  // --connect-timeout
};

void AddServerOptions(CLI::App& verb, ServerOptions& options, bool required);

// A connection, and the private server behind it where none was named. The server stops with it.
struct ServerAccess {
  std::unique_ptr<EmbeddedServer> embedded;  // null: a server that was named
  std::unique_ptr<Client> client;            // destroyed first
};

// Connects to the named server; without a name starts one whose sessions live in `data_dir`.
absl::StatusOr<ServerAccess> OpenServer(const ServerOptions& options, const std::string& data_dir,
                                        Interrupt& interrupt);
// The named server only.
absl::StatusOr<std::unique_ptr<Client>> ConnectServer(const ServerOptions& options,
                                                      Interrupt& interrupt);

// A folder that is removed with all that is in it.
class TemporaryFolder {
 public:
  static absl::StatusOr<std::unique_ptr<TemporaryFolder>> Create();
  ~TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const std::string& path() const { return path_; }

 private:
  explicit TemporaryFolder(std::string path) : path_(std::move(path)) {}
  std::string path_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_SERVER_ACCESS_H_
