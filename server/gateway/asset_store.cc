#include "server/gateway/asset_store.h"

#include <fcntl.h>

#include <algorithm>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "core/base/sha256.h"
#include "core/base/status.h"
#include "proto/convert/mesh.h"
#include "server/gateway/errors.h"

namespace cleave {

bool IsAssetName(absl::string_view name) {
  return name.size() == 64 && std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
         });
}

absl::StatusOr<std::unique_ptr<AssetStore>> AssetStore::Open(const std::string& data,
                                                             const AssetLimits& limits) {
  std::unique_ptr<AssetStore> store(new AssetStore(data, limits));
  CLEAVE_RETURN_IF_ERROR(MakeDirectory(store->assets_));
  CLEAVE_RETURN_IF_ERROR(MakeDirectory(store->uploads_));
  return store;
}

bool AssetStore::Has(const std::string& sha256) const {
  return IsAssetName(sha256) && FileExists(PathOf(sha256));
}

absl::StatusOr<FileDescriptor> AssetStore::OpenAsset(const std::string& sha256) const {
  if (!IsAssetName(sha256)) {
    return MakeBadField("asset", absl::StrCat("\"", absl::CEscape(sha256.substr(0, 80)),
                                              "\" is not 64 lower-case hex digits"));
  }
  absl::StatusOr<FileDescriptor> file = OpenFile(PathOf(sha256), O_RDONLY);
  if (absl::IsNotFound(file.status())) {
    return MakeError(absl::StatusCode::kNotFound, "ASSET_MISSING",
                     absl::StrCat("the server has no asset ", sha256), {{"asset", sha256}});
  }
  return file;
}

absl::StatusOr<std::string> AssetStore::Add(absl::string_view bytes) {
  if (static_cast<int64_t>(bytes.size()) > limits_.max_asset_bytes) {
    return MakeError(absl::StatusCode::kResourceExhausted, "ASSET_TOO_LARGE",
                     absl::StrCat("an asset of ", bytes.size(), " bytes exceeds the limit of ",
                                  limits_.max_asset_bytes));
  }
  const std::string sha256 = absl::BytesToHexString(Sha256::Of(bytes));
  const std::lock_guard lock(mutex_);  // the same bytes may be added twice at once
  if (!Has(sha256)) CLEAVE_RETURN_IF_ERROR(WriteFileDurably(PathOf(sha256), bytes));
  return sha256;
}

absl::StatusOr<std::string> AssetStore::Load(const std::string& sha256) const {
  CLEAVE_RETURN_IF_ERROR(OpenAsset(sha256).status());
  return ReadFile(PathOf(sha256), limits_.max_asset_bytes);
}

absl::StatusOr<TetMesh> AssetStore::LoadMesh(const std::string& sha256) const {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, Load(sha256));
  return ParseMesh(bytes);
}

absl::StatusOr<RenderMesh> AssetStore::LoadRenderMesh(const std::string& sha256) const {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, Load(sha256));
  return ParseRenderMesh(bytes);
}

}  // namespace cleave
