#include "proto/convert/probe.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/cli/console.h"
#include "client/cli/material_input.h"
#include "client/cli/probe_text.h"
#include "client/cli/program.h"
#include "client/cli/server_access.h"
#include "client/cli/session_text.h"
#include "client/cpp/rpc_error.h"
#include "client/io/plot/curve_plot.h"
#include "client/io/series/write_aside.h"
#include "core/base/status.h"

namespace cleave {
namespace {

struct Options {
  ServerOptions server;
  std::string material;
  std::string which;
  std::vector<std::string> directions;
  std::vector<std::string> deformations;
  std::vector<std::string> fibres;
  std::string point;
  std::string stress;
  std::optional<double> max_strain;
  int samples = 100;
  std::string out;
  std::string format = "table";
  bool list = false;
};

// Appends `count` numbers between commas or blanks.
void AppendNumbers(absl::string_view option, const std::string& text, size_t count,
                   google::protobuf::RepeatedField<double>* numbers, Faults& faults) {
  const std::vector<std::string> words =
      absl::StrSplit(text, absl::ByAnyChar(", "), absl::SkipEmpty());
  std::vector<double> values(words.size());
  bool right = words.size() == count;
  for (size_t k = 0; k < words.size(); ++k) right = absl::SimpleAtod(words[k], &values[k]) && right;
  if (!right) {
    faults.Error(option,
                 absl::StrCat("\"", text, "\" is not ", count, " numbers with commas between"));
    return;
  }
  numbers->Add(values.begin(), values.end());
}

absl::StatusOr<v1::ProbeMaterialRequest> RequestOf(const Options& options,
                                                   const MaterialInput& input) {
  v1::ProbeMaterialRequest request;
  *request.mutable_material() = input.material;
  request.set_stress(options.stress == "total"    ? v1::FRACTURE_STRESS_TOTAL
                     : options.stress == "matrix" ? v1::FRACTURE_STRESS_MATRIX
                                                  : input.stress);
  if (options.max_strain.has_value()) request.set_largest_strain(*options.max_strain);
  request.set_samples(options.samples);
  Faults faults;
  for (const std::string& text : options.directions)
    AppendNumbers("--direction", text, 3, request.mutable_pull_directions(), faults);
  for (const std::string& text : options.deformations)
    AppendNumbers("--deformation", text, 9, request.mutable_deformation_gradients(), faults);
  for (const std::string& text : options.fibres)
    AppendNumbers("--fibre", text, 3, request.mutable_fibre_directions(), faults);
  if (!options.point.empty())
    AppendNumbers("--point", options.point, 3, request.mutable_point(), faults);
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
  return request;
}

// By the server where one is named, else here: the same code gives the same numbers.
absl::StatusOr<v1::ProbeMaterialResponse> Ask(Program& program, const Options& options,
                                              const MaterialInput& input,
                                              const v1::ProbeMaterialRequest& request) {
  if (!options.server.address.empty()) {
    CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Client> client,
                            ConnectServer(options.server, program.interrupt));
    auto response = client->ProbeMaterial(request);
    const std::vector<Fault> faults = FaultsOf(response.status());
    if (!faults.empty()) return input.Describe(faults);
    return response;
  }
  Faults faults;
  auto response = AnswerProbe(request, program.interrupt.stop(), faults);
  if (!faults.ok()) return input.Describe(faults.errors());
  return response;
}

absl::Status WriteFiles(const Options& options, const MaterialInput& input,
                        const v1::ProbeMaterialRequest& request,
                        const v1::ProbeMaterialResponse& response) {
  CLEAVE_RETURN_IF_ERROR(MakeDirectories(options.out));
  const auto write = [&](const char* name, const std::string& bytes) -> absl::Status {
    const std::string path = absl::StrCat(options.out, "/", name);
    CLEAVE_RETURN_IF_ERROR(WriteAside(path, bytes));
    PrintNote(absl::StrCat("wrote ", path));
    return absl::OkStatus();
  };
  if (response.curves_size() > 0) {
    CLEAVE_RETURN_IF_ERROR(write("curves.csv", CurvesCsv(response)));
    CLEAVE_ASSIGN_OR_RETURN(
        const std::string plot,
        EncodeCurvePlot(PlottedCurves(response), input.name, PlotSubtitle(response.material())));
    CLEAVE_RETURN_IF_ERROR(write("curves.svg", plot));
  }
  if (response.points_size() > 0)
    CLEAVE_RETURN_IF_ERROR(write("points.csv", PointsCsv(request, response)));
  return absl::OkStatus();
}

absl::Status ListPresets(Program& program, const Options& options) {
  v1::ListMaterialPresetsResponse presets = PresetsMessage();
  if (!options.server.address.empty()) {
    CLEAVE_ASSIGN_OR_RETURN(const std::unique_ptr<Client> client,
                            ConnectServer(options.server, program.interrupt));
    CLEAVE_ASSIGN_OR_RETURN(presets, client->ListMaterialPresets());
  }
  PrintResult(options.format == "json" ? MessageJson(presets) : PresetsText(presets));
  return absl::OkStatus();
}

absl::Status Probe(Program& program, const Options& options) {
  if (options.list) return ListPresets(program, options);
  CLEAVE_ASSIGN_OR_RETURN(const MaterialInput input, LoadMaterial(options.material, options.which));
  CLEAVE_ASSIGN_OR_RETURN(const v1::ProbeMaterialRequest request, RequestOf(options, input));
  CLEAVE_ASSIGN_OR_RETURN(const v1::ProbeMaterialResponse response,
                          Ask(program, options, input, request));
  for (const std::string& warning : response.warnings())
    PrintNote(absl::StrCat("warning: ", warning));
  if (options.format == "json") {
    PrintResult(MessageJson(response));
  } else if (options.format == "csv") {
    std::string text = response.curves_size() > 0 ? CurvesCsv(response) : "";
    if (response.points_size() > 0)
      absl::StrAppend(&text, text.empty() ? "" : "\n", PointsCsv(request, response));
    text.pop_back();
    PrintResult(text);
  } else {
    PrintResult(absl::StrCat(input.name, ": ", ProbeTable(request, response)));
  }
  if (options.out.empty()) return absl::OkStatus();
  return WriteFiles(options, input, request, response);
}

}  // namespace

void AddProbe(CLI::App& app, Program& program) {
  CLI::App* verb = app.add_subcommand(
      "probe", "Show what a material does: stress-strain curves to failure, energy, tangent");
  auto options = std::make_shared<Options>();
  CLI::Option* material =
      verb->add_option("material", options->material,
                       "A preset, a scene file, or a material file (*.material.json, "
                       "*.material.textproto)")
          ->type_name("MATERIAL");
  CLI::Option* list =
      verb->add_flag("--list", options->list, "List the presets with their numbers and sources");
  material->excludes(list);
  verb->add_option("--material", options->which, "Which material of a scene: its name or index")
      ->type_name("NAME");
  verb->add_option(
          "--direction", options->directions,
          "Pull a bar along this direction; may be repeated. Default: along and across the "
          "fibres, or x")
      ->type_name("X,Y,Z");
  verb->add_option(
          "--max-strain", options->max_strain,
          "Strain at which a bar that holds is let go; below 0 it is pressed; default: 10 for "
          "what can break, else 1")
      ->type_name("STRAIN");
  verb->add_option("--samples", options->samples, "Steps of equal strain a curve")
      ->type_name("N")
      ->capture_default_str();
  verb->add_option("--deformation", options->deformations,
                   "Energy, stress and tangent at this deformation gradient, nine numbers row by "
                   "row; may be repeated")
      ->type_name("F11,...,F33");
  verb->add_option("--point", options->point,
                   "Where, in metres: for fibres whose direction depends on the place")
      ->type_name("X,Y,Z");
  verb->add_option("--fibre", options->fibres,
                   "Direction of the fibres here, in place of the material's; once a family")
      ->type_name("X,Y,Z");
  verb->add_option("--stress", options->stress,
                   "Which stress breaks: that of the matrix alone, or the total; default: that of "
                   "the scene, or matrix")
      ->check(CLI::IsMember({"matrix", "total"}));
  verb->add_option("--out", options->out, "Also write curves.csv, curves.svg and points.csv here")
      ->type_name("DIR");
  verb->add_option("--format", options->format, "What to print")
      ->check(CLI::IsMember({"table", "json", "csv"}))
      ->capture_default_str();
  AddServerOptions(*verb, options->server, false);
  verb->get_option("--server")
      ->description("Ask this server, HOST:PORT or unix:PATH; without one the answer is made here");
  verb->footer(
      "A bar is slender and its sides are free; it breaks where an edge of the mesh would.\n\n"
      "Examples:\n"
      "  cleave probe --list\n"
      "  cleave probe dry_wood --out out/wood       along and across the grain, with a plot\n"
      "  cleave probe bar.scene.json --material rim --direction 1,1,0\n"
      "  cleave probe rubber --deformation 2,0,0,0,0.7,0,0,0,0.7 --format json\n");
  verb->callback([options, &program, material, list] {
    if (material->count() == 0 && list->count() == 0)
      throw CLI::RequiredError("MATERIAL, or --list,");
    program.action = [options](Program& shared) { return Probe(shared, *options); };
  });
}

}  // namespace cleave
