#include "server/session/config.h"

#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"
#include "core/base/crc32c.h"
#include "core/base/status.h"
#include "server/files/durable_file.h"

namespace cleave {
namespace {

// A scene is at most one message on the wire; the rest of the config is small.
constexpr int64_t kMaxConfigBytes = 64 << 20;
constexpr uint32_t kMagic = 0x43564C43;  // "CLVC"

}  // namespace

absl::Status CreateSessionDirectory(const SessionPaths& paths,
                                    const worker::v1::SessionConfig& config) {
  CLEAVE_RETURN_IF_ERROR(MakeDirectory(paths.root));
  CLEAVE_RETURN_IF_ERROR(MakeDirectory(paths.frames()));
  CLEAVE_RETURN_IF_ERROR(MakeDirectory(paths.checkpoints()));
  const std::string message = config.SerializeAsString();
  std::string bytes;
  ByteWriter writer(bytes);
  writer.Put<uint32_t>(kMagic);
  writer.Put<uint32_t>(Crc32c(message));
  writer.PutBytes(message);
  return WriteFileDurably(paths.config(), bytes);
}

absl::StatusOr<worker::v1::SessionConfig> ReadSessionConfig(const SessionPaths& paths) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFile(paths.config(), kMaxConfigBytes));
  ByteReader reader(bytes);
  const uint32_t magic = reader.Get<uint32_t>();
  const uint32_t crc = reader.Get<uint32_t>();
  const absl::string_view message = reader.GetBytes(reader.left());
  worker::v1::SessionConfig config;
  if (!reader.ok() || magic != kMagic || crc != Crc32c(message) ||
      !config.ParseFromArray(message.data(), static_cast<int>(message.size()))) {
    return absl::DataLossError(absl::StrCat(paths.config(), " is damaged"));
  }
  return config;
}

absl::StatusOr<std::string> FindSessionAsset(const SessionPaths& paths, const std::string& sha256) {
  const std::string own = absl::StrCat(paths.root, "/assets/", sha256);
  const std::string shared = absl::StrCat(paths.root, "/../../assets/", sha256);
  if (FileExists(own)) return own;
  if (FileExists(shared)) return shared;
  return absl::NotFoundError(absl::StrCat("the mesh is neither at ", own, " nor at ", shared));
}

}  // namespace cleave
