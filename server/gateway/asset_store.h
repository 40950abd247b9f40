#ifndef CLEAVE_SERVER_GATEWAY_ASSET_STORE_H_
#define CLEAVE_SERVER_GATEWAY_ASSET_STORE_H_

#include <cstdint>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cleave/v1/asset.pb.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"
#include "server/files/durable_file.h"

namespace cleave {

// Bounds of what clients may bring; ServerLimits tells them.
struct AssetLimits {
  int64_t max_asset_bytes = int64_t{1} << 30;
  uint32_t max_chunk_bytes = 1 << 20;
  // Of a mesh, uploaded or made here: checking one takes about 100 bytes a tet.
  int64_t max_tets = 8'000'000;
};

// Blobs named by the SHA-256 of their bytes (64 hex digits), and uploads on their way to become
// some. All functions wait for the disk. Thread-safe, but for one Upload, which has one user.
class AssetStore {
 public:
  // Creates what is missing below `data`: assets/ and uploads/.
  static absl::StatusOr<std::unique_ptr<AssetStore>> Open(const std::string& data,
                                                          const AssetLimits& limits);

  const AssetLimits& limits() const { return limits_; }

  bool Has(const std::string& sha256) const;
  // Only for names that are 64 lower-case hex digits.
  std::string PathOf(const std::string& sha256) const { return assets_ + "/" + sha256; }
  // NotFound (ASSET_MISSING) with the name; InvalidArgument for a name that is none.
  absl::StatusOr<FileDescriptor> OpenAsset(const std::string& sha256) const;
  // Stores bytes that the gateway made itself; the caller vouches for what they hold. Returns the
  // name.
  absl::StatusOr<std::string> Add(absl::string_view bytes);
  // The mesh of an asset, as it was uploaded. An asset of another kind than asked for is empty or
  // refused. Errors: as OpenAsset; InvalidArgument.
  absl::StatusOr<TetMesh> LoadMesh(const std::string& sha256) const;
  absl::StatusOr<RenderMesh> LoadRenderMesh(const std::string& sha256) const;

  // An upload in progress, from its first message to its end. While it lives nobody else can write
  // to the same upload.
  class Upload {
   public:
    ~Upload();
    Upload(const Upload&) = delete;
    Upload& operator=(const Upload&) = delete;

    // Name of the asset, in hex.
    const std::string& sha256() const { return sha256_; }
    // True when the store holds the asset already: nothing needs to be sent.
    bool complete() const { return complete_; }
    int64_t received_bytes() const { return received_; }

    // Writes a chunk behind the last one. Errors leave the upload as it was: InvalidArgument
    // (offset, size), DataLoss (CHUNK_CORRUPT).
    absl::Status Append(const v1::UploadAssetRequest& chunk);
    // Makes what was received durable, so that the upload can be resumed.
    absl::Status Sync();
    // Checks digest and contents and makes the asset; returns warnings. A wrong digest discards
    // what was received (DataLoss), wrong contents too (InvalidArgument with every fault).
    absl::StatusOr<std::vector<std::string>> Finish();

   private:
    friend class AssetStore;
    Upload(AssetStore& store, std::string id, v1::AssetSpec spec);
    absl::StatusOr<std::vector<std::string>> Check() const;
    absl::StatusOr<std::vector<std::string>> CheckMesh(const std::string& bytes) const;
    std::string part_path() const { return store_.uploads_ + "/" + id_ + ".part"; }
    std::string spec_path() const { return store_.uploads_ + "/" + id_ + ".spec"; }
    void Discard();

    AssetStore& store_;
    const std::string id_;
    const v1::AssetSpec spec_;
    const std::string sha256_;
    FileDescriptor file_;
    int64_t received_ = 0;
    int64_t synced_ = 0;
    bool complete_ = false;
  };

  // Begins or resumes. Errors: InvalidArgument (id, spec), Aborted (UPLOAD_BUSY: somebody else
  // writes), FailedPrecondition (UPLOAD_MISMATCH: begun with another spec).
  absl::StatusOr<std::unique_ptr<Upload>> Begin(const std::string& upload_id,
                                                const v1::AssetSpec& spec);

  // NotFound (UPLOAD_UNKNOWN) for an upload that never began or is complete.
  absl::StatusOr<v1::UploadStatus> Query(const std::string& upload_id) const;

 private:
  absl::StatusOr<std::string> Load(const std::string& sha256) const;

  AssetStore(const std::string& data, const AssetLimits& limits)
      : assets_(data + "/assets"), uploads_(data + "/uploads"), limits_(limits) {}

  const std::string assets_;
  const std::string uploads_;
  const AssetLimits limits_;
  std::mutex mutex_;
  std::set<std::string> busy_uploads_;
};

// True for 64 lower-case hex digits.
bool IsAssetName(absl::string_view name);

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_ASSET_STORE_H_
