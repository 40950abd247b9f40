#ifndef CLEAVE_CLIENT_CLI_RUN_FOLDER_H_
#define CLEAVE_CLIENT_CLI_RUN_FOLDER_H_

#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cleave/v1/scene.pb.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// What `cleave run --out DIR` leaves behind, and how it finds an earlier run again.
class RunFolder {
 public:
  explicit RunFolder(std::string path) : path_(std::move(path)) {}
  // The folder itself, or that of a recording in it.
  static RunFolder Of(const std::string& run);

  const std::string& path() const { return path_; }
  std::string frames() const { return path_ + "/frames.clv"; }           // the recording
  std::string mesh() const { return path_ + "/mesh.pb"; }                // in metres, for exporters
  std::string render_mesh() const { return path_ + "/render_mesh.pb"; }  // in metres; of some
  std::string reports() const { return path_ + "/reports.jsonl"; }       // a line a frame
  std::string events() const { return path_ + "/events.jsonl"; }         // a line an event
  std::string scene() const { return path_ + "/scene.textproto"; }       // as it was sent
  std::string session() const { return path_ + "/session"; }             // the session's name
  std::string server_data() const { return path_ + "/server"; }          // of an embedded server

  absl::Status Make() const;
  // The name of the session that an earlier run began here.
  std::optional<std::string> EarlierSession() const;
  // OK when the earlier run was of this very scene. FailedPrecondition otherwise, with the way out.
  absl::Status CheckSameScene(const v1::Scene& scene) const;
  // Notes the session before it is created, so that a crash leaves nothing unnamed.
  absl::Status Begin(const std::string& session, const v1::Scene& scene) const;
  absl::Status WriteScene(const v1::Scene& scene) const;
  absl::Status WriteMesh(const TetMesh& mesh) const;
  absl::Status WriteRenderMesh(const RenderMesh& mesh) const;
  // Removes what this class names; files of others stay.
  absl::Status Clear() const;

 private:
  std::string path_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_RUN_FOLDER_H_
