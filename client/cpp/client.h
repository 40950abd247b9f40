#ifndef CLEAVE_CLIENT_CPP_CLIENT_H_
#define CLEAVE_CLIENT_CPP_CLIENT_H_

#include <grpcpp/channel.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cleave/v1/asset.grpc.pb.h"
#include "cleave/v1/frame.grpc.pb.h"
#include "cleave/v1/impurity.grpc.pb.h"
#include "cleave/v1/material.grpc.pb.h"
#include "cleave/v1/server.grpc.pb.h"
#include "cleave/v1/session.grpc.pb.h"
#include "client/cpp/retry.h"

namespace cleave {

// A connection to a server and its calls. Calls are repeated where that is safe
// (RetryPolicy); errors are those of StatusFromRpc. Thread-safe.
class Client {
 public:
  // Waits for the server to answer. Errors: InvalidArgument for the address, Unavailable when
  // nothing answers within `timeout`. `stop` may be null; it ends waiting and repeating, and must
  // outlive the client.
  static absl::StatusOr<std::unique_ptr<Client>> Connect(absl::string_view address,
                                                         std::chrono::milliseconds timeout,
                                                         const StopFlag* stop);

  const std::string& address() const { return address_; }
  const v1::ServerInfo& server() const { return server_; }

  // Fills the request id when it is empty, so that a repeat cannot create a second session.
  absl::StatusOr<v1::CreateSessionResponse> CreateSession(v1::CreateSessionRequest request);
  absl::StatusOr<v1::Session> GetSession(const std::string& name);
  // All pages.
  absl::StatusOr<std::vector<v1::Session>> ListSessions();
  absl::Status DeleteSession(const std::string& name, bool allow_missing);
  absl::StatusOr<v1::Session> RunSession(const std::string& name, const v1::RunGoal& goal);
  // Steps within one call; `budget` is that call's deadline, after which fewer frames are done.
  absl::StatusOr<v1::StepSessionResponse> StepSession(const std::string& name, uint32_t frames,
                                                      int64_t expected_head,
                                                      std::chrono::milliseconds budget);
  absl::StatusOr<v1::Session> PauseSession(const std::string& name, bool abort_step);
  absl::StatusOr<v1::ListFramesResponse> ListFrames(const std::string& name, int64_t first_frame);

  absl::StatusOr<v1::ProbeMaterialResponse> ProbeMaterial(const v1::ProbeMaterialRequest& request);
  absl::StatusOr<v1::ListMaterialPresetsResponse> ListMaterialPresets();
  absl::StatusOr<v1::PreviewImpurityResponse> PreviewImpurity(
      const v1::PreviewImpurityRequest& request);

  // For the calls that stream: mesh_transfer.h, frame_stream.h.
  v1::AssetService::Stub& assets() { return *assets_; }
  v1::FrameService::Stub& frames() { return *frames_; }
  v1::SessionService::Stub& sessions() { return *sessions_; }
  const RetryPolicy& policy() const { return policy_; }
  const StopFlag* stop() const { return stop_; }

 private:
  Client(std::string address, std::shared_ptr<grpc::Channel> channel, const StopFlag* stop);

  std::string address_;
  std::shared_ptr<grpc::Channel> channel_;
  const StopFlag* stop_;
  RetryPolicy policy_;
  v1::ServerInfo server_;
  std::unique_ptr<v1::AssetService::Stub> assets_;
  std::unique_ptr<v1::FrameService::Stub> frames_;
  std::unique_ptr<v1::ImpurityService::Stub> impurities_;
  std::unique_ptr<v1::MaterialService::Stub> materials_;
  std::unique_ptr<v1::ServerService::Stub> servers_;
  std::unique_ptr<v1::SessionService::Stub> sessions_;
};

// A random id of 32 hexadecimal digits, for request ids and names that nobody else may choose.
std::string NewRequestId();

// "sessions/{id}" for an id or a full name as a person may type either.
std::string SessionName(absl::string_view id_or_name);
// The id alone.
std::string SessionId(absl::string_view id_or_name);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CPP_CLIENT_H_
