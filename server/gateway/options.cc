#include "server/gateway/options.h"

#include <unistd.h>

#include <filesystem>
#include <optional>
#include <system_error>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "absl/strings/strip.h"
#include "core/base/status.h"
#include "core/scene/limits.h"

namespace cleave {

const char kGatewayUsage[] =
    R"(cleaved --listen ADDRESS --data DIRECTORY [flags]

Serves Cleave sessions over gRPC. Each session has its own cleave-worker process.

  --listen ADDRESS          unix:/path/to/socket, or host:port (plaintext, this machine only)
  --data DIRECTORY          where sessions and meshes are kept
  --threads-per-worker T    threads of a session that does not say; default: all of the machine
  --worker PROGRAM          cleave-worker; default: beside this program
  --pool-threads N          threads for disk work and mesh checks; default 4
  --max-asset-bytes N       largest upload; default 1073741824
  --max-tets N              largest mesh; default 8000000
  --insecure                allow plaintext on any address: whoever reaches it may do anything
  --help, --version

SIGTERM and SIGINT end streams with a message, let workers save, and exit with code 0.
)";

namespace {

absl::Status Wrong(absl::string_view flag, absl::string_view why) {
  return absl::InvalidArgumentError(absl::StrCat("--", flag, ": ", why));
}

bool IsOwnMachine(absl::string_view host) {
  return host == "localhost" || host == "[::1]" || absl::StartsWith(host, "127.");
}

absl::Status CheckAddress(const GatewayOptions& options) {
  const absl::string_view address = options.listen;
  if (absl::StartsWith(address, "unix:")) {
    constexpr size_t kMaxSocketPath = 107;  // sockaddr_un
    const size_t size = address.size() - 5;
    if (size == 0 || size > kMaxSocketPath) {
      return Wrong("listen", absl::StrCat("the path of a unix socket has 1 to ", kMaxSocketPath,
                                          " bytes, this one ", size));
    }
    return absl::OkStatus();
  }
  const size_t colon = address.rfind(':');
  int port = 0;
  if (colon == absl::string_view::npos || colon == 0 ||
      !absl::SimpleAtoi(address.substr(colon + 1), &port) || port < 0 || port > 65535) {
    return Wrong("listen", absl::StrCat("\"", address, "\" is neither unix:/path nor host:port"));
  }
  if (!options.insecure && !IsOwnMachine(address.substr(0, colon))) {
    return Wrong("listen", absl::StrCat(address,
                                        " can be reached from other machines, in plaintext "
                                        "and without a password; --insecure allows it"));
  }
  return absl::OkStatus();
}

// build/server/gateway/cleaved has build/server/worker/cleave-worker; installed they are in one
// folder.
std::string FindWorker() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return "";
  for (const char* place :
       {"cleave-worker", "../worker/cleave-worker", "../libexec/cleave/cleave-worker"}) {
    const std::filesystem::path path = (self.parent_path() / place).lexically_normal();
    if (access(path.c_str(), X_OK) == 0) return path.string();
  }
  return "";
}

absl::Status SetNumber(absl::string_view flag, absl::string_view value, int64_t smallest,
                       int64_t largest, int64_t& number) {
  if (absl::SimpleAtoi(value, &number) && number >= smallest && number <= largest) {
    return absl::OkStatus();
  }
  return Wrong(flag,
               absl::StrCat("\"", value, "\" is not a number in [", smallest, ", ", largest, "]"));
}

absl::Status SetFlag(absl::string_view flag, absl::string_view value, GatewayOptions& options) {
  int64_t number = 0;
  if (flag == "listen") {
    options.listen = std::string(value);
  } else if (flag == "data") {
    options.data = std::string(value);
  } else if (flag == "worker") {
    options.workers.program = std::string(value);
  } else if (flag == "threads-per-worker") {
    CLEAVE_RETURN_IF_ERROR(SetNumber(flag, value, 0, 1024, number));
    options.workers.threads = static_cast<int>(number);
  } else if (flag == "pool-threads") {
    CLEAVE_RETURN_IF_ERROR(SetNumber(flag, value, 1, 1024, number));
    options.pool_threads = static_cast<int>(number);
  } else if (flag == "max-asset-bytes") {
    // What one TetMesh message can hold.
    CLEAVE_RETURN_IF_ERROR(SetNumber(flag, value, 1, (int64_t{1} << 31) - 1, number));
    options.assets.max_asset_bytes = number;
  } else if (flag == "max-tets") {
    CLEAVE_RETURN_IF_ERROR(SetNumber(flag, value, 1, limits::kMaxTets, number));
    options.assets.max_tets = number;
  } else {
    return Wrong(flag, "there is no such flag; see --help");
  }
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<GatewayOptions> ParseGatewayOptions(int argc, const char* const* argv) {
  GatewayOptions options;
  for (int i = 1; i < argc; ++i) {
    absl::string_view flag = argv[i];
    if (!absl::ConsumePrefix(&flag, "--")) {
      return absl::InvalidArgumentError(absl::StrCat("\"", flag, "\" is not a flag; see --help"));
    }
    if (flag == "insecure") {
      options.insecure = true;
    } else if (flag == "help") {
      options.help = true;
      return options;
    } else if (const size_t equals = flag.find('='); equals != absl::string_view::npos) {
      CLEAVE_RETURN_IF_ERROR(SetFlag(flag.substr(0, equals), flag.substr(equals + 1), options));
    } else {
      if (i + 1 == argc) return Wrong(flag, "needs a value");
      CLEAVE_RETURN_IF_ERROR(SetFlag(flag, argv[++i], options));
    }
  }
  if (options.listen.empty()) return Wrong("listen", "is required");
  if (options.data.empty()) return Wrong("data", "is required");
  CLEAVE_RETURN_IF_ERROR(CheckAddress(options));
  if (options.workers.program.empty()) options.workers.program = FindWorker();
  if (access(options.workers.program.c_str(), X_OK) != 0) {
    return Wrong("worker", absl::StrCat("cannot find a program cleave-worker to run",
                                        options.workers.program.empty() ? "" : " at ",
                                        options.workers.program));
  }
  return options;
}

}  // namespace cleave
