#ifndef CLEAVE_CLIENT_CLI_GOAL_H_
#define CLEAVE_CLIENT_CLI_GOAL_H_

#include <CLI/App.hpp>
#include <cstdint>

#include "cleave/v1/session.pb.h"

namespace cleave {

// Where a run stops.
struct GoalOptions {
  int64_t frames = 0;           // --frames; 0: the scene's
  double wall_seconds = 0;      // --wall-budget; 0: none
  bool until_fracture = false;  // --until-fracture
};

void AddGoalOptions(CLI::App& verb, GoalOptions& options);
v1::RunGoal GoalMessage(const GoalOptions& options);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_GOAL_H_
