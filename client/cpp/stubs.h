#ifndef CLEAVE_CLIENT_CPP_STUBS_H_
#define CLEAVE_CLIENT_CPP_STUBS_H_

#include <grpcpp/channel.h>

#include <memory>

#include "cleave/v1/asset.grpc.pb.h"
#include "cleave/v1/frame.grpc.pb.h"
#include "cleave/v1/impurity.grpc.pb.h"
#include "cleave/v1/material.grpc.pb.h"
#include "cleave/v1/server.grpc.pb.h"
#include "cleave/v1/session.grpc.pb.h"

namespace cleave {

// A server's services as gRPC generates them. None is null.
struct Stubs {
  explicit Stubs(const std::shared_ptr<grpc::Channel>& channel)
      : assets(v1::AssetService::NewStub(channel)),
        frames(v1::FrameService::NewStub(channel)),
        impurities(v1::ImpurityService::NewStub(channel)),
        materials(v1::MaterialService::NewStub(channel)),
        servers(v1::ServerService::NewStub(channel)),
        sessions(v1::SessionService::NewStub(channel)) {}

  std::unique_ptr<v1::AssetService::Stub> assets;
  std::unique_ptr<v1::FrameService::Stub> frames;
  std::unique_ptr<v1::ImpurityService::Stub> impurities;
  std::unique_ptr<v1::MaterialService::Stub> materials;
  std::unique_ptr<v1::ServerService::Stub> servers;
  std::unique_ptr<v1::SessionService::Stub> sessions;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CPP_STUBS_H_
