#ifndef CLEAVE_CLIENT_CLI_PROGRAM_H_
#define CLEAVE_CLIENT_CLI_PROGRAM_H_

#include <CLI/CLI.hpp>  // not App.hpp alone: verbs are apps, and those need what it only declares
#include <functional>

#include "absl/status/status.h"
#include "client/cli/interrupt.h"

namespace cleave {

// What the verbs share: the interrupt, and what the command line asked for.
struct Program {
  Interrupt interrupt;
  std::function<absl::Status(Program&)> action;  // set by the verb that was named
};

// Each adds its verb, its options and its help to the command line (one file a verb).
void AddRun(CLI::App& app, Program& program);
void AddSubmit(CLI::App& app, Program& program);
void AddWatch(CLI::App& app, Program& program);
void AddStep(CLI::App& app, Program& program);
void AddList(CLI::App& app, Program& program);
void AddCancel(CLI::App& app, Program& program);
void AddValidate(CLI::App& app, Program& program);
void AddPlan(CLI::App& app, Program& program);
void AddProbe(CLI::App& app, Program& program);
void AddInspect(CLI::App& app, Program& program);
void AddMesh(CLI::App& app, Program& program);
void AddImpurity(CLI::App& app, Program& program);
void AddInfo(CLI::App& app, Program& program);
void AddExport(CLI::App& app, Program& program);
void AddPreview(CLI::App& app, Program& program);
void AddGallery(CLI::App& app, Program& program);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_PROGRAM_H_
