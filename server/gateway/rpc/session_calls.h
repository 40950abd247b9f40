#ifndef CLEAVE_SERVER_GATEWAY_RPC_SESSION_CALLS_H_
#define CLEAVE_SERVER_GATEWAY_RPC_SESSION_CALLS_H_

#include <grpcpp/grpcpp.h>

#include "cleave/v1/session.pb.h"
#include "server/gateway/drain.h"
#include "server/gateway/executor.h"
#include "server/gateway/session_store.h"

namespace cleave {

// Answers StepSession once the frames are committed, or in time for the call's deadline.
grpc::ServerUnaryReactor* StartStepCall(Executor& executor, Drain& drain, SessionStore& sessions,
                                        grpc::CallbackServerContext* context,
                                        const v1::StepSessionRequest* request,
                                        v1::StepSessionResponse* response);

// Answers PauseSession once the session rests, or in time for the call's deadline.
grpc::ServerUnaryReactor* StartPauseCall(Executor& executor, Drain& drain, SessionStore& sessions,
                                         grpc::CallbackServerContext* context,
                                         const v1::PauseSessionRequest* request,
                                         v1::Session* response);

// Sends the session now and after every change.
grpc::ServerWriteReactor<v1::Session>* StartWatchCall(Executor& executor, Drain& drain,
                                                      SessionStore& sessions,
                                                      const v1::WatchSessionRequest* request);

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_SESSION_CALLS_H_
