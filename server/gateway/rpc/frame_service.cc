#include "server/gateway/rpc/frame_service.h"

#include <memory>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "server/gateway/errors.h"
#include "server/gateway/rpc/calls.h"
#include "server/gateway/rpc/frame_stream_call.h"

namespace cleave {
namespace {

constexpr int kDefaultPage = 1000;
constexpr int kMaxPage = 10'000;

}  // namespace

grpc::ServerWriteReactor<v1::StreamFramesResponse>* FrameService::StreamFrames(
    grpc::CallbackServerContext*, const v1::StreamFramesRequest* request) {
  const auto call = std::make_shared<FrameStreamCall>(executor_, drain_, sessions_, *request);
  call->Open();
  return call.get();
}

grpc::ServerUnaryReactor* FrameService::ListFrames(grpc::CallbackServerContext* context,
                                                   const v1::ListFramesRequest* request,
                                                   v1::ListFramesResponse* response) {
  return AnswerFrom(executor_, context, [this, request, response]() -> absl::Status {
    Faults faults;
    if (request->page_size() < 0 || request->page_size() > kMaxPage) {
      faults.Error("page_size",
                   absl::StrCat(request->page_size(), " is outside [0, ", kMaxPage, "]"));
    }
    if (request->first_frame() < 0) {
      faults.Error("first_frame", absl::StrCat(request->first_frame(), " is negative"));
    }
    if (!faults.ok()) return MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
    CLEAVE_ASSIGN_OR_RETURN(const std::shared_ptr<HostedSession> session,
                            sessions_.Find(request->session()));
    FrameLogReader& frames = session->frames();
    CLEAVE_RETURN_IF_ERROR(frames.Refresh(session->state().head_frame));
    const int limit = request->page_size() == 0 ? kDefaultPage : request->page_size();
    for (const IndexRow& row : frames.Rows(request->first_frame(), static_cast<size_t>(limit))) {
      v1::FrameEntry& entry = *response->add_frames();
      entry.set_epoch(row.epoch);
      entry.set_frame(row.frame);
      entry.set_keyframe(row.kind == FrameKind::kKey);
      entry.set_encoded_bytes(row.length);
      entry.set_state_hash(row.state_hash);
      entry.set_time(row.time);
    }
    const int64_t next = request->first_frame() + static_cast<int64_t>(response->frames_size());
    response->set_next_frame(response->frames_size() > 0 && next <= frames.head() ? next : -1);
    return absl::OkStatus();
  });
}

}  // namespace cleave
