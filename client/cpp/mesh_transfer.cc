#include "client/cpp/mesh_transfer.h"

#include <grpcpp/client_context.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "client/cpp/call_with_retry.h"
#include "client/cpp/rpc_error.h"
#include "client/cpp/stubs.h"
#include "core/base/crc32c.h"
#include "core/base/sha256.h"
#include "core/base/status.h"
#include "proto/convert/mesh.h"

namespace cleave {
namespace {

constexpr int64_t kChunkBytes = 256 << 10;
constexpr int kZstdLevel = 3;
// Above what one message can hold there is no mesh.
constexpr int64_t kMaxMeshBytes = (int64_t{1} << 31) - 1;
// A chunk should leave within this; larger meshes get more time.
constexpr std::chrono::seconds kStreamDeadline{3600};

// One attempt to bring an upload to its end from where the server has it.
class UploadAttempt {
 public:
  UploadAttempt(Client& client, v1::AssetKind kind, const std::string& bytes,
                const std::string& digest, const std::string& upload_id,
                const TransferProgress& progress)
      : client_(client),
        kind_(kind),
        bytes_(bytes),
        digest_(digest),
        id_(upload_id),
        progress_(progress) {}

  // Adds the bytes that were sent to `sent`.
  absl::StatusOr<v1::UploadAssetResponse> Run(int64_t& sent) {
    CLEAVE_ASSIGN_OR_RETURN(int64_t offset, CommittedSize());
    const int64_t total = static_cast<int64_t>(bytes_.size());
    if (offset < 0 || offset > total)
      return absl::DataLossError(
          absl::StrCat("the server claims to hold ", offset, " of ", total, " bytes of the mesh"));
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + kStreamDeadline);
    v1::UploadAssetResponse response;
    const auto writer = client_.stubs().assets->UploadAsset(&context, &response);
    bool first = true;
    do {
      CLEAVE_ASSIGN_OR_RETURN(v1::UploadAssetRequest request, Chunk(offset, first));
      first = false;
      const int64_t size = request.raw_size();
      if (client_.stop() != nullptr && client_.stop()->requested()) context.TryCancel();
      if (!writer->Write(request)) break;  // the reason comes with Finish
      offset += size;
      sent += size;
      if (progress_) progress_(offset, total);
    } while (offset < total);
    writer->WritesDone();
    CLEAVE_RETURN_IF_ERROR(StatusFromRpc(writer->Finish(), "uploading the mesh"));
    if (!response.status().complete())
      return absl::UnavailableError("uploading the mesh: the server has not all of it yet");
    return response;
  }

 private:
  absl::StatusOr<int64_t> CommittedSize() {
    v1::QueryUploadStatusRequest request;
    request.set_upload_id(id_);
    v1::UploadStatus status;
    const absl::Status result = CallWithRetry(
        client_.policy(), "asking how much of the mesh is there", client_.stop(),
        [&](grpc::ClientContext& context) {
          return client_.stubs().assets->QueryUploadStatus(&context, request, &status);
        });
    if (absl::IsNotFound(result)) return 0;
    if (!result.ok()) return result;
    return status.committed_size();
  }

  absl::StatusOr<v1::UploadAssetRequest> Chunk(int64_t offset, bool first) {
    const absl::string_view raw =
        absl::string_view(bytes_).substr(static_cast<size_t>(offset), kChunkBytes);
    v1::UploadAssetRequest request;
    request.set_upload_id(id_);
    if (first) {
      v1::AssetSpec& spec = *request.mutable_spec();
      spec.set_kind(kind_);
      spec.mutable_digest()->set_sha256(digest_);
      spec.mutable_digest()->set_size_bytes(static_cast<int64_t>(bytes_.size()));
      spec.set_compression(v1::COMPRESSION_ZSTD);
    }
    std::string& payload = *request.mutable_payload();
    payload.resize(ZSTD_compressBound(raw.size()));
    const size_t coded =
        ZSTD_compress(payload.data(), payload.size(), raw.data(), raw.size(), kZstdLevel);
    if (ZSTD_isError(coded))
      return absl::InternalError(absl::StrCat("compressing: ", ZSTD_getErrorName(coded)));
    payload.resize(coded);
    request.set_offset(offset);
    request.set_raw_size(static_cast<uint32_t>(raw.size()));
    request.set_crc32c(Crc32c(raw));
    request.set_finish(offset + static_cast<int64_t>(raw.size()) ==
                       static_cast<int64_t>(bytes_.size()));
    return request;
  }

  Client& client_;
  const v1::AssetKind kind_;
  const std::string& bytes_;
  const std::string& digest_;
  const std::string& id_;
  const TransferProgress& progress_;
};

absl::StatusOr<bool> ServerHas(Client& client, const std::string& digest, int64_t size) {
  v1::FindMissingAssetsRequest request;
  request.add_digests()->set_sha256(digest);
  request.mutable_digests(0)->set_size_bytes(size);
  v1::FindMissingAssetsResponse response;
  CLEAVE_RETURN_IF_ERROR(CallWithRetry(client.policy(), "asking whether the mesh is there",
                                       client.stop(), [&](grpc::ClientContext& context) {
                                         return client.stubs().assets->FindMissingAssets(
                                             &context, request, &response);
                                       }));
  return response.missing().empty();
}

// Reads chunks from the end of `bytes` on until the asset is whole.
absl::Status DownloadRest(Client& client, const std::string& asset, std::string& bytes,
                          const TransferProgress& progress) {
  v1::DownloadAssetRequest request;
  request.set_asset(asset);
  request.set_offset(static_cast<int64_t>(bytes.size()));
  grpc::ClientContext context;
  context.set_deadline(std::chrono::system_clock::now() + kStreamDeadline);
  const auto reader = client.stubs().assets->DownloadAsset(&context, request);
  v1::DownloadAssetResponse chunk;
  bool whole = false;
  absl::Status fault;
  while (!whole && fault.ok() && reader->Read(&chunk)) {
    const int64_t end = static_cast<int64_t>(bytes.size() + chunk.payload().size());
    if (chunk.offset() != static_cast<int64_t>(bytes.size()))
      fault = absl::DataLossError("downloading the mesh: a chunk is out of place");
    else if (chunk.crc32c() != Crc32c(chunk.payload()))
      fault = absl::UnavailableError("downloading the mesh: a chunk was damaged on its way");
    else if (end > chunk.size_bytes() || chunk.size_bytes() > kMaxMeshBytes)
      fault = absl::DataLossError("downloading the mesh: more bytes than an asset may have");
    if (!fault.ok()) break;
    bytes.append(chunk.payload());
    whole = chunk.last();
    if (progress) progress(end, chunk.size_bytes());
    if (client.stop() != nullptr && client.stop()->requested())
      fault = absl::CancelledError("downloading the mesh: stopped");
  }
  if (!fault.ok()) {
    context.TryCancel();
    reader->Finish();  // the fault is the answer; a cancelled call has nothing to add
    return fault;
  }
  CLEAVE_RETURN_IF_ERROR(StatusFromRpc(reader->Finish(), "downloading the mesh"));
  if (!whole) return absl::UnavailableError("downloading the mesh: the stream ended early");
  return absl::OkStatus();
}

absl::StatusOr<UploadedMesh> Upload(Client& client, v1::AssetKind kind, const std::string& bytes,
                                    const TransferProgress& progress) {
  const int64_t limit = static_cast<int64_t>(client.server().limits().max_asset_bytes());
  if (limit > 0 && static_cast<int64_t>(bytes.size()) > limit)
    return absl::InvalidArgumentError(absl::StrCat(
        "mesh: ", bytes.size(), " bytes are more than the ", limit, " that the server accepts"));
  const std::string digest = Sha256::Of(bytes);
  UploadedMesh uploaded;
  uploaded.asset = ToHex(digest);
  // Named after the content, so that a later process goes on where this one was killed.
  std::string upload_id = absl::StrCat("mesh-", uploaded.asset.substr(0, 40));
  bool rival_seen = false;
  for (int attempt = 1;; ++attempt) {
    CLEAVE_ASSIGN_OR_RETURN(const bool there,
                            ServerHas(client, digest, static_cast<int64_t>(bytes.size())));
    if (there) return uploaded;
    const int64_t sent_before = uploaded.bytes_sent;
    auto response =
        UploadAttempt(client, kind, bytes, digest, upload_id, progress).Run(uploaded.bytes_sent);
    if (response.ok()) {
      uploaded.warnings.assign(response->warnings().begin(), response->warnings().end());
      return uploaded;
    }
    // Someone else is sending the same mesh under the same name: send it under another.
    if (!rival_seen &&
        (absl::IsAborted(response.status()) || absl::IsAlreadyExists(response.status()) ||
         absl::IsFailedPrecondition(response.status()))) {
      rival_seen = true;
      upload_id = absl::StrCat("mesh-", NewRequestId());
      continue;
    }
    // Only attempts that get nowhere count against the limit.
    if (uploaded.bytes_sent > sent_before) attempt = 1;
    const auto delay = RetryDelay(client.policy(), attempt, response.status());
    if (!delay.has_value()) return response.status();
    if (!WaitUnlessStopped(*delay, client.stop()))
      return absl::CancelledError("uploading the mesh: stopped");
  }
}

// The bytes of an asset, checked against its name.
absl::StatusOr<std::string> Download(Client& client, const std::string& asset,
                                     const TransferProgress& progress) {
  std::string bytes;
  for (int attempt = 1;; ++attempt) {
    const size_t had = bytes.size();
    const absl::Status status = DownloadRest(client, asset, bytes, progress);
    if (status.ok()) break;
    if (bytes.size() > had) attempt = 1;
    const auto delay = RetryDelay(client.policy(), attempt, status);
    if (!delay.has_value()) return status;
    if (!WaitUnlessStopped(*delay, client.stop()))
      return absl::CancelledError("downloading the mesh: stopped");
  }
  if (ToHex(Sha256::Of(bytes)) != asset)
    return absl::DataLossError(
        absl::StrCat("mesh ", asset, ": the bytes received are not its own"));
  return bytes;
}

}  // namespace

std::string ToHex(absl::string_view bytes) { return absl::BytesToHexString(bytes); }

absl::StatusOr<UploadedMesh> UploadMesh(Client& client, const TetMesh& mesh,
                                        const TransferProgress& progress) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, SerializeMesh(mesh));
  return Upload(client, v1::ASSET_KIND_TET_MESH, bytes, progress);
}

absl::StatusOr<UploadedMesh> UploadRenderMesh(Client& client, const RenderMesh& mesh,
                                              const TransferProgress& progress) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, SerializeRenderMesh(mesh));
  return Upload(client, v1::ASSET_KIND_RENDER_MESH, bytes, progress);
}

absl::StatusOr<TetMesh> DownloadMesh(Client& client, const std::string& asset,
                                     const TransferProgress& progress) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, Download(client, asset, progress));
  return ParseMesh(bytes);
}

absl::StatusOr<RenderMesh> DownloadRenderMesh(Client& client, const std::string& asset,
                                              const TransferProgress& progress) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, Download(client, asset, progress));
  return ParseRenderMesh(bytes);
}

}  // namespace cleave
