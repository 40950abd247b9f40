#ifndef CLEAVE_SERVER_GATEWAY_OPTIONS_H_
#define CLEAVE_SERVER_GATEWAY_OPTIONS_H_

#include <string>

#include "absl/status/statusor.h"
#include "server/gateway/asset_store.h"
#include "server/gateway/hosted_session.h"

namespace cleave {

// How cleaved is to run.
struct GatewayOptions {
  std::string listen;  // "unix:/path" or "host:port"
  std::string data;    // directory of sessions and assets
  bool insecure = false;
  bool help = false;
  int pool_threads = 4;
  AssetLimits assets;
  WorkerOptions workers;
};

// What --help prints.
extern const char kGatewayUsage[];

// Reads "--name value" and "--name=value". The worker program is looked for beside the running one
// where no flag names it. Errors: InvalidArgument naming the flag; plaintext on an address that is
// not this machine's own needs --insecure.
absl::StatusOr<GatewayOptions> ParseGatewayOptions(int argc, const char* const* argv);

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_OPTIONS_H_
