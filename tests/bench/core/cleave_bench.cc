// Prints what a step costs and where the time goes: what fibres, impurities and precision cost
// against the plain body, what fibres cost a slab that tears, the column of the method's paper,
// pieces asleep against awake, surfaces that are followed against those taken anew, and boxes of
// growing size that are pulled until they break. `cleave_bench ratios`, `cleave_bench slab`,
// `cleave_bench column`, `cleave_bench sleep`, `cleave_bench surface` and `cleave_bench [tets...]`
// print one of the tables.

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/status.h"
#include "core/base/stopwatch.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/procedural.h"
#include "core/simulation/simulation.h"
#include "core/stream/frame_encoder.h"
#include "core/surface/point_motion.h"
#include "core/surface/visible_surface.h"
#include "tests/bench/core/step_cost.h"
#include "tests/bench/pulled_bar.h"

namespace cleave {
namespace {

// What is measured of a body. Frames have a step each.
struct Phase {
  const char* name;
  int frames;
  double linear_tolerance;
  double tensile_strength;  // Pa; 0: cannot break
  int32_t max_passes;
};
constexpr Phase kPhases[] = {
    {"elastic", 4, 1e-3, 0, 0},
    {"tight", 2, 1e-6, 0, 0},
    {"breaking", 2, 1e-3, 5e6, 4},
};

// A bar of plastic, 0.3 x 0.1 x 0.1 m, whose ends part by 1.25 mm a step.
BoxMesh Bar(double tets) {
  BoxMesh box;
  box.size = {0.3, 0.1, 0.1};
  box.resolution.layout = MeshLayout::kJitteredLattice;
  box.resolution.cell_size = 0.1 / std::round(std::cbrt(tets / 18));
  return box;
}

Scene PullApart(const Phase& phase) {
  Material plastic;
  plastic.youngs_modulus = 1e9;
  plastic.poisson_ratio = 0.35;
  plastic.density = 1200;
  if (phase.tensile_strength > 0) plastic.tensile_strength = phase.tensile_strength;
  Scene scene = PulledBar(plastic, 0.06, 0, 96);
  scene.quality.linear_tolerance = phase.linear_tolerance;
  scene.quality.newton_iterations = 20;
  if (phase.max_passes > 0) scene.fracture.max_passes = phase.max_passes;
  return scene;
}

absl::Status Measure(const TetMesh& mesh, int threads, const Phase& phase) {
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism,
                            static_cast<size_t>(threads));
  const Scene scene = PullApart(phase);
  Simulation::Options options;
  options.threads = threads;
  const Stopwatch create_watch;
  CLEAVE_ASSIGN_OR_RETURN(const auto simulation, Simulation::Create(scene, mesh, options));
  const double create_seconds = create_watch.Seconds();

  const Incidence incidence = BuildIncidence(mesh);
  const Faces faces = BuildFaces(mesh);
  VisibleSurface surface(mesh, incidence, faces, {});
  PointMotion motion(mesh, incidence);
  std::vector<int32_t> broken;
  StreamParameters parameters;
  parameters.mesh_sha256 = std::string(32, '\0');
  parameters.edge_count = static_cast<uint64_t>(incidence.edge_count());
  parameters.tet_count = static_cast<uint64_t>(mesh.tet_count());
  ChooseIds(mesh.rest_positions, parameters);
  CLEAVE_ASSIGN_OR_RETURN(const StreamHeader header,
                          MakeStreamHeader(parameters, mesh.rest_positions));
  CLEAVE_ASSIGN_OR_RETURN(FrameEncoder encoder,
                          FrameEncoder::Create(header, {mesh.rest_positions, incidence.edges}));

  FrameReport sum;
  double surface_seconds = 0, encode_seconds = 0;
  const StopFlag stop;
  for (int k = 0; k < phase.frames; ++k) {
    CLEAVE_ASSIGN_OR_RETURN(const FrameReport report, simulation->Advance(stop));
    sum.steps += report.steps;
    sum.newton_iterations += report.newton_iterations;
    sum.linear_iterations += report.linear_iterations;
    sum.break_passes += report.break_passes;
    sum.assembly_seconds += report.assembly_seconds;
    sum.linear_solve_seconds += report.linear_solve_seconds;
    sum.fracture_seconds += report.fracture_seconds;
    sum.total_seconds += report.total_seconds;
    sum.broken_edges = report.broken_edges;
    sum.fragments = report.fragments;
    {
      ScopedTimer timer(surface_seconds);
      std::vector<int32_t> edges;
      const std::vector<int32_t>& all = simulation->broken_edges();
      std::set_difference(all.begin(), all.end(), broken.begin(), broken.end(),
                          std::back_inserter(edges));
      broken = all;
      surface.Break(edges);
      std::vector<Vec3> points;
      motion.Move(surface.topology(), simulation->positions(), points);
    }
    ScopedTimer timer(encode_seconds);
    Frame frame;
    frame.frame = simulation->frame();
    frame.time = simulation->time();
    frame.fragments = simulation->fragments();
    frame.positions = simulation->positions();
    frame.broken_edges = simulation->broken_edges();
    CLEAVE_RETURN_IF_ERROR(encoder.Encode(frame).status());
  }
  const double steps = sum.steps;
  const double total = sum.total_seconds;
  std::printf(
      "%8lld %-8s %7d %8.4f %7.2f %5.0f%% %5.0f%% %5.0f%% %8.4f %8.4f %7.1f %7.0f %7.1f %9.2f "
      "%8.1f "
      "%7lld %7.2f\n",
      static_cast<long long>(mesh.tet_count()), phase.name, threads, total / steps,
      1e6 * total / steps / static_cast<double>(mesh.tet_count()),
      100 * sum.assembly_seconds / total, 100 * sum.linear_solve_seconds / total,
      100 * sum.fracture_seconds / total, surface_seconds / phase.frames,
      encode_seconds / phase.frames, sum.newton_iterations / steps, sum.linear_iterations / steps,
      sum.break_passes / steps, 1e3 * sum.assembly_seconds / sum.newton_iterations,
      1e6 * sum.linear_solve_seconds / sum.linear_iterations,
      static_cast<long long>(sum.broken_edges), create_seconds);
  std::fflush(stdout);
  return absl::OkStatus();
}

absl::Status MeasureAll(const std::vector<double>& sizes) {
  for (const double tets : sizes) {
    CLEAVE_ASSIGN_OR_RETURN(const TetMesh mesh, BuildMesh(Bar(tets)));
    for (const Phase& phase : kPhases) {
      for (const int threads : {1, 2}) CLEAVE_RETURN_IF_ERROR(Measure(mesh, threads, phase));
    }
  }
  return absl::OkStatus();
}

absl::Status PrintGrowth(const std::vector<double>& sizes) {
  std::printf(
      "\nSteps of a pulled bar: elastic; with linear solves to 1e-6; breaking, 4 passes.\n\n");
  std::printf("%8s %-8s %7s %8s %7s %20s %17s %23s %18s\n", "", "", "", "a step", "a step",
              "share of the step", "seconds a frame", "iterations a step", "cost of one");
  std::printf("%8s %-8s %7s %8s %7s %6s %6s %6s %8s %8s %7s %7s %7s %9s %8s %7s %7s\n", "tets",
              "phase", "threads", "s", "us/tet", "assem", "linear", "fract", "surface", "encode",
              "newton", "cg", "passes", "newton ms", "cg us", "broken", "setup s");
  return MeasureAll(sizes);
}

absl::Status Run(const std::vector<std::string>& arguments) {
  const std::string table = arguments.empty() ? "" : arguments[0];
  if (table == "ratios") return PrintRatios();
  if (table == "slab") return PrintSlab();
  if (table == "column") return PrintColumn();
  if (table == "sleep") return PrintSleep();
  if (table == "surface") return PrintSurface();
  std::vector<double> sizes;
  for (const std::string& size : arguments) sizes.push_back(std::atof(size.c_str()));
  if (!sizes.empty()) return PrintGrowth(sizes);
  CLEAVE_RETURN_IF_ERROR(PrintRatios());
  CLEAVE_RETURN_IF_ERROR(PrintSlab());
  CLEAVE_RETURN_IF_ERROR(PrintColumn());
  CLEAVE_RETURN_IF_ERROR(PrintSleep());
  CLEAVE_RETURN_IF_ERROR(PrintSurface());
  return PrintGrowth({10e3, 40e3, 250e3});
}

}  // namespace
}  // namespace cleave

int main(int argc, char** argv) {
  const absl::Status status = cleave::Run({argv + 1, argv + argc});
  if (status.ok()) return 0;
  std::fprintf(stderr, "%s\n", std::string(status.message()).c_str());
  return 1;
}
