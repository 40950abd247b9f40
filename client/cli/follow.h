#ifndef CLEAVE_CLIENT_CLI_FOLLOW_H_
#define CLEAVE_CLIENT_CLI_FOLLOW_H_

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "absl/status/statusor.h"
#include "cleave/v1/frame.pb.h"
#include "client/cli/accuracy.h"
#include "client/cli/event_file.h"
#include "client/cli/interrupt.h"
#include "client/cli/region.h"
#include "client/cpp/client.h"
#include "client/io/record/recorder.h"

namespace cleave {

// How a session's frames are followed and shown.
struct FollowOptions {
  std::string session;  // "sessions/{id}"
  int64_t first_frame = 0;
  std::optional<int64_t> stop_frame;
  bool stay = false;             // also when the goal is reached, until Ctrl-C
  int64_t goal_frame = 0;        // for the display
  int64_t head_frame = -1;       // frames up to here are there already: they say nothing of the ETA
  bool pause_on_signal = false;  // Ctrl-C pauses the session; else it only leaves the stream
  bool json = false;             // a JSON line a frame on stdout instead of progress on stderr
  bool quiet = false;
  AccuracyOptions accuracy;      // asked of the server
  RegionOptions region;          // that is looked at
  bool latest = false;           // leave out what is before the newest key frame, where behind
  bool surface = false;          // no more than surfaces are drawn from
  Recorder* recorder = nullptr;  // may be null; the stream goes on behind its last frame
  EventFile* events = nullptr;   // takes what breaks; may be null
  // Called once before the first frame, when the recorder fits the stream, with the mesh's asset.
  std::function<absl::Status(const std::string& mesh_asset)> begun;
};

struct FollowResult {
  v1::StreamEnd end;  // unspecified reason: left by a signal
  bool interrupted = false;
  int64_t last_frame = -1;  // that was received or recorded
  double last_time = 0;     // s
  int64_t broken_edges = 0;
  int64_t pieces = 0;
  int64_t left_out = 0;  // frames, with `latest`
};

// Receives frames until the stream's end: the goal, the failure, the pause that Ctrl-C asked for.
// The first signal asks to pause after the frame in work, the second gives that frame up, the third
// leaves at once; SIGTERM gives up the frame at once. Errors: those of FrameStream, Recorder and
// `begun`.
absl::StatusOr<FollowResult> Follow(Client& client, Interrupt& interrupt,
                                    const FollowOptions& options);

// What a stream's end means for the run.
absl::Status StatusOfEnd(const std::string& session, const v1::StreamEnd& end);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_FOLLOW_H_
