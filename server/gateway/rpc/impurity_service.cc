#include "server/gateway/rpc/impurity_service.h"

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "core/model/impurity_preview.h"
#include "proto/convert/impurity_preview.h"
#include "server/gateway/errors.h"
#include "server/gateway/rpc/calls.h"
#include "server/gateway/scene_intake.h"

namespace cleave {
namespace {

absl::Status Answer(const v1::PreviewImpurityRequest& request, AssetStore& assets, size_t max_bytes,
                    v1::PreviewImpurityResponse& response) {
  Faults faults;
  if (!request.scene().has_impurities())
    faults.Error("scene.impurities", "is missing; there is nothing to preview");
  CLEAVE_ASSIGN_OR_RETURN(const CheckedScene checked,
                          CheckSceneAndMesh(request.scene(), faults, assets));
  CLEAVE_ASSIGN_OR_RETURN(const ImpurityPreview preview,
                          PreviewImpurities(checked.scene, checked.mesh));
  response = MessageFromPreview(preview, request.with_edges());
  for (const std::string& warning : checked.warnings) response.add_warnings(warning);
  if (const size_t bytes = response.ByteSizeLong(); bytes > max_bytes) {
    response.Clear();
    return MakeError(
        absl::StatusCode::kResourceExhausted, "MESSAGE_SIZE",
        absl::StrCat("the answer would have ", bytes, " bytes; an answer has at most ", max_bytes,
                     request.with_edges() ? ": leave the edges out, or bake without a server"
                                          : ": bake without a server"));
  }
  return absl::OkStatus();
}

}  // namespace

grpc::ServerUnaryReactor* ImpurityService::PreviewImpurity(
    grpc::CallbackServerContext* context, const v1::PreviewImpurityRequest* request,
    v1::PreviewImpurityResponse* response) {
  return AnswerFrom(checks_, context, [this, context, request, response] {
    // Nobody waits for it any more, and others wait behind it.
    if (context->IsCancelled()) return absl::CancelledError("the client is gone");
    return Answer(*request, assets_, max_answer_bytes_, *response);
  });
}

}  // namespace cleave
