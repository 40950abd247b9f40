#include "server/gateway/rpc/asset_service.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/base/crc32c.h"
#include "core/base/status.h"
#include "server/gateway/errors.h"
#include "server/gateway/rpc/calls.h"

namespace cleave {
namespace {

constexpr int kMaxDigests = 4096;
constexpr int64_t kDownloadChunkBytes = 256 << 10;

// One UploadAsset call: reads a chunk, hands it to the executor, and reads the next when it is on
// disk; so a client is never ahead by more than gRPC's own window.
class UploadCall final : public grpc::ServerReadReactor<v1::UploadAssetRequest> {
 public:
  UploadCall(Executor& executor, AssetStore& assets, v1::UploadAssetResponse* response)
      : executor_(executor), assets_(assets), response_(response) {
    StartRead(&request_);
  }

  void OnReadDone(bool ok) override {
    executor_.Submit([this, ok] { ok ? TakeChunk() : Answer(CutShort()); });
  }
  void OnDone() override { delete this; }

 private:
  void TakeChunk() {
    if (const absl::Status status = Write(); !status.ok()) return Answer(status);
    if (response_->status().complete()) return Answer(absl::OkStatus());
    StartRead(&request_);
  }

  absl::Status Write() {
    if (upload_ == nullptr) {
      if (!request_.has_spec()) return MakeBadField("spec", "must be in the first message");
      CLEAVE_ASSIGN_OR_RETURN(upload_, assets_.Begin(request_.upload_id(), request_.spec()));
      if (upload_->complete()) {
        Complete({}, request_.spec().digest().size_bytes());
        return absl::OkStatus();
      }
    }
    CLEAVE_RETURN_IF_ERROR(upload_->Append(request_));
    if (!request_.finish()) return absl::OkStatus();
    CLEAVE_ASSIGN_OR_RETURN(const std::vector<std::string> warnings, upload_->Finish());
    Complete(warnings, upload_->received_bytes());
    return absl::OkStatus();
  }

  void Complete(const std::vector<std::string>& warnings, int64_t size) {
    response_->mutable_status()->set_complete(true);
    response_->mutable_status()->set_committed_size(size);
    response_->set_asset(upload_->sha256());
    response_->mutable_warnings()->Assign(warnings.begin(), warnings.end());
  }

  // A stream that ends without `finish` was cut, or held a message that does not parse: the two
  // look the same.
  absl::Status CutShort() const {
    const std::string received = absl::StrCat(upload_ ? upload_->received_bytes() : 0);
    return MakeError(absl::StatusCode::kDataLoss, "UPLOAD_CUT",
                     "the stream ended without a last message that has finish set",
                     {{"committed_size", received}});
  }

  void Answer(const absl::Status& status) {
    upload_.reset();  // here and not in OnDone: it waits for the disk
    Finish(ToRpcStatus(status));
  }

  Executor& executor_;
  AssetStore& assets_;
  v1::UploadAssetResponse* const response_;
  v1::UploadAssetRequest request_;
  std::unique_ptr<AssetStore::Upload> upload_;
};

// One DownloadAsset call.
class DownloadCall final : public grpc::ServerWriteReactor<v1::DownloadAssetResponse> {
 public:
  DownloadCall(Executor& executor, AssetStore& assets, const v1::DownloadAssetRequest& request)
      : executor_(executor), assets_(assets), request_(request) {
    executor_.Submit([this] { Answer(Open()); });
  }

  void OnWriteDone(bool ok) override {
    executor_.Submit(
        [this, ok] { Answer(ok ? absl::OkStatus() : absl::CancelledError("the client is gone")); });
  }
  void OnDone() override { delete this; }

 private:
  absl::Status Open() {
    CLEAVE_ASSIGN_OR_RETURN(file_, assets_.OpenAsset(request_.asset()));
    CLEAVE_ASSIGN_OR_RETURN(size_, FileSize(file_, request_.asset()));
    Faults faults;
    if (request_.offset() < 0 || request_.offset() > size_) {
      faults.Error("offset", absl::StrCat(request_.offset(), " is outside [0, ", size_, "]"));
    }
    if (request_.limit() < 0) {
      faults.Error("limit", absl::StrCat(request_.limit(), " is negative"));
    }
    if (!faults.ok()) return MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
    next_ = request_.offset();
    end_ = request_.limit() == 0 ? size_ : std::min(request_.limit(), size_ - next_) + next_;
    return absl::OkStatus();
  }

  // Goes on with the next chunk unless `status` or the end forbids it.
  void Answer(absl::Status status) {
    if (status.ok() && !chunk_.last()) {
      status = ReadChunk();
      if (status.ok()) return StartWrite(&chunk_);
    }
    Finish(ToRpcStatus(status));
  }

  absl::Status ReadChunk() {
    const int64_t bytes = std::min(kDownloadChunkBytes, end_ - next_);
    CLEAVE_ASSIGN_OR_RETURN(*chunk_.mutable_payload(),
                            ReadAt(file_, next_, bytes, request_.asset()));
    chunk_.set_offset(next_);
    chunk_.set_crc32c(Crc32c(chunk_.payload()));
    chunk_.set_size_bytes(size_);
    next_ += bytes;
    chunk_.set_last(next_ == end_);
    return absl::OkStatus();
  }

  Executor& executor_;
  AssetStore& assets_;
  const v1::DownloadAssetRequest request_;
  FileDescriptor file_;
  int64_t size_ = 0;
  int64_t next_ = 0;
  int64_t end_ = 0;
  v1::DownloadAssetResponse chunk_;
};

}  // namespace

grpc::ServerUnaryReactor* AssetService::FindMissingAssets(
    grpc::CallbackServerContext* context, const v1::FindMissingAssetsRequest* request,
    v1::FindMissingAssetsResponse* response) {
  return AnswerFrom(executor_, context, [this, request, response] {
    Faults faults;
    if (request->digests_size() > kMaxDigests) {
      faults.Error("digests", absl::StrCat("has ", request->digests_size(), " entries, at most ",
                                           kMaxDigests));
    }
    for (int i = 0; i < std::min(request->digests_size(), kMaxDigests); ++i) {
      const v1::Digest& digest = request->digests(i);
      if (digest.sha256().size() != 32) {
        faults.Error(absl::StrCat("digests[", i, "].sha256"),
                     absl::StrCat("has ", digest.sha256().size(), " bytes instead of 32"));
      } else if (!assets_.Has(absl::BytesToHexString(digest.sha256()))) {
        *response->add_missing() = digest;
      }
    }
    return faults.ok() ? absl::OkStatus() : MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
  });
}

grpc::ServerReadReactor<v1::UploadAssetRequest>* AssetService::UploadAsset(
    grpc::CallbackServerContext*, v1::UploadAssetResponse* response) {
  return new UploadCall(checks_, assets_, response);
}

grpc::ServerUnaryReactor* AssetService::QueryUploadStatus(
    grpc::CallbackServerContext* context, const v1::QueryUploadStatusRequest* request,
    v1::UploadStatus* response) {
  return AnswerFrom(executor_, context, [this, request, response]() -> absl::Status {
    CLEAVE_ASSIGN_OR_RETURN(*response, assets_.Query(request->upload_id()));
    return absl::OkStatus();
  });
}

grpc::ServerWriteReactor<v1::DownloadAssetResponse>* AssetService::DownloadAsset(
    grpc::CallbackServerContext*, const v1::DownloadAssetRequest* request) {
  return new DownloadCall(executor_, assets_, *request);
}

}  // namespace cleave
