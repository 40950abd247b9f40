#include <tbb/global_control.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/status.h"
#include "core/base/stop_flag.h"
#include "core/simulation/simulation.h"
#include "tests/bench/core/step_cost.h"
#include "tests/scenes/slab_trio.h"

namespace cleave {
namespace {

struct Slab {
  std::string variant;
  size_t frames = 0;  // until long after it is torn
  std::unique_ptr<Simulation> simulation;
  std::vector<FrameReport> reports;

  double share() const { return (static_cast<double>(reports.size()) + 0.5) / frames; }
};

// Runs it once to see how many frames it takes, and makes it anew.
absl::StatusOr<Slab> MakeSlab(const std::string& variant, uint64_t seed) {
  Setting setting;
  setting.variant = variant;
  setting.seed = seed;
  setting.layout = MeshLayout::kJitteredLattice;
  CLEAVE_ASSIGN_OR_RETURN(const Demonstration made, MakeSlabTrio(setting));
  CLEAVE_ASSIGN_OR_RETURN(const Run run, RunDemonstration(made));
  Slab slab{variant, run.reports.size(), nullptr, {}};
  CLEAVE_ASSIGN_OR_RETURN(slab.simulation,
                          Simulation::Create(made.scene, made.mesh, {.threads = 1}));
  return slab;
}

// Prints a line and returns ms a solve, against `first` where that is not 0.
double PrintSolves(const Slab& slab, uint64_t seed, double first) {
  double solves = 0, newton = 0, linear = 0;
  double total = 0, assembly = 0, linear_solve = 0, fracture = 0;
  for (const FrameReport& report : slab.reports) {
    solves += report.steps + report.break_passes;
    newton += report.newton_iterations;
    linear += report.linear_iterations;
    total += report.total_seconds;
    assembly += report.assembly_seconds;
    linear_solve += report.linear_solve_seconds;
    fracture += report.fracture_seconds;
  }
  const double per_solve = 1e3 / solves;  // ms
  const double a_solve = total * per_solve;
  std::printf("%4d %-8s %8.2f %8.3f %8.2f %8.2f %8.2f %8.3f %8.2f %8.0f\n", static_cast<int>(seed),
              slab.variant.c_str(), a_solve, first > 0 ? a_solve / first : 1, assembly * per_solve,
              linear_solve * per_solve, fracture * per_solve, newton / solves, linear / newton,
              solves);
  std::fflush(stdout);
  return a_solve;
}

// Steps both until long after they are torn; ms a solve, `with` over `without`.
absl::StatusOr<double> PrintPair(const std::string& without, const std::string& with,
                                 uint64_t seed) {
  CLEAVE_ASSIGN_OR_RETURN(Slab first, MakeSlab(without, seed));
  CLEAVE_ASSIGN_OR_RETURN(Slab second, MakeSlab(with, seed));
  const StopFlag never;
  while (first.share() < 1 || second.share() < 1) {
    // Whichever lags behind, so that a machine that slows down slows both.
    Slab& slab = first.share() <= second.share() ? first : second;
    CLEAVE_ASSIGN_OR_RETURN(FrameReport report, slab.simulation->Advance(never));
    slab.reports.push_back(std::move(report));
  }
  const double of_first = PrintSolves(first, seed, 0);
  return PrintSolves(second, seed, of_first) / of_first;
}

}  // namespace

absl::Status PrintSlab() {
  tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
  std::printf(
      "\nSolves of scene `slab_trio` until long after the slab is torn, one thread: with fibres\n"
      "(aniso) against without (plain), and with impurities (impure) against without (iso), frame "
      "by\nframe in turn.\n\n");
  std::printf("%4s %-8s %8s %8s %8s %8s %8s %8s %8s %8s\n", "seed", "variant", "a solve", "ratio",
              "assembly", "linear", "fracture", "newton", "cg", "solves");
  for (const auto& [without, with] : {std::pair("plain", "aniso"), std::pair("iso", "impure")}) {
    std::vector<double> ratios;
    for (const uint64_t seed : {2, 3, 4, 5, 6}) {
      CLEAVE_ASSIGN_OR_RETURN(const double ratio, PrintPair(without, with, seed));
      ratios.push_back(ratio);
    }
    std::sort(ratios.begin(), ratios.end());
    std::printf("Median ratio, %s over %s: %.3f\n", with, without, ratios[ratios.size() / 2]);
  }
  return absl::OkStatus();
}

}  // namespace cleave
