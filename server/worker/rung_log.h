#ifndef CLEAVE_SERVER_WORKER_RUNG_LOG_H_
#define CLEAVE_SERVER_WORKER_RUNG_LOG_H_

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/base/vec3.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_encoder.h"
#include "core/stream/region.h"
#include "server/session/encoding.h"
#include "server/session/frame_log.h"
#include "server/worker/session_inputs.h"

namespace cleave {

// A session's frames as a coarser rung, in the surface view, or with a region of interest: decoded
// from the session's log, encoded anew and committed to a log of its own, from frame 0 on. Its
// bytes follow from the session's alone, whoever watches and whenever, so nothing is lost with it:
// a log that is damaged, ahead of the session's, or of another build is begun anew. Not
// thread-safe.
class RungLog {
 public:
  // Goes on behind the last frame of the rung's log. The session has frame 0, and the caller owns
  // the rung (owner_lock.h). Errors: InvalidArgument when there can be no such encoding; NotFound,
  // DataLoss of the session's log; what reading and writing files gives, which costs no frame.
  static absl::StatusOr<std::unique_ptr<RungLog>> Open(const SessionPaths& paths,
                                                       const SessionInputs& inputs,
                                                       const worker::v1::Encoding& encoding);

  // Newest frame committed, -1 for none.
  int64_t head() const { return log_->head(); }

  // Takes note of the session's frames up to `head`, which are committed.
  absl::Status Follow(int64_t head) { return kept_.Refresh(head); }
  bool behind() const { return head() < kept_.head(); }

  // Encodes and commits the frame after head(). Precondition: behind(). After an error the object
  // is of no more use; the directory is as before.
  absl::Status EncodeNext();

 private:
  RungLog(const SessionPaths& paths, const worker::v1::Encoding& encoding)
      : directory_(paths.rung(encoding.name())),
        kept_(paths.frames()),
        tolerance_(encoding.tolerance()),
        surface_(encoding.surface()),
        region_(RegionOf(encoding)) {}

  absl::Status MakeHeader(const SessionInputs& inputs);
  absl::Status MakeEncoder(std::optional<StreamState> state);
  // Brings both ends of the encoding to the head of the log; false where that is not to be gone on
  // with.
  absl::StatusOr<bool> Resume();
  absl::Status Begin();
  StreamMesh mesh() const { return {rest_positions_, edges_, tets_}; }

  std::string directory_;
  FrameLogReader kept_;  // the session's
  double tolerance_;     // m, against those
  bool surface_;         // the surface view
  std::optional<Region> region_;
  std::string kept_header_bytes_;
  std::vector<Vec3> rest_positions_;
  std::vector<std::array<int32_t, 2>> edges_;
  std::vector<std::array<int32_t, 4>> tets_;  // for the surface view
  StreamHeader header_;                       // of the rung
  std::optional<FrameLogWriter> log_;
  std::optional<FrameDecoder> decoder_;  // of the session's frames
  std::optional<FrameEncoder> encoder_;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_WORKER_RUNG_LOG_H_
