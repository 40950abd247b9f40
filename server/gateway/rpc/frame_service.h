#ifndef CLEAVE_SERVER_GATEWAY_RPC_FRAME_SERVICE_H_
#define CLEAVE_SERVER_GATEWAY_RPC_FRAME_SERVICE_H_

#include "cleave/v1/frame.grpc.pb.h"
#include "server/gateway/drain.h"
#include "server/gateway/executor.h"
#include "server/gateway/session_store.h"

namespace cleave {

// cleave.v1.FrameService. What it is given must outlive it.
class FrameService final : public v1::FrameService::CallbackService {
 public:
  FrameService(Executor& executor, SessionStore& sessions, Drain& drain)
      : executor_(executor), sessions_(sessions), drain_(drain) {}

  grpc::ServerWriteReactor<v1::StreamFramesResponse>* StreamFrames(
      grpc::CallbackServerContext* context, const v1::StreamFramesRequest* request) override;
  grpc::ServerUnaryReactor* ListFrames(grpc::CallbackServerContext* context,
                                       const v1::ListFramesRequest* request,
                                       v1::ListFramesResponse* response) override;

 private:
  Executor& executor_;
  SessionStore& sessions_;
  Drain& drain_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_FRAME_SERVICE_H_
