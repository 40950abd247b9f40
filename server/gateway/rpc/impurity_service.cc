#include "server/gateway/rpc/impurity_service.h"

#include <functional>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "core/impurity/drawing.h"
#include "core/model/impurity_preview.h"
#include "core/picture/camera.h"
#include "core/picture/image.h"
#include "core/picture/impurity_picture.h"
#include "core/scene/impurity_rules.h"
#include "proto/convert/impurity_layer.h"
#include "proto/convert/impurity_preview.h"
#include "server/gateway/errors.h"
#include "server/gateway/rpc/calls.h"
#include "server/gateway/scene_intake.h"

namespace cleave {
namespace {

// As impurity.proto has it: a screen. At the tallest it takes 0.4 GB while it is drawn.
constexpr int kMaxPictureWidth = 1920;

absl::StatusOr<std::string> DrawPicture(const CheckedScene& checked, const ImpurityPreview& preview,
                                        ImpurityPictureOptions options) {
  options.title = checked.scene.name;
  options.camera.up = UpAgainst(checked.scene.gravity);
  CLEAVE_ASSIGN_OR_RETURN(
      const Image image,
      RenderImpurities(checked.mesh,
                       ImpurityShares(preview.potencies, preview.edges, preview.weakenings),
                       options));
  return EncodePng(image);
}

// `is_cancelled` may be asked at any time.
absl::Status Answer(const v1::PreviewImpurityRequest& request, AssetStore& assets, size_t max_bytes,
                    const std::function<bool()>& is_cancelled,
                    v1::PreviewImpurityResponse& response) {
  // Nobody waits for it any more, and others wait behind it.
  if (is_cancelled()) return absl::CancelledError("the client is gone");
  Faults faults;
  if (!request.scene().has_impurities())
    faults.Error("scene.impurities", "is missing; there is nothing to preview");
  const ImpurityPictureOptions picture = PictureOptionsFromMessage(request.picture());
  faults.Append("picture.", CheckImpurityPicture(picture, kMaxPictureWidth));
  CLEAVE_ASSIGN_OR_RETURN(const CheckedScene checked,
                          CheckSceneAndMesh(request.scene(), faults, assets));
  CLEAVE_ASSIGN_OR_RETURN(const ImpurityPreview preview,
                          PreviewImpurities(checked.scene, checked.mesh));
  response = MessageFromPreview(preview, request.with_edges());
  for (const std::string& warning : checked.warnings) response.add_warnings(warning);
  if (request.has_picture()) {
    if (is_cancelled()) return absl::CancelledError("the client is gone");
    absl::StatusOr<std::string> png = DrawPicture(checked, preview, picture);
    // Not Unavailable, even without a renderer: the same call would fail again.
    if (!png.ok())
      return MakeError(absl::StatusCode::kInternal, "PICTURE_FAILED", png.status().message());
    response.set_picture_png(*std::move(png));
  }
  if (const size_t bytes = response.ByteSizeLong(); bytes > max_bytes) {
    response.Clear();
    return MakeError(
        absl::StatusCode::kResourceExhausted, "MESSAGE_SIZE",
        absl::StrCat("the answer would have ", bytes, " bytes; an answer has at most ", max_bytes,
                     request.with_edges()    ? ": leave the edges out, or bake without a server"
                     : request.has_picture() ? ": leave the picture out, or bake without a server"
                                             : ": bake without a server"));
  }
  return absl::OkStatus();
}

absl::Status Trace(const v1::TraceDrawingRequest& request, v1::TraceDrawingResponse& response) {
  Faults faults;
  const ImageDrawing image = ImageFromMessage(request.image());
  CheckTracing("image.", image, faults);
  if (!image.file.empty())
    faults.Error("image.file", "is a path of the client, which sends the pixels of it");
  const int64_t width = request.width(), height = request.height();
  const auto pixels = static_cast<int64_t>(request.pixels().size());
  if (width < 1) faults.Error("width", absl::StrCat(width, " is below 1"));
  if (height < 1) faults.Error("height", absl::StrCat(height, " is below 1"));
  if (width >= 1 && height >= 1 && pixels != width * height) {
    faults.Error("pixels", absl::StrCat("has ", pixels, " bytes; ", width, " x ", height,
                                        " pixels have ", width * height));
  }
  if (!faults.ok()) return MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
  GreyRaster raster{request.width(), request.height(), {}};
  raster.values.reserve(request.pixels().size());
  for (const char pixel : request.pixels())
    raster.values.push_back(static_cast<float>(static_cast<uint8_t>(pixel)) / 255);
  const auto curves = TraceDrawing(raster, image);
  if (!curves.ok()) return MakeBadField("pixels", curves.status().message());
  WriteCurves(*curves, *response.mutable_curves());
  return absl::OkStatus();
}

}  // namespace

grpc::ServerUnaryReactor* ImpurityService::PreviewImpurity(
    grpc::CallbackServerContext* context, const v1::PreviewImpurityRequest* request,
    v1::PreviewImpurityResponse* response) {
  return AnswerFrom(checks_, context, [this, context, request, response] {
    return Answer(
        *request, assets_, max_answer_bytes_, [context] { return context->IsCancelled(); },
        *response);
  });
}

grpc::ServerUnaryReactor* ImpurityService::TraceDrawing(grpc::CallbackServerContext* context,
                                                        const v1::TraceDrawingRequest* request,
                                                        v1::TraceDrawingResponse* response) {
  return AnswerFrom(checks_, context, [context, request, response] {
    if (context->IsCancelled()) return absl::CancelledError("the client is gone");
    return Trace(*request, *response);
  });
}

}  // namespace cleave
