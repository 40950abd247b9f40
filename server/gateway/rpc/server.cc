#include "server/gateway/rpc/server.h"

#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/grpcpp.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/resource_quota.h>
#include <signal.h>
#include <sys/stat.h>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/strings/strip.h"
#include "core/base/status.h"
#include "server/files/durable_file.h"
#include "server/gateway/asset_store.h"
#include "server/gateway/drain.h"
#include "server/gateway/executor.h"
#include "server/gateway/log.h"
#include "server/gateway/random_id.h"
#include "server/gateway/rpc/asset_service.h"
#include "server/gateway/rpc/frame_service.h"
#include "server/gateway/rpc/impurity_service.h"
#include "server/gateway/rpc/material_service.h"
#include "server/gateway/rpc/server_service.h"
#include "server/gateway/rpc/session_service.h"
#include "server/gateway/session_store.h"
#include "server/session/owner_lock.h"

namespace cleave {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int kMaxMessageBytes = 4 << 20;
// Of one answer, what our own clients take: potencies of 32 million nodes, or the affected edges of
// a body of 8 million tets.
constexpr size_t kMaxAnswerBytes = 256 << 20;
constexpr int kCheckThreads = 2;
// Pressure on senders, not a budget: what all messages in flight may hold before reads slow down.
constexpr size_t kQuotaBytes = 256 << 20;
// A peer that is gone without a word is noticed within the sum of the two.
constexpr milliseconds kKeepaliveTime{30'000};
constexpr milliseconds kKeepaliveTimeout{10'000};
constexpr milliseconds kFastestClientPings{10'000};
// How long the end may take: for viewers to take their last message, for workers to save.
constexpr milliseconds kStreamGrace{2'000};
constexpr seconds kWorkerGrace{10};

constexpr const char* kServices[] = {"cleave.v1.AssetService",    "cleave.v1.FrameService",
                                     "cleave.v1.ImpurityService", "cleave.v1.MaterialService",
                                     "cleave.v1.ServerService",   "cleave.v1.SessionService"};

// As server.proto has them.
constexpr const char* kFeatures[] = {"events",  "impurity_picture", "impurity_preview", "latest",
                                     "probe",   "region",           "render_mesh",      "rungs",
                                     "surface", "trace_drawing"};

v1::ServerInfo DescribeServer(const AssetLimits& assets) {
  v1::ServerInfo info;
  info.set_server_version(CLEAVE_VERSION);
  info.add_api_versions("cleave.v1");
  info.set_instance_id(NewUid());
  for (const char* const feature : kFeatures) info.add_features(feature);
  v1::ServerLimits& limits = *info.mutable_limits();
  limits.set_max_message_bytes(kMaxMessageBytes);
  limits.set_max_chunk_bytes(assets.max_chunk_bytes);
  limits.set_max_asset_bytes(static_cast<uint64_t>(assets.max_asset_bytes));
  limits.set_max_tets_per_session(assets.max_tets);
  limits.set_max_step_frames(kMaxStepFrames);
  limits.set_max_answer_bytes(kMaxAnswerBytes);
  return info;
}

void SetHealth(grpc::Server& server, bool serving) {
  grpc::HealthCheckServiceInterface* const health = server.GetHealthCheckService();
  health->SetServingStatus(serving);
  for (const char* service : kServices) health->SetServingStatus(service, serving);
}

void Configure(grpc::ServerBuilder& builder) {
  const auto milliseconds_of = [](milliseconds time) { return static_cast<int>(time.count()); };
  // Else a second server takes the port too, and half of the connections.
  builder.AddChannelArgument(GRPC_ARG_ALLOW_REUSEPORT, 0);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, milliseconds_of(kKeepaliveTime));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, milliseconds_of(kKeepaliveTimeout));
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_PERMIT_WITHOUT_CALLS, 1);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS,
                             milliseconds_of(kFastestClientPings));
  builder.SetMaxReceiveMessageSize(kMaxMessageBytes);
  builder.SetResourceQuota(grpc::ResourceQuota("cleaved").Resize(kQuotaBytes));
}

// gRPC would take a unix socket over from a live server: our lock goes first.
absl::StatusOr<std::optional<OwnerLock>> LockSocket(absl::string_view address) {
  if (!absl::ConsumePrefix(&address, "unix:")) return std::nullopt;
  CLEAVE_ASSIGN_OR_RETURN(OwnerLock lock, OwnerLock::Acquire(absl::StrCat(address, ".lock")));
  return lock;
}

void WaitForSignal() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGINT);
  int number = 0;
  while (sigwait(&signals, &number) != 0) {
  }
  Log(LogLevel::kInfo, "going_down", {{"signal", absl::StrCat(number)}});
}

void GoDown(grpc::Server& server, SessionStore& sessions, Drain& drain) {
  const auto begin = std::chrono::steady_clock::now();
  SetHealth(server, false);
  drain.Begin();
  sessions.Shutdown();
  const bool drained = drain.WaitUntilEmpty(kStreamGrace);
  const bool saved = sessions.WaitForWorkers(kWorkerGrace);
  server.Shutdown(std::chrono::system_clock::now() + milliseconds(200));
  const auto took =
      std::chrono::duration_cast<milliseconds>(std::chrono::steady_clock::now() - begin);
  Log(LogLevel::kInfo, "down",
      {{"milliseconds", absl::StrCat(took.count())},
       {"streams", drained ? "ended" : "cut"},
       {"workers", saved ? "saved" : "left saving"}});
}

}  // namespace

absl::Status Serve(const GatewayOptions& options) {
  CLEAVE_RETURN_IF_ERROR(MakeDirectory(options.data));
  // The server of a run that was killed may still be ending when the run is begun again.
  CLEAVE_ASSIGN_OR_RETURN(const OwnerLock data_lock,
                          OwnerLock::Acquire(options.data + "/owner", std::chrono::seconds(5)));
  CLEAVE_ASSIGN_OR_RETURN(const std::optional<OwnerLock> socket_lock, LockSocket(options.listen));

  // These live until the process ends: gRPC's own end of things is not waited for.
  auto& executor = *new Executor(options.pool_threads);
  // Mesh checks take seconds: on threads of their own they keep no stream waiting.
  auto& checks = *new Executor(kCheckThreads);
  auto& drain = *new Drain;
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<AssetStore> assets,
                          AssetStore::Open(options.data, options.assets));
  CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<SessionStore> sessions,
                          SessionStore::Open(options.data, *assets, options.workers));
  AssetService asset_service(executor, checks, *assets);
  SessionService session_service(executor, checks, *sessions, drain);
  FrameService frame_service(executor, *sessions, drain);
  ImpurityService impurity_service(checks, *assets, kMaxAnswerBytes);
  MaterialService material_service(checks);
  ServerService server_service(DescribeServer(options.assets));

  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  Configure(builder);
  int port = 0;
  builder.AddListeningPort(options.listen, grpc::InsecureServerCredentials(), &port);
  for (grpc::Service* service : std::initializer_list<grpc::Service*>{
           &asset_service, &session_service, &frame_service, &impurity_service, &material_service,
           &server_service}) {
    builder.RegisterService(service);
  }
  umask(0077);  // a unix socket is for its owner
  const std::unique_ptr<grpc::Server> server = builder.BuildAndStart();
  if (server == nullptr || port == 0) {
    sessions->Shutdown();
    return absl::UnavailableError(absl::StrCat("cannot listen on ", options.listen));
  }
  SetHealth(*server, true);
  Log(LogLevel::kInfo, "listening",
      {{"address", options.listen},
       {"port", socket_lock.has_value() ? "none" : absl::StrCat(port)},
       {"data", options.data}});
  WaitForSignal();
  GoDown(*server, *sessions, drain);
  // Leaving main would wait for gRPC's library to come to rest, now and then for ten seconds.
  _exit(0);
}

}  // namespace cleave
