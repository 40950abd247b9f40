#ifndef CLEAVE_CLIENT_CLI_GOAL_H_
#define CLEAVE_CLIENT_CLI_GOAL_H_

#include <CLI/App.hpp>
#include <cstdint>
#include <string>

#include "cleave/v1/session.pb.h"

namespace cleave {

// Where a run stops.
struct GoalOptions {
  int64_t frames = 0;           // --frames; 0: the scene's
  double wall_seconds = 0;      // --wall-budget; 0: none
  bool until_fracture = false;  // --until-fracture

  // The options as they were typed, for a command to go on with; begins with a blank.
  std::string Words() const;
};

void AddGoalOptions(CLI::App& verb, GoalOptions& options);
v1::RunGoal GoalMessage(const GoalOptions& options);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_GOAL_H_
