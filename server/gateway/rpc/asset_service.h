#ifndef CLEAVE_SERVER_GATEWAY_RPC_ASSET_SERVICE_H_
#define CLEAVE_SERVER_GATEWAY_RPC_ASSET_SERVICE_H_

#include "cleave/v1/asset.grpc.pb.h"
#include "server/gateway/asset_store.h"
#include "server/gateway/executor.h"

namespace cleave {

// cleave.v1.AssetService. What it is given must outlive it.
class AssetService final : public v1::AssetService::CallbackService {
 public:
  // `checks` is where uploads are written and checked, `executor` where the rest is done.
  AssetService(Executor& executor, Executor& checks, AssetStore& assets)
      : executor_(executor), checks_(checks), assets_(assets) {}

  grpc::ServerUnaryReactor* FindMissingAssets(grpc::CallbackServerContext* context,
                                              const v1::FindMissingAssetsRequest* request,
                                              v1::FindMissingAssetsResponse* response) override;
  grpc::ServerReadReactor<v1::UploadAssetRequest>* UploadAsset(
      grpc::CallbackServerContext* context, v1::UploadAssetResponse* response) override;
  grpc::ServerUnaryReactor* QueryUploadStatus(grpc::CallbackServerContext* context,
                                              const v1::QueryUploadStatusRequest* request,
                                              v1::UploadStatus* response) override;
  grpc::ServerWriteReactor<v1::DownloadAssetResponse>* DownloadAsset(
      grpc::CallbackServerContext* context, const v1::DownloadAssetRequest* request) override;

 private:
  Executor& executor_;
  Executor& checks_;
  AssetStore& assets_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RPC_ASSET_SERVICE_H_
