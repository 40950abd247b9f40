#ifndef CLEAVE_SERVER_SESSION_CONFIG_H_
#define CLEAVE_SERVER_SESSION_CONFIG_H_

#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "cleave/worker/v1/records.pb.h"
#include "server/session/session_paths.h"

namespace cleave {

// Lays out an empty session directory at `paths.root`, durably: its folders, and config.pb last, so
// that a directory with a config is whole.
absl::Status CreateSessionDirectory(const SessionPaths& paths,
                                    const worker::v1::SessionConfig& config);

// Errors: NotFound; DataLoss when config.pb is damaged.
absl::StatusOr<worker::v1::SessionConfig> ReadSessionConfig(const SessionPaths& paths);

// Where the mesh asset of a session is: in the directory's own assets/ (a packed directory carries
// its inputs) or in the assets/ beside the sessions. NotFound names both.
absl::StatusOr<std::string> FindSessionAsset(const SessionPaths& paths, const std::string& sha256);

}  // namespace cleave

#endif  // CLEAVE_SERVER_SESSION_CONFIG_H_
