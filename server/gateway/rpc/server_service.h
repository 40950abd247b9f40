#ifndef CLEAVE_SERVER_GATEWAY_RPC_SERVER_SERVICE_H_
#define CLEAVE_SERVER_GATEWAY_RPC_SERVER_SERVICE_H_

#include "cleave/v1/server.grpc.pb.h"

namespace cleave {

// cleave.v1.ServerService: always the same answer.
class ServerService final : public v1::ServerService::CallbackService {
 public:
  explicit ServerService(v1::ServerInfo info) : info_(std::move(info)) {}

  grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context,
                                          const v1::GetServerInfoRequest*,
                                          v1::ServerInfo* response) override {
    *response = info_;
    grpc::ServerUnaryReactor* const reactor = context->DefaultReactor();
    reactor->Finish(grpc::Status::OK);
    return reactor;
  }

 private:
  const v1::ServerInfo info_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_SERVER_SERVICE_H_
