#ifndef CLEAVE_SERVER_GATEWAY_RPC_MATERIAL_SERVICE_H_
#define CLEAVE_SERVER_GATEWAY_RPC_MATERIAL_SERVICE_H_

#include "cleave/v1/material.grpc.pb.h"
#include "server/gateway/executor.h"

namespace cleave {

// cleave.v1.MaterialService. What it is given must outlive it.
class MaterialService final : public v1::MaterialService::CallbackService {
 public:
  // Probes run on `checks`, each within the time that the limits of a probe leave it.
  explicit MaterialService(Executor& checks) : checks_(checks) {}

  grpc::ServerUnaryReactor* ProbeMaterial(grpc::CallbackServerContext* context,
                                          const v1::ProbeMaterialRequest* request,
                                          v1::ProbeMaterialResponse* response) override;
  grpc::ServerUnaryReactor* ListMaterialPresets(grpc::CallbackServerContext* context,
                                                const v1::ListMaterialPresetsRequest* request,
                                                v1::ListMaterialPresetsResponse* response) override;

 private:
  Executor& checks_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_MATERIAL_SERVICE_H_
