#ifndef CLEAVE_SERVER_GATEWAY_RPC_SESSION_SERVICE_H_
#define CLEAVE_SERVER_GATEWAY_RPC_SESSION_SERVICE_H_

#include <cstdint>

#include "cleave/v1/session.grpc.pb.h"
#include "server/gateway/drain.h"
#include "server/gateway/executor.h"
#include "server/gateway/session_store.h"

namespace cleave {

// Most frames of one StepSession call.
inline constexpr uint32_t kMaxStepFrames = 10'000;

// cleave.v1.SessionService. What it is given must outlive it.
class SessionService final : public v1::SessionService::CallbackService {
 public:
  // `checks` is where scenes are checked and meshes made, `executor` where the rest is done.
  SessionService(Executor& executor, Executor& checks, SessionStore& sessions, Drain& drain)
      : executor_(executor), checks_(checks), sessions_(sessions), drain_(drain) {}

  grpc::ServerUnaryReactor* CreateSession(grpc::CallbackServerContext* context,
                                          const v1::CreateSessionRequest* request,
                                          v1::CreateSessionResponse* response) override;
  grpc::ServerUnaryReactor* GetSession(grpc::CallbackServerContext* context,
                                       const v1::GetSessionRequest* request,
                                       v1::Session* response) override;
  grpc::ServerUnaryReactor* ListSessions(grpc::CallbackServerContext* context,
                                         const v1::ListSessionsRequest* request,
                                         v1::ListSessionsResponse* response) override;
  grpc::ServerUnaryReactor* DeleteSession(grpc::CallbackServerContext* context,
                                          const v1::DeleteSessionRequest* request,
                                          google::protobuf::Empty* response) override;
  grpc::ServerUnaryReactor* RunSession(grpc::CallbackServerContext* context,
                                       const v1::RunSessionRequest* request,
                                       v1::Session* response) override;
  grpc::ServerUnaryReactor* StepSession(grpc::CallbackServerContext* context,
                                        const v1::StepSessionRequest* request,
                                        v1::StepSessionResponse* response) override;
  grpc::ServerUnaryReactor* PauseSession(grpc::CallbackServerContext* context,
                                         const v1::PauseSessionRequest* request,
                                         v1::Session* response) override;
  grpc::ServerWriteReactor<v1::Session>* WatchSession(
      grpc::CallbackServerContext* context, const v1::WatchSessionRequest* request) override;

 private:
  Executor& executor_;
  Executor& checks_;
  SessionStore& sessions_;
  Drain& drain_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_SESSION_SERVICE_H_
