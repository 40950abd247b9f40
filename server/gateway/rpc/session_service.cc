#include "server/gateway/rpc/session_service.h"

#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/scene/limits.h"
#include "core/scene/scene.h"
#include "server/gateway/errors.h"
#include "server/gateway/rpc/calls.h"
#include "server/gateway/rpc/session_calls.h"

namespace cleave {
namespace {

constexpr int kDefaultPage = 100;
constexpr int kMaxPage = 1000;
constexpr size_t kMaxRequestIdBytes = 128;

absl::Status CheckRun(const v1::RunSessionRequest& request) {
  Faults faults;
  const v1::RunGoal& goal = request.goal();
  if (goal.until_frame() < 0 || goal.until_frame() > limits::kMaxFrames) {
    faults.Error("goal.until_frame",
                 absl::StrCat(goal.until_frame(), " is outside [0, ", limits::kMaxFrames, "]"));
  }
  if (goal.wall_budget().seconds() < 0 || goal.wall_budget().nanos() < 0) {
    faults.Error("goal.wall_budget", "is negative");
  }
  if (request.request_id().size() > kMaxRequestIdBytes) {
    faults.Error("request_id", absl::StrCat("has more than ", kMaxRequestIdBytes, " bytes"));
  }
  return faults.ok() ? absl::OkStatus() : MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
}

}  // namespace

grpc::ServerUnaryReactor* SessionService::CreateSession(grpc::CallbackServerContext* context,
                                                        const v1::CreateSessionRequest* request,
                                                        v1::CreateSessionResponse* response) {
  return AnswerFrom(checks_, context, [this, request, response]() -> absl::Status {
    CLEAVE_ASSIGN_OR_RETURN(*response, sessions_.Create(*request));
    return absl::OkStatus();
  });
}

grpc::ServerUnaryReactor* SessionService::GetSession(grpc::CallbackServerContext* context,
                                                     const v1::GetSessionRequest* request,
                                                     v1::Session* response) {
  return AnswerFrom(executor_, context, [this, request, response]() -> absl::Status {
    CLEAVE_ASSIGN_OR_RETURN(const std::shared_ptr<HostedSession> session,
                            sessions_.Find(request->name()));
    *response = session->View(/*with_scene=*/true);
    return absl::OkStatus();
  });
}

grpc::ServerUnaryReactor* SessionService::ListSessions(grpc::CallbackServerContext* context,
                                                       const v1::ListSessionsRequest* request,
                                                       v1::ListSessionsResponse* response) {
  return AnswerFrom(executor_, context, [this, request, response] {
    if (request->page_size() < 0 || request->page_size() > kMaxPage) {
      return MakeBadField("page_size",
                          absl::StrCat(request->page_size(), " is outside [0, ", kMaxPage, "]"));
    }
    const int limit = request->page_size() == 0 ? kDefaultPage : request->page_size();
    bool more = false;
    // A page token is the last id of the page before.
    for (const auto& session :
         sessions_.List(request->page_token(), static_cast<size_t>(limit), more)) {
      *response->add_sessions() = session->View(/*with_scene=*/false);
      if (more) response->set_next_page_token(session->config().session_id());
    }
    return absl::OkStatus();
  });
}

grpc::ServerUnaryReactor* SessionService::DeleteSession(grpc::CallbackServerContext* context,
                                                        const v1::DeleteSessionRequest* request,
                                                        google::protobuf::Empty*) {
  grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
  executor_.Submit([this, request, reactor] {
    sessions_.Delete(request->name(), [allow_missing = request->allow_missing(),
                                       reactor](const absl::Status& status) {
      const bool missing = allow_missing && absl::IsNotFound(status);
      reactor->Finish(missing ? grpc::Status::OK : ToRpcStatus(status));
    });
  });
  return reactor;
}

grpc::ServerUnaryReactor* SessionService::RunSession(grpc::CallbackServerContext* context,
                                                     const v1::RunSessionRequest* request,
                                                     v1::Session* response) {
  grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
  executor_.Submit([this, request, response, reactor] {
    if (const absl::Status status = CheckRun(*request); !status.ok()) {
      return reactor->Finish(ToRpcStatus(status));
    }
    const absl::StatusOr<std::shared_ptr<HostedSession>> session = sessions_.Find(request->name());
    if (!session.ok()) return reactor->Finish(ToRpcStatus(session.status()));
    v1::RunGoal goal = request->goal();
    if (goal.until_frame() == 0) {
      const v1::Timing& timing = (*session)->config().scene().timing();
      goal.set_until_frame(timing.has_frame_count() ? timing.frame_count() : Timing().frame_count);
    }
    (*session)->Run(goal, request->request_id(),
                    [held = *session, response, reactor](const absl::Status& status) {
                      if (status.ok()) *response = held->View(/*with_scene=*/false);
                      reactor->Finish(ToRpcStatus(status));
                    });
  });
  return reactor;
}

grpc::ServerUnaryReactor* SessionService::StepSession(grpc::CallbackServerContext* context,
                                                      const v1::StepSessionRequest* request,
                                                      v1::StepSessionResponse* response) {
  return StartStepCall(executor_, drain_, sessions_, context, request, response);
}

grpc::ServerUnaryReactor* SessionService::PauseSession(grpc::CallbackServerContext* context,
                                                       const v1::PauseSessionRequest* request,
                                                       v1::Session* response) {
  return StartPauseCall(executor_, drain_, sessions_, context, request, response);
}

grpc::ServerWriteReactor<v1::Session>* SessionService::WatchSession(
    grpc::CallbackServerContext*, const v1::WatchSessionRequest* request) {
  return StartWatchCall(executor_, drain_, sessions_, request);
}

}  // namespace cleave
