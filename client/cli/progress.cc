#include "client/cli/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace cleave {
namespace {

constexpr double kBarSeconds = 0.1;
constexpr double kLineSeconds = 2;

int TerminalWidth() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col < 20) return 80;
  return size.ws_col;
}

std::string Count(int64_t count, const char* one, const char* many) {
  return absl::StrCat(count, " ", count == 1 ? one : many);
}

}  // namespace

std::string FormatSeconds(double seconds) {
  if (!(seconds >= 0)) return "?";
  if (seconds < 0.0995) return absl::StrFormat("%.2g ms", seconds * 1000);
  if (seconds < 9.95) return absl::StrFormat("%.1f s", seconds);
  const int64_t whole = std::llround(std::min(seconds, 1e15));
  if (whole < 60) return absl::StrCat(whole, " s");
  if (whole < 3600) return absl::StrFormat("%d min %02d s", whole / 60, whole % 60);
  return absl::StrFormat("%d h %02d min", whole / 3600, whole / 60 % 60);
}

std::string FormatBytes(double bytes) {
  constexpr const char* kUnits[] = {"B", "KiB", "MiB", "GiB", "TiB"};
  size_t unit = 0;
  while (bytes >= 1023.5 && unit + 1 < std::size(kUnits)) {
    bytes /= 1024;
    ++unit;
  }
  return absl::StrFormat(unit == 0 || bytes >= 99.5 ? "%.0f %s" : "%.1f %s", bytes, kUnits[unit]);
}

std::string ProgressText(const RunProgress& progress) {
  std::string text = absl::StrCat("frame ", progress.frame, " of ", progress.goal_frame,
                                  absl::StrFormat(", time %.4g s, ", progress.time),
                                  Count(progress.broken_edges, "broken edge", "broken edges"), ", ",
                                  Count(progress.pieces, "piece", "pieces"));
  if (progress.seconds_left.has_value() && progress.frame < progress.goal_frame)
    absl::StrAppend(&text, ", ", FormatSeconds(*progress.seconds_left), " left");
  return text;
}

std::string ProgressBar(const RunProgress& progress, int width) {
  const double share =
      progress.goal_frame <= 0
          ? 1
          : std::clamp(static_cast<double>(progress.frame) / progress.goal_frame, 0.0, 1.0);
  std::string numbers = absl::StrCat(" ", progress.frame, "/", progress.goal_frame,
                                     absl::StrFormat("  %.4g s", progress.time));
  if (progress.seconds_left.has_value() && progress.frame < progress.goal_frame)
    absl::StrAppend(&numbers, "  ETA ", FormatSeconds(*progress.seconds_left));
  absl::StrAppend(&numbers, "  ", Count(progress.broken_edges, "edge", "edges"), " broken  ",
                  Count(progress.pieces, "piece", "pieces"));
  const int room = width - static_cast<int>(numbers.size()) - 2;
  std::string line;
  if (room >= 8) {
    const int cells = std::min(room, 30);
    const int full = static_cast<int>(std::floor(share * cells));
    line = absl::StrCat("[", std::string(static_cast<size_t>(full), '#'),
                        std::string(static_cast<size_t>(cells - full), '-'), "]", numbers);
  } else {
    line = numbers.substr(1);
  }
  if (static_cast<int>(line.size()) > width) line.resize(static_cast<size_t>(std::max(0, width)));
  return line;
}

void TimeLeft::StartAt(int64_t frame, double now_seconds) {
  first_frame_ = frame;
  first_seconds_ = now_seconds;
}

std::optional<double> TimeLeft::Estimate(int64_t frame, int64_t goal_frame,
                                         double now_seconds) const {
  const int64_t done = frame - first_frame_;
  if (done <= 0) return std::nullopt;
  const double seconds_a_frame = (now_seconds - first_seconds_) / static_cast<double>(done);
  return seconds_a_frame * static_cast<double>(std::max<int64_t>(0, goal_frame - frame));
}

ProgressDisplay::Style ProgressDisplay::StyleForStderr() {
  return isatty(STDERR_FILENO) != 0 ? Style::kBar : Style::kLines;
}

void ProgressDisplay::Show(const RunProgress& progress, double now_seconds) {
  if (style_ == Style::kNone) return;
  const bool first_break = shown_broken_edges_ == 0 && progress.broken_edges > 0;
  const bool last = progress.frame >= progress.goal_frame;
  const double pause = style_ == Style::kBar ? kBarSeconds : kLineSeconds;
  if (!last && now_seconds - shown_seconds_ < pause && !(first_break && style_ == Style::kLines))
    return;
  shown_seconds_ = now_seconds;
  shown_broken_edges_ = progress.broken_edges;
  if (style_ == Style::kBar) {
    // To the line's start, text, clear to its end.
    std::fprintf(stderr, "\r%s\x1b[K", ProgressBar(progress, TerminalWidth() - 1).c_str());
    on_bar_line_ = true;
  } else {
    std::fprintf(stderr, "%s\n", ProgressText(progress).c_str());
  }
  std::fflush(stderr);
}

void ProgressDisplay::Leave() {
  if (!on_bar_line_) return;
  std::fputc('\n', stderr);
  on_bar_line_ = false;
}

}  // namespace cleave
