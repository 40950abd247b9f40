#include "client/cpp/client.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>
#include <grpcpp/support/channel_arguments.h>

#include <algorithm>
#include <random>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/strip.h"
#include "client/cpp/address.h"
#include "client/cpp/call_with_retry.h"
#include "client/cpp/rpc_error.h"
#include "client/cpp/stubs.h"
#include "core/base/status.h"

namespace cleave {
namespace {

using std::chrono::milliseconds;

constexpr char kClientVersion[] = CLEAVE_VERSION;

grpc::ChannelArguments ChannelArguments() {
  grpc::ChannelArguments arguments;
  // A peer that is gone without a word is noticed within half a minute.
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, 20'000);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 10'000);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 200);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 200);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 5'000);
  // Clients of several servers in one process must not share what they learnt of one of them.
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  // The parts that come off in one frame may take more than gRPC's 4 MiB.
  arguments.SetInt(GRPC_ARG_MAX_RECEIVE_MESSAGE_LENGTH, 256 << 20);
  // Proxies of the environment are for web pages.
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  return arguments;
}

// Of calls that make, check or bake a body, which may have millions of tets.
RetryPolicy ForBodies(RetryPolicy policy) {
  policy.call_deadline = std::chrono::minutes(5);
  return policy;
}

}  // namespace

std::string NewRequestId() {
  std::random_device random;
  std::string id;
  for (int i = 0; i < 4; ++i) absl::StrAppendFormat(&id, "%08x", random());
  return id;
}

std::string SessionId(absl::string_view id_or_name) {
  return std::string(absl::StripPrefix(id_or_name, "sessions/"));
}
std::string SessionName(absl::string_view id_or_name) {
  return absl::StrCat("sessions/", SessionId(id_or_name));
}

Client::Client(std::string address, std::unique_ptr<Stubs> stubs, const StopFlag* stop)
    : address_(std::move(address)), stubs_(std::move(stubs)), stop_(stop) {}
Client::~Client() = default;

absl::StatusOr<std::unique_ptr<Client>> Client::Connect(absl::string_view address,
                                                        milliseconds timeout,
                                                        const StopFlag* stop) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string target, ParseAddress(address));
  auto stubs = std::make_unique<Stubs>(
      grpc::CreateCustomChannel(target, grpc::InsecureChannelCredentials(), ChannelArguments()));
  std::unique_ptr<Client> client(new Client(std::string(address), std::move(stubs), stop));
  v1::GetServerInfoRequest request;
  request.set_client_version(absl::StrCat("cleave ", kClientVersion));
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  // Short attempts one after the other, so that a stop request is heard while nothing answers.
  while (true) {
    const auto left =
        std::chrono::duration_cast<milliseconds>(deadline - std::chrono::steady_clock::now());
    grpc::ClientContext context;
    context.set_wait_for_ready(true);
    context.set_deadline(std::chrono::system_clock::now() +
                         std::max(milliseconds(50), std::min(left, milliseconds(500))));
    const grpc::Status answer =
        client->stubs_->servers->GetServerInfo(&context, request, &client->server_);
    if (answer.ok()) return client;
    if (stop != nullptr && stop->requested())
      return absl::CancelledError(absl::StrCat("stopped while connecting to ", address));
    const bool again = answer.error_code() == grpc::StatusCode::DEADLINE_EXCEEDED ||
                       answer.error_code() == grpc::StatusCode::UNAVAILABLE;
    if (!again) return StatusFromRpc(answer, absl::StrCat("connecting to ", address));
    if (left <= milliseconds(500))
      return absl::UnavailableError(absl::StrCat("no server answers at ", address, " within ",
                                                 absl::StrFormat("%g", timeout.count() / 1e3),
                                                 " s"));
  }
}

absl::StatusOr<v1::CreateSessionResponse> Client::CreateSession(v1::CreateSessionRequest request) {
  if (request.request_id().empty()) request.set_request_id(NewRequestId());
  v1::CreateSessionResponse response;
  CLEAVE_RETURN_IF_ERROR(CallWithRetry(
      ForBodies(policy_), request.validate_only() ? "checking the scene" : "creating the session",
      stop_, [&](grpc::ClientContext& context) {
        return stubs_->sessions->CreateSession(&context, request, &response);
      }));
  return response;
}

absl::StatusOr<v1::Session> Client::GetSession(const std::string& name) {
  v1::GetSessionRequest request;
  request.set_name(name);
  v1::Session session;
  CLEAVE_RETURN_IF_ERROR(CallWithRetry(
      policy_, absl::StrCat("looking up ", name), stop_, [&](grpc::ClientContext& context) {
        return stubs_->sessions->GetSession(&context, request, &session);
      }));
  return session;
}

absl::StatusOr<std::vector<v1::Session>> Client::ListSessions() {
  std::vector<v1::Session> sessions;
  v1::ListSessionsRequest request;
  do {
    v1::ListSessionsResponse page;
    CLEAVE_RETURN_IF_ERROR(
        CallWithRetry(policy_, "listing sessions", stop_, [&](grpc::ClientContext& context) {
          return stubs_->sessions->ListSessions(&context, request, &page);
        }));
    for (v1::Session& session : *page.mutable_sessions()) sessions.push_back(std::move(session));
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  return sessions;
}

absl::Status Client::DeleteSession(const std::string& name, bool allow_missing) {
  v1::DeleteSessionRequest request;
  request.set_name(name);
  request.set_allow_missing(allow_missing);
  google::protobuf::Empty response;
  int attempts = 0;
  const absl::Status status = CallWithRetry(
      policy_, absl::StrCat("deleting ", name), stop_, [&](grpc::ClientContext& context) {
        ++attempts;
        return stubs_->sessions->DeleteSession(&context, request, &response);
      });
  // The attempt whose answer was lost may be the one that deleted it.
  if (attempts > 1 && absl::IsNotFound(status)) return absl::OkStatus();
  return status;
}

absl::StatusOr<v1::Session> Client::RunSession(const std::string& name, const v1::RunGoal& goal) {
  v1::RunSessionRequest request;
  request.set_name(name);
  *request.mutable_goal() = goal;
  request.set_request_id(NewRequestId());
  v1::Session session;
  CLEAVE_RETURN_IF_ERROR(CallWithRetry(
      policy_, absl::StrCat("running ", name), stop_, [&](grpc::ClientContext& context) {
        return stubs_->sessions->RunSession(&context, request, &session);
      }));
  return session;
}

absl::StatusOr<v1::StepSessionResponse> Client::StepSession(const std::string& name,
                                                            uint32_t frames, int64_t expected_head,
                                                            milliseconds budget) {
  v1::StepSessionRequest request;
  request.set_name(name);
  request.set_frames(frames);
  request.set_expected_head(expected_head);
  v1::StepSessionResponse response;
  RetryPolicy policy = policy_;
  policy.call_deadline = budget;
  CLEAVE_RETURN_IF_ERROR(CallWithRetry(
      policy, absl::StrCat("stepping ", name), stop_, [&](grpc::ClientContext& context) {
        return stubs_->sessions->StepSession(&context, request, &response);
      }));
  return response;
}

absl::StatusOr<v1::Session> Client::PauseSession(const std::string& name, bool abort_step) {
  v1::PauseSessionRequest request;
  request.set_name(name);
  request.set_abort_step(abort_step);
  v1::Session session;
  // Pausing is what a stop request leads to, so it is not itself stopped by one.
  CLEAVE_RETURN_IF_ERROR(CallWithRetry(
      policy_, absl::StrCat("pausing ", name), nullptr, [&](grpc::ClientContext& context) {
        return stubs_->sessions->PauseSession(&context, request, &session);
      }));
  return session;
}

absl::StatusOr<v1::ListFramesResponse> Client::ListFrames(const std::string& name,
                                                          int64_t first_frame) {
  v1::ListFramesRequest request;
  request.set_session(name);
  request.set_first_frame(first_frame);
  v1::ListFramesResponse response;
  CLEAVE_RETURN_IF_ERROR(CallWithRetry(policy_, absl::StrCat("listing the frames of ", name), stop_,
                                       [&](grpc::ClientContext& context) {
                                         return stubs_->frames->ListFrames(&context, request,
                                                                           &response);
                                       }));
  return response;
}

absl::StatusOr<v1::ProbeMaterialResponse> Client::ProbeMaterial(
    const v1::ProbeMaterialRequest& request) {
  v1::ProbeMaterialResponse response;
  CLEAVE_RETURN_IF_ERROR(
      CallWithRetry(policy_, "probing the material", stop_, [&](grpc::ClientContext& context) {
        return stubs_->materials->ProbeMaterial(&context, request, &response);
      }));
  return response;
}

absl::StatusOr<v1::ListMaterialPresetsResponse> Client::ListMaterialPresets() {
  v1::ListMaterialPresetsResponse response;
  CLEAVE_RETURN_IF_ERROR(
      CallWithRetry(policy_, "listing presets", stop_, [&](grpc::ClientContext& context) {
        return stubs_->materials->ListMaterialPresets(&context, {}, &response);
      }));
  return response;
}

absl::StatusOr<v1::PreviewImpurityResponse> Client::PreviewImpurity(
    const v1::PreviewImpurityRequest& request) {
  v1::PreviewImpurityResponse response;
  CLEAVE_RETURN_IF_ERROR(CallWithRetry(
      ForBodies(policy_), "previewing impurities", stop_, [&](grpc::ClientContext& context) {
        return stubs_->impurities->PreviewImpurity(&context, request, &response);
      }));
  return response;
}

}  // namespace cleave
