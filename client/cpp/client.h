#ifndef CLEAVE_CLIENT_CPP_CLIENT_H_
#define CLEAVE_CLIENT_CPP_CLIENT_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cleave/v1/frame.pb.h"
#include "cleave/v1/impurity.pb.h"
#include "cleave/v1/material.pb.h"
#include "cleave/v1/server.pb.h"
#include "cleave/v1/session.pb.h"
#include "client/cpp/retry.h"

namespace cleave {

struct Stubs;

// A connection to a server and its calls. Calls are repeated where that is safe
// (RetryPolicy); errors are those of StatusFromRpc. Thread-safe.
class Client {
 public:
  ~Client();

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
  Stubs& stubs() { return *stubs_; }
  const RetryPolicy& policy() const { return policy_; }
  const StopFlag* stop() const { return stop_; }

 private:
  Client(std::string address, std::unique_ptr<Stubs> stubs, const StopFlag* stop);

  std::string address_;
  // Behind a pointer, so that who includes this does not parse gRPC: most of its users only call.
  std::unique_ptr<Stubs> stubs_;
  const StopFlag* stop_;
  RetryPolicy policy_;
  v1::ServerInfo server_;
};

// A random id of 32 hexadecimal digits, for request ids and names that nobody else may choose.
std::string NewRequestId();

// "sessions/{id}" for an id or a full name as a person may type either.
std::string SessionName(absl::string_view id_or_name);
// The id alone.
std::string SessionId(absl::string_view id_or_name);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CPP_CLIENT_H_
