#ifndef CLEAVE_SERVER_GATEWAY_RUNG_ENCODERS_H_
#define CLEAVE_SERVER_GATEWAY_RUNG_ENCODERS_H_

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "absl/status/status.h"
#include "cleave/worker/v1/control.pb.h"
#include "core/stream/rungs.h"
#include "server/gateway/worker_process.h"
#include "server/session/frame_log.h"
#include "server/session/session_paths.h"

namespace cleave {

// The rungs of a session that are coarser than what it keeps: a log each, and a worker for each
// that somebody watches, which encodes the session's frames as they are committed. A rung that
// nobody watches costs nothing; what it has stays, and is gone on with. Thread-safe.
class RungEncoders : public std::enable_shared_from_this<RungEncoders> {
 public:
  // `program` is the path of cleave-worker. `changed` is called after every change of state() and
  // ended(), from any thread, with no lock held.
  RungEncoders(SessionPaths paths, std::string program, std::function<void()> changed);

  // What the rung's log holds; reads as far as state() says.
  FrameLogReader& frames(Rung rung) { return encoders_.at(rung).frames; }

  struct State {
    int64_t head_frame = -1;
    absl::Status failure;  // why no more frames come
  };
  State state(Rung rung) const;

  // Somebody watches, or no longer does. The first starts a worker and waits for its process to
  // start; an error of that is in state().
  void AddViewer(Rung rung);
  void RemoveViewer(Rung rung);

  // The session's frames are committed up to here. Does not wait.
  void Committed(int64_t head);

  // Ends the workers, at once or after the frame in work, and starts no other. Does not wait.
  void End(bool at_once);
  // No worker runs.
  bool ended() const;

 private:
  struct Encoder {
    explicit Encoder(std::string directory) : frames(std::move(directory)) {}
    FrameLogReader frames;
    std::shared_ptr<WorkerProcess> worker;
    bool quitting = false;  // the worker was told to
    int viewers = 0;
    int64_t head = -1;        // as the worker says
    int64_t told = -1;        // head of the session that it knows
    int64_t start_head = -1;  // where it was started
    int restarts = 0;         // since a frame was committed
    absl::Status failure;
  };

  // Both need mutex_.
  void StartLocked(Rung rung, Encoder& encoder);
  void TellLocked(Encoder& encoder);
  void OnStatus(Rung rung, const worker::v1::Status& status);
  void OnExit(Rung rung, const std::string& how);

  const SessionPaths paths_;
  const std::string program_;
  const std::function<void()> changed_;

  mutable std::mutex mutex_;
  std::map<Rung, Encoder> encoders_;  // all rungs; which there are never changes
  int64_t session_head_ = -1;
  bool ending_ = false;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RUNG_ENCODERS_H_
