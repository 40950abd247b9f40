#include <fcntl.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cctype>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/base/crc32c.h"
#include "core/base/sha256.h"
#include "core/base/status.h"
#include "core/mesh/mesh_check.h"
#include "core/scene/render_mesh_rules.h"
#include "proto/convert/mesh.h"
#include "server/gateway/asset_store.h"
#include "server/gateway/errors.h"

namespace cleave {
namespace {

// How much a crash may cost to send again.
constexpr int64_t kSyncBytes = 8 << 20;
constexpr int64_t kMaxSpecBytes = 4096;

bool IsUploadId(absl::string_view id) {
  return id.size() >= 8 && id.size() <= 64 && std::all_of(id.begin(), id.end(), [](char c) {
           return std::isalnum(static_cast<unsigned char>(c)) || c == '-';
         });
}

absl::Status CorruptChunk(absl::string_view what, int64_t offset) {
  return MakeError(absl::StatusCode::kDataLoss, "CHUNK_CORRUPT",
                   absl::StrCat("the chunk at byte ", offset, " ", what),
                   {{"offset", absl::StrCat(offset)}});
}

// The uncompressed bytes of a chunk, never more than it declares.
absl::StatusOr<std::string> Unpack(const v1::UploadAssetRequest& chunk,
                                   v1::Compression compression) {
  if (compression != v1::COMPRESSION_ZSTD) return chunk.payload();
  const std::string& coded = chunk.payload();
  if (ZSTD_findFrameCompressedSize(coded.data(), coded.size()) != coded.size()) {
    return CorruptChunk("is not exactly one zstd frame", chunk.offset());
  }
  std::string bytes(chunk.raw_size(), '\0');
  const size_t size = ZSTD_decompress(bytes.data(), bytes.size(), coded.data(), coded.size());
  if (ZSTD_isError(size) || size != bytes.size()) {
    return CorruptChunk(absl::StrCat("does not decompress to its ", chunk.raw_size(), " bytes"),
                        chunk.offset());
  }
  return bytes;
}

absl::Status CheckSpec(const v1::AssetSpec& spec, const AssetLimits& limits) {
  Faults faults;
  if (spec.kind() != v1::ASSET_KIND_TET_MESH && spec.kind() != v1::ASSET_KIND_RENDER_MESH) {
    faults.Error("spec.kind",
                 absl::StrCat(static_cast<int>(spec.kind()),
                              " is not a kind that can be uploaded (TET_MESH, RENDER_MESH)"));
  }
  if (spec.digest().sha256().size() != 32) {
    faults.Error("spec.digest.sha256",
                 absl::StrCat("has ", spec.digest().sha256().size(), " bytes instead of 32"));
  }
  if (spec.digest().size_bytes() < 1 || spec.digest().size_bytes() > limits.max_asset_bytes) {
    faults.Error(
        "spec.digest.size_bytes",
        absl::StrCat(spec.digest().size_bytes(), " is outside [1, ", limits.max_asset_bytes, "]"));
  }
  if (spec.compression() < v1::COMPRESSION_UNSPECIFIED ||
      spec.compression() > v1::COMPRESSION_ZSTD) {
    faults.Error("spec.compression", "is not a compression that this server knows");
  }
  return faults.ok() ? absl::OkStatus() : MakeBadRequest("PARAM_OUT_OF_RANGE", "", faults);
}

}  // namespace

AssetStore::Upload::Upload(AssetStore& store, std::string id, v1::AssetSpec spec)
    : store_(store),
      id_(std::move(id)),
      spec_(std::move(spec)),
      sha256_(absl::BytesToHexString(spec_.digest().sha256())) {}

AssetStore::Upload::~Upload() {
  // Whatever was received may be resumed; what does not reach the disk is sent again.
  if (file_.valid()) Sync().IgnoreError();
  const std::lock_guard lock(store_.mutex_);
  store_.busy_uploads_.erase(id_);
}

absl::StatusOr<std::unique_ptr<AssetStore::Upload>> AssetStore::Begin(const std::string& upload_id,
                                                                      const v1::AssetSpec& spec) {
  if (!IsUploadId(upload_id)) {
    return MakeBadField("upload_id", "must be 8 to 64 letters, digits or dashes");
  }
  CLEAVE_RETURN_IF_ERROR(CheckSpec(spec, limits_));
  {
    const std::lock_guard lock(mutex_);
    if (!busy_uploads_.insert(upload_id).second) {
      return MakeError(absl::StatusCode::kAborted, "UPLOAD_BUSY",
                       absl::StrCat("somebody else writes to upload ", upload_id));
    }
  }
  std::unique_ptr<Upload> upload(new Upload(*this, upload_id, spec));
  if (Has(upload->sha256_)) {
    upload->complete_ = true;
    return upload;
  }
  const std::string spec_bytes = spec.SerializeAsString();
  const absl::StatusOr<std::string> begun = ReadFile(upload->spec_path(), kMaxSpecBytes);
  if (absl::IsNotFound(begun.status())) {
    CLEAVE_RETURN_IF_ERROR(WriteFileDurably(upload->spec_path(), spec_bytes));
  } else if (!begun.ok()) {
    return begun.status();
  } else {
    v1::AssetSpec earlier;
    if (!earlier.ParseFromString(*begun) ||
        earlier.digest().SerializeAsString() != spec.digest().SerializeAsString() ||
        earlier.kind() != spec.kind()) {
      return MakeError(absl::StatusCode::kFailedPrecondition, "UPLOAD_MISMATCH",
                       absl::StrCat("upload ", upload_id, " was begun for another asset"));
    }
  }
  CLEAVE_ASSIGN_OR_RETURN(upload->file_, OpenFile(upload->part_path(), O_RDWR | O_CREAT));
  CLEAVE_RETURN_IF_ERROR(SyncDirectory(uploads_));
  CLEAVE_ASSIGN_OR_RETURN(upload->received_, FileSize(upload->file_, upload->part_path()));
  CLEAVE_RETURN_IF_ERROR(upload->Sync());
  return upload;
}

absl::StatusOr<v1::UploadStatus> AssetStore::Query(const std::string& upload_id) const {
  if (!IsUploadId(upload_id)) {
    return MakeBadField("upload_id", "must be 8 to 64 letters, digits or dashes");
  }
  const std::string path = uploads_ + "/" + upload_id + ".part";
  const absl::StatusOr<FileDescriptor> file = OpenFile(path, O_RDONLY);
  if (absl::IsNotFound(file.status())) {
    return MakeError(absl::StatusCode::kNotFound, "UPLOAD_UNKNOWN",
                     absl::StrCat("no upload ", upload_id, " is in progress"));
  }
  if (!file.ok()) return file.status();
  CLEAVE_ASSIGN_OR_RETURN(const int64_t size, FileSize(*file, path));
  // What is there now is made durable before anybody relies on it.
  CLEAVE_RETURN_IF_ERROR(SyncData(*file, path));
  v1::UploadStatus status;
  status.set_committed_size(size);
  return status;
}

absl::Status AssetStore::Upload::Append(const v1::UploadAssetRequest& chunk) {
  if (chunk.upload_id() != id_) {
    return MakeBadField("upload_id", "must be the same in every message");
  }
  if (chunk.raw_size() > store_.limits_.max_chunk_bytes) {
    return MakeBadField(
        "raw_size", absl::StrCat(chunk.raw_size(), " is above ", store_.limits_.max_chunk_bytes));
  }
  if (chunk.offset() != received_) {
    return MakeError(
        absl::StatusCode::kInvalidArgument, "UPLOAD_OFFSET",
        absl::StrCat("offset ", chunk.offset(), " is not where the upload is, ", received_),
        {{"committed_size", absl::StrCat(received_)}});
  }
  if (chunk.raw_size() > spec_.digest().size_bytes() - received_) {
    return MakeError(absl::StatusCode::kInvalidArgument, "UPLOAD_TOO_LONG",
                     absl::StrCat("more bytes than the declared ", spec_.digest().size_bytes()));
  }
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, Unpack(chunk, spec_.compression()));
  if (bytes.size() != chunk.raw_size()) {
    return CorruptChunk(absl::StrCat("has ", bytes.size(), " bytes, not ", chunk.raw_size()),
                        chunk.offset());
  }
  if (Crc32c(bytes) != chunk.crc32c()) {
    return CorruptChunk("does not have its crc32c", chunk.offset());
  }
  CLEAVE_RETURN_IF_ERROR(WriteAt(file_, received_, bytes, part_path()));
  received_ += static_cast<int64_t>(bytes.size());
  return received_ - synced_ >= kSyncBytes ? Sync() : absl::OkStatus();
}

absl::Status AssetStore::Upload::Sync() {
  CLEAVE_RETURN_IF_ERROR(SyncData(file_, part_path()));
  synced_ = received_;
  return absl::OkStatus();
}

absl::StatusOr<std::vector<std::string>> AssetStore::Upload::Finish() {
  if (received_ != spec_.digest().size_bytes()) {
    return MakeError(absl::StatusCode::kInvalidArgument, "UPLOAD_TOO_SHORT",
                     absl::StrCat("finished after ", received_, " of the declared ",
                                  spec_.digest().size_bytes(), " bytes"),
                     {{"committed_size", absl::StrCat(received_)}});
  }
  CLEAVE_RETURN_IF_ERROR(Sync());
  absl::StatusOr<std::vector<std::string>> warnings = Check();
  if (!warnings.ok()) {
    Discard();
    return warnings.status();
  }
  CLEAVE_RETURN_IF_ERROR(RenameDurably(part_path(), store_.PathOf(sha256_)));
  unlink(spec_path().c_str());
  file_.Close();
  complete_ = true;
  return warnings;
}

absl::StatusOr<std::vector<std::string>> AssetStore::Upload::Check() const {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadAt(file_, 0, received_, part_path()));
  if (Sha256::Of(bytes) != spec_.digest().sha256()) {
    return MakeError(absl::StatusCode::kDataLoss, "ASSET_DIGEST_MISMATCH",
                     "the bytes received do not have the declared SHA-256");
  }
  if (spec_.kind() != v1::ASSET_KIND_RENDER_MESH) return CheckMesh(bytes);
  const absl::StatusOr<RenderMesh> mesh = ParseRenderMesh(bytes);
  if (!mesh.ok()) {
    return MakeError(absl::StatusCode::kInvalidArgument, "MESH_INVALID", mesh.status().message());
  }
  const Faults faults = CheckRenderMesh(*mesh);
  if (!faults.ok()) return MakeBadRequest("MESH_INVALID", "render_mesh.", faults);
  return std::vector<std::string>();
}

absl::StatusOr<std::vector<std::string>> AssetStore::Upload::CheckMesh(
    const std::string& bytes) const {
  absl::StatusOr<TetMesh> mesh = ParseMesh(bytes);
  if (!mesh.ok()) {
    return MakeError(absl::StatusCode::kInvalidArgument, "MESH_INVALID", mesh.status().message());
  }
  if (mesh->tet_count() > store_.limits_.max_tets) {
    return MakeError(absl::StatusCode::kResourceExhausted, "TET_QUOTA",
                     absl::StrCat("the mesh has ", mesh->tet_count(), " tets; this server takes ",
                                  store_.limits_.max_tets));
  }
  const Faults faults = CheckAndOrientMesh(*mesh);
  if (!faults.ok()) return MakeBadRequest("MESH_INVALID", "mesh.", faults);
  std::vector<std::string> warnings;
  for (const Fault& warning : faults.warnings()) {
    warnings.push_back(absl::StrCat("mesh.", warning.field, ": ", warning.description));
  }
  return warnings;
}

void AssetStore::Upload::Discard() {
  file_.Close();
  unlink(part_path().c_str());
  unlink(spec_path().c_str());
}

}  // namespace cleave
