#include "client/cli/server_access.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/number_check.h"
#include "core/base/status.h"

namespace cleave {
namespace {

std::chrono::milliseconds Milliseconds(double seconds) {
  return std::chrono::milliseconds(static_cast<int64_t>(seconds * 1000));
}

}  // namespace

void AddServerOptions(CLI::App& verb, ServerOptions& options, bool required) {
  CLI::Option* address =
      verb.add_option("--server", options.address,
                      required ? "Address of the server: HOST:PORT or unix:PATH"
                               : "Address of the server: HOST:PORT or unix:PATH; without one a "
                                 "private server is started")
          ->envname("CLEAVE_SERVER")
          ->type_name("ADDRESS");
  if (required) address->required();
  verb.add_option("--connect-timeout", options.connect_seconds,
                  "How long to wait for the server to answer")
      ->type_name("SECONDS")
      ->check(NumberWithin(0.1, 3600))
      ->capture_default_str();
}

absl::StatusOr<std::unique_ptr<Client>> ConnectServer(const ServerOptions& options,
                                                      Interrupt& interrupt) {
  return Client::Connect(options.address, Milliseconds(options.connect_seconds), &interrupt.stop());
}

absl::StatusOr<ServerAccess> OpenServer(const ServerOptions& options, const std::string& data_dir,
                                        Interrupt& interrupt) {
  ServerAccess access;
  if (!options.address.empty()) {
    CLEAVE_ASSIGN_OR_RETURN(access.client, ConnectServer(options, interrupt));
    return access;
  }
  CLEAVE_ASSIGN_OR_RETURN(access.embedded, EmbeddedServer::Start({"", data_dir, {}}));
  // Attempts of a second, so that a server that could not start is noticed at once.
  for (double waited = 0;; waited += 1) {
    auto client = Client::Connect(access.embedded->address(), Milliseconds(1), &interrupt.stop());
    if (client.ok()) {
      access.client = *std::move(client);
      return access;
    }
    CLEAVE_RETURN_IF_ERROR(access.embedded->Check());
    if (!absl::IsUnavailable(client.status()) || waited >= options.connect_seconds)
      return client.status();
  }
}

absl::StatusOr<std::unique_ptr<TemporaryFolder>> TemporaryFolder::Create() {
  std::string path = (std::filesystem::temp_directory_path() / "cleave-XXXXXX").string();
  if (mkdtemp(path.data()) == nullptr)
    return absl::InternalError(absl::StrCat(path, ": ", std::strerror(errno)));
  return std::unique_ptr<TemporaryFolder>(new TemporaryFolder(path));
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

}  // namespace cleave
