// cleaved: serves Cleave sessions over gRPC.

#include <signal.h>

#include <cstdio>
#include <cstring>

#include "absl/status/statusor.h"
#include "server/gateway/options.h"
#include "server/gateway/rpc/server.h"

int main(int argc, char** argv) {
  if (argc == 2 && std::strcmp(argv[1], "--version") == 0) {
    std::puts("cleaved " CLEAVE_VERSION);
    return 0;
  }
#ifdef __AVX2__
  if (!__builtin_cpu_supports("avx2")) {
    std::fputs("cleaved: this build needs a processor with AVX2\n", stderr);
    return 2;
  }
#endif
  const absl::StatusOr<cleave::GatewayOptions> options = cleave::ParseGatewayOptions(argc, argv);
  if (!options.ok()) {
    std::fprintf(stderr, "cleaved: %s\n", std::string(options.status().message()).c_str());
    return 2;
  }
  if (options->help) {
    std::fputs(cleave::kGatewayUsage, stdout);
    return 0;
  }
  // Before the first gRPC object has threads: a signal that hits one of them ends the process.
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  signal(SIGPIPE, SIG_IGN);
  const absl::Status status = cleave::Serve(*options);
  std::fprintf(stderr, "cleaved: %s\n", std::string(status.message()).c_str());
  return 1;
}
