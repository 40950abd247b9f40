#include "client/cli/follow.h"

#include <csignal>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/cli/console.h"
#include "client/cli/exit_code.h"
#include "client/cli/json_line.h"
#include "client/cli/progress.h"
#include "client/cpp/frame_stream.h"
#include "core/base/status.h"
#include "core/base/stopwatch.h"

namespace cleave {
namespace {

FrameStreamOptions StreamOptions(const FollowOptions& options, ProgressDisplay& display) {
  FrameStreamOptions stream;
  stream.session = options.session;
  stream.first_frame = options.first_frame;
  stream.stop_frame = options.stop_frame;
  stream.follow = options.stay;
  stream.events = options.events != nullptr;
  stream.latest = options.latest;
  stream.rung = options.accuracy.rung();
  if (options.accuracy.tolerance > 0) stream.tolerance = options.accuracy.tolerance;
  stream.region = options.region.message();
  stream.surface = options.surface;
  if (options.recorder != nullptr) {
    if (const auto last = options.recorder->last())
      stream.resume = FramePosition{last->epoch, last->frame, last->state_hash};
  }
  stream.on_cut = [&display, quiet = options.quiet](const absl::Status& why,
                                                    std::chrono::milliseconds delay) {
    if (quiet) return;
    display.Leave();
    PrintNote(absl::StrCat(why.message(), "; trying again in ",
                           FormatSeconds(static_cast<double>(delay.count()) / 1000)));
  };
  return stream;
}

Interrupt::Handler SignalHandler(Client& client, const FollowOptions& options, FrameStream& stream,
                                 std::atomic<bool>& interrupted) {
  return [&client, &options, &stream, &interrupted](int signal, int count) {
    interrupted = true;
    if (!options.pause_on_signal || count > 2) {
      stream.Cancel();
      return;
    }
    const bool abort_step = signal == SIGTERM || count == 2;
    if (!options.quiet) {
      const bool below_bar = ProgressDisplay::StyleForStderr() == ProgressDisplay::Style::kBar;
      PrintNote(absl::StrCat(below_bar ? "\n" : "",
                             abort_step
                                 ? "pausing at once; the frame in work is given up"
                                 : "pausing after this frame; Ctrl-C again gives the frame up"));
    }
    const auto paused = client.PauseSession(options.session, abort_step);
    if (!paused.ok() && !absl::IsFailedPrecondition(paused.status())) {
      PrintError(paused.status());
      stream.Cancel();
    }
  };
}

std::string FrameEvent(const StreamedFrame& frame) {
  return JsonLine()
      .Add("event", "frame")
      .Add("frame", frame.header.frame)
      .Add("time", frame.header.time)
      .Add("broken_edges", static_cast<int64_t>(frame.header.broken_edges))
      .Add("pieces", frame.header.fragments)
      .Add("bytes", static_cast<int64_t>(frame.bytes.size()))
      .Str();
}

std::string GapEvent(const FrameGap& gap) {
  return JsonLine()
      .Add("event", "gap")
      .Add("first_frame", gap.first_frame)
      .Add("last_frame", gap.last_frame)
      .Str();
}

// What was given to somebody who asked.
void TellAccuracy(const FrameStream& stream, const FollowOptions& options) {
  const std::string rung(stream.rung() ? RungName(*stream.rung()) : "");
  if (options.json) {
    PrintResult(JsonLine()
                    .Add("event", "accuracy")
                    .Add("rung", rung)
                    .Add("tolerance", stream.tolerance())
                    .Add("outside_tolerance", stream.outside_tolerance())
                    .Str());
  } else if (!options.quiet) {
    const std::string outside =
        stream.outside_tolerance() > 0
            ? absl::StrCat(" in the region, ", stream.outside_tolerance(), " m elsewhere")
            : "";
    PrintNote(absl::StrCat("coordinates within ", stream.tolerance(), " m",
                           rung.empty() ? "" : " (" + rung + ")", outside));
  }
}

void TakeOver(const IndexRow& row, FollowResult& result) {
  result.last_frame = row.frame;
  result.last_time = row.time;
  result.broken_edges = static_cast<int64_t>(row.broken_edges);
  result.pieces = row.fragments;
}

}  // namespace

absl::StatusOr<FollowResult> Follow(Client& client, Interrupt& interrupt,
                                    const FollowOptions& options) {
  ProgressDisplay display(options.quiet || options.json ? ProgressDisplay::Style::kNone
                                                        : ProgressDisplay::StyleForStderr());
  FollowResult result;
  FrameStream stream(client, StreamOptions(options, display));
  std::atomic<bool> interrupted{false};
  const ScopedHandler handler(interrupt, SignalHandler(client, options, stream, interrupted));
  CLEAVE_RETURN_IF_ERROR(stream.Open());
  if (options.accuracy.asked() || options.surface || stream.outside_tolerance() > 0)
    TellAccuracy(stream, options);
  if (options.recorder != nullptr) {
    if (const auto last = options.recorder->last()) TakeOver(*last, result);
    CLEAVE_RETURN_IF_ERROR(options.recorder->Begin(stream.header_bytes()));
  }
  if (options.begun) CLEAVE_RETURN_IF_ERROR(options.begun(stream.mesh_asset()));
  const Stopwatch watch;
  TimeLeft time_left;
  while (true) {
    auto frame = stream.Next();
    if (!frame.ok()) {
      display.Leave();
      if (!interrupted || !absl::IsCancelled(frame.status())) return frame.status();
      break;
    }
    if (!frame->has_value()) {
      result.end = *stream.end();
      break;
    }
    const FrameHeader& header = (*frame)->header;
    if (options.events != nullptr) CLEAVE_RETURN_IF_ERROR(options.events->Append((*frame)->events));
    if (options.recorder != nullptr)
      CLEAVE_RETURN_IF_ERROR(options.recorder->Append((*frame)->bytes));
    TakeOver(MakeIndexRow(header, 0, 0), result);
    if (header.frame <= options.head_frame || header.frame == 0)
      time_left.StartAt(header.frame, watch.Seconds());
    if ((*frame)->gap.has_value()) {
      result.left_out += (*frame)->gap->last_frame - (*frame)->gap->first_frame + 1;
      if (options.json) PrintResult(GapEvent(*(*frame)->gap));
    }
    if (options.json) PrintResult(FrameEvent(**frame));
    display.Show({header.frame, options.goal_frame, header.time, result.broken_edges, result.pieces,
                  time_left.Estimate(header.frame, options.goal_frame, watch.Seconds())},
                 watch.Seconds());
  }
  display.Leave();
  result.interrupted = interrupted;
  return result;
}

absl::Status StatusOfEnd(const std::string& session, const v1::StreamEnd& end) {
  switch (end.reason()) {
    case v1::END_REASON_FAILED:
      return SimulationFailed(
          absl::StrCat(session, " failed after frame ", end.last_frame(), ": ", end.message()));
    case v1::END_REASON_DELETED:
      return absl::NotFoundError(absl::StrCat(session, " was deleted"));
    case v1::END_REASON_STOP_FRAME:
    case v1::END_REASON_GOAL_REACHED:
      return absl::OkStatus();
    default:
      return absl::InternalError(absl::StrCat(session, ": the frame stream ended for a reason (",
                                              static_cast<int>(end.reason()),
                                              ") that this client does not know"));
  }
}

}  // namespace cleave
