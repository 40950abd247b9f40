#ifndef CLEAVE_CLIENT_CLI_PROGRESS_H_
#define CLEAVE_CLIENT_CLI_PROGRESS_H_

#include <cstdint>
#include <optional>
#include <string>

namespace cleave {

// Where a run stands.
struct RunProgress {
  int64_t frame = 0;
  int64_t goal_frame = 0;
  double time = 0;  // s simulated
  int64_t broken_edges = 0;
  int64_t pieces = 0;
  std::optional<double> seconds_left;  // wall clock
};

// "12 ms", "0.8 s", "42 s", "3 min 05 s", "2 h 10 min".
std::string FormatSeconds(double seconds);
// "912 B", "1.3 MiB".
std::string FormatBytes(double bytes);

// One line for a terminal, at most `width` columns: a bar and the numbers.
std::string ProgressBar(const RunProgress& progress, int width);
// One line for a log.
std::string ProgressText(const RunProgress& progress);

// Estimates how long the rest takes from the frames computed since `StartAt`: frames that were
// there already come at once and say nothing.
class TimeLeft {
 public:
  void StartAt(int64_t frame, double now_seconds);
  // nullopt until a frame was computed.
  std::optional<double> Estimate(int64_t frame, int64_t goal_frame, double now_seconds) const;

 private:
  int64_t first_frame_ = 0;
  double first_seconds_ = 0;
};

// Shows progress on stderr: a bar that redraws itself on a terminal, else lines: the first frame,
// the first break, about every two seconds, and the last frame.
class ProgressDisplay {
 public:
  enum class Style { kBar, kLines, kNone };
  explicit ProgressDisplay(Style style) : style_(style) {}
  // A bar when stderr is a terminal.
  static Style StyleForStderr();

  void Show(const RunProgress& progress, double now_seconds);
  // Leaves the bar's line, so that other text may follow. Show draws a new one.
  void Leave();

 private:
  Style style_;
  bool on_bar_line_ = false;
  double shown_seconds_ = -1e9;
  int64_t shown_broken_edges_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_PROGRESS_H_
