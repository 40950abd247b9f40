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
#include "server/gateway/worker_process.h"
#include "server/session/frame_log.h"
#include "server/session/session_paths.h"

namespace cleave {

// The rungs of a session that are coarser than what it keeps, and the regions that viewers look at:
// a log each, and a worker for each that somebody watches, which encodes the session's frames as
// they are committed. One that nobody watches costs nothing; what it has stays, and is gone on
// with, but that of a region only until its place is needed for another. Thread-safe.
class RungEncoders : public std::enable_shared_from_this<RungEncoders> {
 public:
  static constexpr size_t kMaxRegions = 4;

  // `program` is the path of cleave-worker. `changed` is called after every change of state() and
  // ended(), from any thread, with no lock held. Removes the logs of regions, which nobody watches
  // yet.
  RungEncoders(SessionPaths paths, std::string program, std::function<void()> changed);

  // All below by the name of the encoding (worker.v1.Encoding). Precondition, but for AddViewer: it
  // has a viewer.

  // What the log holds; reads as far as state() says.
  FrameLogReader& frames(const std::string& name);

  struct State {
    int64_t head_frame = -1;
    absl::Status failure;  // why no more frames come
  };
  State state(const std::string& name) const;

  // Somebody watches, or no longer does. The first starts a worker and waits for its process to
  // start; an error of that is in state(). Errors: ResourceExhausted when other regions take all
  // places, Unavailable where one of them is about to give its up.
  absl::Status AddViewer(const worker::v1::Encoding& encoding);
  void RemoveViewer(const std::string& name);

  // The session's frames are committed up to here. Does not wait.
  void Committed(int64_t head);

  // Ends the workers, at once or after the frame in work, and starts no other. Does not wait.
  void End(bool at_once);
  // No worker runs.
  bool ended() const;

 private:
  struct Encoder {
    Encoder(worker::v1::Encoding of, std::string directory)
        : encoding(std::move(of)), frames(std::move(directory)) {}
    const worker::v1::Encoding encoding;
    FrameLogReader frames;
    std::shared_ptr<WorkerProcess> worker;
    bool quitting = false;  // the worker was told to
    int viewers = 0;
    uint64_t left = 0;        // when the last viewer did, by count
    int64_t head = -1;        // as the worker says
    int64_t told = -1;        // head of the session that it knows
    int64_t start_head = -1;  // where it was started
    int restarts = 0;         // since a frame was committed
    absl::Status failure;
  };

  // All three need mutex_.
  absl::Status MakeRoomLocked();
  void StartLocked(Encoder& encoder);
  void TellLocked(Encoder& encoder);

  void OnStatus(const std::string& name, const worker::v1::Status& status);
  void OnExit(const std::string& name, const std::string& how);

  const SessionPaths paths_;
  const std::string program_;
  const std::function<void()> changed_;

  mutable std::mutex mutex_;
  std::map<std::string, Encoder> encoders_;  // that ever had a viewer, by name
  uint64_t leaves_ = 0;
  int64_t session_head_ = -1;
  bool ending_ = false;
};

}  // namespace cleave

#endif  // CLEAVE_SERVER_GATEWAY_RUNG_ENCODERS_H_
