#include "client/cli/goal.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "client/cli/number_check.h"
#include "core/scene/limits.h"

namespace cleave {

void AddGoalOptions(CLI::App& verb, GoalOptions& options) {
  verb.add_option("--frames", options.frames, "Stop after this frame; default: the scene's count")
      ->check(CountWithin(1, limits::kMaxFrames))
      ->type_name("N");
  verb.add_option("--wall-budget", options.wall_seconds,
                  "Stop at a frame's end after this much time on the clock")
      ->check(NumberWithin(0.001, 1e9))
      ->type_name("SECONDS");
  verb.add_flag("--until-fracture", options.until_fracture,
                "Stop after the first frame that breaks an edge");
}

std::string GoalOptions::Words() const {
  std::string words;
  if (frames > 0) absl::StrAppend(&words, " --frames ", frames);
  if (wall_seconds > 0) absl::StrAppend(&words, " --wall-budget ", wall_seconds);
  if (until_fracture) absl::StrAppend(&words, " --until-fracture");
  return words;
}

v1::RunGoal GoalMessage(const GoalOptions& options) {
  v1::RunGoal goal;
  goal.set_until_frame(options.frames);
  goal.set_stop_on_fracture(options.until_fracture);
  if (options.wall_seconds > 0) {
    const double whole = std::floor(options.wall_seconds);
    goal.mutable_wall_budget()->set_seconds(static_cast<int64_t>(whole));
    goal.mutable_wall_budget()->set_nanos(
        static_cast<int32_t>((options.wall_seconds - whole) * 1e9));
  }
  return goal;
}

}  // namespace cleave
