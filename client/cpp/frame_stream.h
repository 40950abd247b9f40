#ifndef CLEAVE_CLIENT_CPP_FRAME_STREAM_H_
#define CLEAVE_CLIENT_CPP_FRAME_STREAM_H_

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "cleave/v1/frame.pb.h"
#include "client/cpp/client.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/frame_header.h"
#include "core/stream/rungs.h"

namespace cleave {

// A frame that the client holds, from which a stream goes on.
struct FramePosition {
  uint32_t epoch = 0;
  int64_t frame = -1;
  uint64_t state_hash = 0;
};

struct FrameStreamOptions {
  std::string session;  // "sessions/{id}"
  // Where to begin: after `resume`, or at the newest key frame at or before `first_frame`.
  std::optional<FramePosition> resume;
  int64_t first_frame = 0;
  std::optional<int64_t> stop_frame;  // last frame wanted; absent: until the run's goal
  bool follow = false;                // stay when the goal is reached, until Cancel
  bool events = false;                // also what broke: StreamedFrame::events
  // The largest error of a coordinate that will do, as a rung or in metres (one of the two);
  // neither: what the session keeps. rung() and tolerance() tell what is given.
  std::optional<Rung> rung;
  std::optional<double> tolerance;
  // Set: only this is as accurate as asked, and exactly so; see frame.proto.
  std::optional<v1::RegionOfInterest> region;
  bool surface = false;  // only the nodes that surfaces are drawn from; see frame.proto
  bool latest = false;   // leave out what is before the newest key frame, where behind
  // Rest positions (m) of the session's mesh; then every frame is decoded, see decoder(). With them
  // its edges (Incidence::edges), and with `surface` its tets.
  std::optional<std::vector<Vec3>> rest_positions;
  std::vector<std::array<int32_t, 2>> edges;
  std::vector<std::array<int32_t, 4>> tets;
  // Told whenever the stream was cut and is tried again after `delay`. May be empty.
  std::function<void(const absl::Status& why, std::chrono::milliseconds delay)> on_cut;
};

// Frames that a viewer who wants the latest missed.
struct FrameGap {
  int64_t first_frame = 0;
  int64_t last_frame = 0;
};

// One committed frame as it is in the session's log.
struct StreamedFrame {
  FrameHeader header;
  std::string bytes;            // exactly one frame (core/stream/FORMAT.md), checksums checked
  v1::FrameEvents events;       // what broke in it; empty where nothing did or nobody asked
  std::optional<FrameGap> gap;  // what was left out before it: only with `latest`
};

// The frames of a session in order, each once (with `latest`: at most), across cuts of the
// connection and restarts of the server: after a cut it goes on behind the last frame by (epoch,
// frame, state hash). Next from one thread; Cancel from any.
class FrameStream {
 public:
  // `client` must outlive the stream.
  FrameStream(Client& client, FrameStreamOptions options);
  ~FrameStream();
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;

  // Connects and waits for the stream's header. Next does it where it was not done. Errors:
  // NotFound, Unavailable after many attempts, FailedPrecondition when another session took the
  // name, Cancelled.
  absl::Status Open();

  // The next frame, or nullopt after the clean end, of which end() tells. Errors: those of Open;
  // DataLoss when the server sends what no log holds.
  absl::StatusOr<std::optional<StreamedFrame>> Next();

  // Valid after Open.
  const std::string& header_bytes() const { return start_->header(); }
  const std::string& mesh_asset() const { return start_->mesh_asset(); }
  // What is given: absent where it is no rung's; largest error of a coordinate, m.
  std::optional<Rung> rung() const;
  double tolerance() const { return start_->tolerance(); }
  // m, outside of the region; 0 without one. FrameDecoder::Tolerances tells where that is.
  double outside_tolerance() const { return start_->outside_tolerance(); }
  // Newest committed frame that the server told of.
  int64_t head_frame() const { return head_frame_; }
  // The last frame that Next gave (or `resume`).
  const std::optional<FramePosition>& position() const { return position_; }
  // Set when Next has given nullopt.
  const std::optional<v1::StreamEnd>& end() const { return end_; }
  // Where rest_positions were given: stands at the last frame that Next gave; null before.
  const FrameDecoder* decoder() const { return decoder_.has_value() ? &*decoder_ : nullptr; }

  // Ends Next soon with Cancelled.
  void Cancel();

 private:
  absl::Status Connect();
  void Disconnect();
  // Reads messages until a whole new frame or the end. Unavailable: cut, may be tried again.
  absl::StatusOr<std::optional<StreamedFrame>> ReadOne();
  absl::Status AddChunk(const v1::FrameChunk& chunk, bool& whole);
  absl::Status AddEvents(const v1::FrameEvents& events);
  absl::Status AddGap(const v1::Gap& gap);
  // What a new frame that came behind gap_ has to tell of it.
  absl::Status TakeGap(const FrameHeader& header, std::optional<FrameGap>& gap);
  absl::StatusOr<std::optional<StreamedFrame>> Accept(std::string bytes);
  // After a failed attempt: waits, or says why not to go on.
  absl::Status Recover(const absl::Status& why);
  bool cancelled();

  Client& client_;
  FrameStreamOptions options_;
  std::optional<FramePosition> position_;
  std::optional<v1::StreamStart> start_;
  std::optional<v1::StreamEnd> end_;
  std::optional<FrameDecoder> decoder_;
  int64_t head_frame_ = -1;
  int attempts_ = 0;

  // The frame that chunks are put together to.
  std::string assembly_;
  uint64_t assembly_bytes_ = 0;  // wanted; 0: between frames
  int64_t assembly_frame_ = 0;
  v1::FrameEvents events_;  // of the frame to come
  uint64_t events_bytes_ = 0;
  std::optional<FrameGap> gap_;  // before the frame to come

  struct Call;
  std::mutex mutex_;  // guards call_'s exchange against Cancel
  bool cancelled_ = false;
  std::unique_ptr<Call> call_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CPP_FRAME_STREAM_H_
