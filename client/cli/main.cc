#include <CLI/CLI.hpp>
#include <algorithm>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "client/cli/console.h"
#include "client/cli/exit_code.h"
#include "client/cli/program.h"
#include "client/io/scene/field_names.h"

namespace cleave {
namespace {

// CLI11 says no more than that a verb is required.
bool NamesUnknownVerb(const CLI::App& app, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands(nullptr)) verbs.push_back(verb->get_name());
  const std::string word = argv[1];
  if (std::find(verbs.begin(), verbs.end(), word) != verbs.end()) return false;
  const std::string nearest = NearestName(word, verbs);
  PrintNote(absl::StrCat("cleave has no verb \"", word, "\"",
                         nearest.empty() ? absl::StrCat("; there are: ", absl::StrJoin(verbs, ", "))
                                         : absl::StrCat("; did you mean \"", nearest, "\"?")));
  return true;
}

int Main(int argc, char** argv) {
  Program program;  // first: blocks signals for every thread to come
  CLI::App app(
      "Cleave simulates how bodies of elastic material break.\n"
      "Describe a body, what holds it and what pulls it in a scene file, then:\n\n"
      "  cleave validate bar.scene.json   check it\n"
      "  cleave plan bar.scene.json       see what it costs\n"
      "  cleave run bar.scene.json        simulate it; frames go to out/bar\n",
      "cleave");
  app.set_version_flag("--version", CLEAVE_VERSION);
  app.require_subcommand(1);
  app.get_formatter()->column_width(34);
  app.footer("`cleave VERB --help` explains a verb and shows examples.\n\n" + ExitCodeHelp());
  AddRun(app, program);
  AddSubmit(app, program);
  AddWatch(app, program);
  AddStep(app, program);
  AddList(app, program);
  AddCancel(app, program);
  AddValidate(app, program);
  AddPlan(app, program);
  AddProbe(app, program);
  AddMesh(app, program);
  AddImpurity(app, program);
  AddInspect(app, program);
  AddExport(app, program);
  AddPreview(app, program);
  AddGallery(app, program);
  AddInfo(app, program);
  if (NamesUnknownVerb(app, argc, argv)) return static_cast<int>(ExitCode::kUsage);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int code = app.exit(error);  // prints help, or what is wrong
    return code == 0 ? 0 : static_cast<int>(ExitCode::kUsage);
  }
  const absl::Status status = program.action(program);
  if (!status.ok()) PrintError(status);
  return static_cast<int>(ExitCodeOf(status, program.interrupt.signal()));
}

}  // namespace
}  // namespace cleave

int main(int argc, char** argv) { return cleave::Main(argc, argv); }
