#ifndef CLEAVE_SERVER_GATEWAY_RPC_IMPURITY_SERVICE_H_
#define CLEAVE_SERVER_GATEWAY_RPC_IMPURITY_SERVICE_H_

#include "cleave/v1/impurity.grpc.pb.h"
#include "server/gateway/asset_store.h"
#include "server/gateway/executor.h"

namespace cleave {

// cleave.v1.ImpurityService. What it is given must outlive it.
class ImpurityService final : public v1::ImpurityService::CallbackService {
 public:
  // Calls run on `checks`; answers are at most `max_answer_bytes` large.
  ImpurityService(Executor& checks, AssetStore& assets, size_t max_answer_bytes)
      : checks_(checks), assets_(assets), max_answer_bytes_(max_answer_bytes) {}

  grpc::ServerUnaryReactor* PreviewImpurity(grpc::CallbackServerContext* context,
                                            const v1::PreviewImpurityRequest* request,
                                            v1::PreviewImpurityResponse* response) override;
  grpc::ServerUnaryReactor* TraceDrawing(grpc::CallbackServerContext* context,
                                         const v1::TraceDrawingRequest* request,
                                         v1::TraceDrawingResponse* response) override;

 private:
  Executor& checks_;
  AssetStore& assets_;
  const size_t max_answer_bytes_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_IMPURITY_SERVICE_H_
