#include "server/gateway/rpc/material_service.h"

#include "absl/status/status.h"
#include "core/base/faults.h"
#include "proto/convert/probe.h"
#include "server/gateway/errors.h"
#include "server/gateway/rpc/calls.h"

namespace cleave {

grpc::ServerUnaryReactor* MaterialService::ProbeMaterial(grpc::CallbackServerContext* context,
                                                         const v1::ProbeMaterialRequest* request,
                                                         v1::ProbeMaterialResponse* response) {
  return AnswerFrom(checks_, context, [context, request, response] {
    // Nobody waits for it any more, and others wait behind it.
    if (context->IsCancelled()) return absl::CancelledError("the client is gone");
    Faults faults;
    *response = AnswerProbe(*request, faults);
    return faults.ok() ? absl::OkStatus() : MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
  });
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
