#include "server/gateway/rpc/material_service.h"

#include "absl/status/status.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "core/base/stop_flag.h"
#include "proto/convert/probe.h"
#include "server/gateway/errors.h"
#include "server/gateway/rpc/calls.h"

namespace cleave {
namespace {

// A probe that ends when nobody waits for it any more: others wait behind it.
class ProbeCall final : public grpc::ServerUnaryReactor {
 public:
  ProbeCall(Executor& executor, const v1::ProbeMaterialRequest& request,
            v1::ProbeMaterialResponse& response) {
    executor.Submit(
        [this, &request, &response] { Finish(ToRpcStatus(Answer(request, response))); });
  }

  // By the client, or at its deadline.
  void OnCancel() override { stop_.Request(); }
  void OnDone() override { delete this; }

 private:
  absl::Status Answer(const v1::ProbeMaterialRequest& request,
                      v1::ProbeMaterialResponse& response) const {
    Faults faults;
    CLEAVE_ASSIGN_OR_RETURN(response, AnswerProbe(request, stop_, faults));
    return faults.ok() ? absl::OkStatus() : MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
  }

  StopFlag stop_;
};

}  // namespace

grpc::ServerUnaryReactor* MaterialService::ProbeMaterial(grpc::CallbackServerContext* /*context*/,
                                                         const v1::ProbeMaterialRequest* request,
                                                         v1::ProbeMaterialResponse* response) {
  return new ProbeCall(checks_, *request, *response);
}

grpc::ServerUnaryReactor* MaterialService::ListMaterialPresets(
    grpc::CallbackServerContext* context, const v1::ListMaterialPresetsRequest*,
    v1::ListMaterialPresetsResponse* response) {
  return AnswerFrom(checks_, context, [response] {
    *response = PresetsMessage();
    return absl::OkStatus();
  });
}

}  // namespace cleave
