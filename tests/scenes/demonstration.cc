#include "tests/scenes/demonstration.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "core/base/status.h"
#include "core/base/stop_flag.h"
#include "core/mesh/mesh_check.h"
#include "core/scene/validate.h"
#include "tests/metrics/crack_surface.h"
#include "tests/metrics/pieces.h"

namespace cleave {
namespace {

Frame FrameOf(const Simulation& simulation) {
  Frame frame;
  frame.frame = simulation.frame();
  frame.time = simulation.time();
  frame.fragments = simulation.fragments();
  frame.positions = simulation.positions();
  frame.broken_edges = simulation.broken_edges();
  return frame;
}

}  // namespace

double Run::SecondsPerFrame() const {
  double seconds = 0;
  for (const FrameReport& report : reports) seconds += report.total_seconds;
  return reports.empty() ? 0 : seconds / static_cast<double>(reports.size());
}

std::vector<double> Run::PullForces(const Demonstration& demonstration) const {
  std::vector<double> forces;
  for (const FrameReport& report : reports) {
    if (demonstration.pull_motion >= report.motion_forces.size()) return {};
    const Vec3& force = report.motion_forces[demonstration.pull_motion];
    double along = 0;
    for (size_t axis = 0; axis < 3; ++axis)
      along += force[axis] * demonstration.pull_direction[axis];
    forces.push_back(along);
  }
  return forces;
}

double Run::PeakForce(const Demonstration& demonstration) const {
  double peak = 0;
  for (const double force : PullForces(demonstration)) peak = std::max(peak, force);
  return peak;
}

absl::StatusOr<Run> RunDemonstration(const Demonstration& demonstration, int threads) {
  TetMesh mesh = demonstration.mesh;
  CLEAVE_RETURN_IF_ERROR(CheckAndOrientMesh(mesh).ToStatus());
  Scene scene = demonstration.scene;
  // A scene has to say where its mesh is from; the rules know nothing of one made here.
  scene.mesh.source = MeshAsset{std::string(64, '0')};
  CLEAVE_RETURN_IF_ERROR(ValidateScene(scene).ToStatus());
  CLEAVE_RETURN_IF_ERROR(ValidateSceneWithMesh(scene, mesh).ToStatus());
  const Incidence incidence = BuildIncidence(mesh);
  CLEAVE_ASSIGN_OR_RETURN(const auto simulation,
                          Simulation::Create(demonstration.scene, mesh, {.threads = threads}));
  Run run;
  run.frames.push_back(FrameOf(*simulation));
  const StopFlag never;
  int64_t left = demonstration.scene.timing.frame_count;
  while (left-- > 0) {
    CLEAVE_ASSIGN_OR_RETURN(FrameReport report, simulation->Advance(never));
    run.reports.push_back(std::move(report));
    run.frames.push_back(FrameOf(*simulation));
    if (run.separation < 0) run.plastic_strains = simulation->plastic_strains();
    if (run.separation >= 0 || demonstration.grip.empty() || demonstration.pulled.empty()) continue;
    const std::span<const Frame> last(&run.frames.back(), 1);
    if (run.reports.back().new_broken_edges > 0 &&
        Separation(mesh, incidence, last, demonstration.grip, demonstration.pulled) == 0) {
      run.separation = static_cast<int64_t>(run.frames.size()) - 1;
      left = std::min(left, demonstration.frames_after_separation);
    }
  }
  return run;
}

Metrics CommonMetrics(const Demonstration& demonstration, const Incidence& incidence,
                      const Run& run) {
  const std::vector<int32_t>& broken = run.frames.back().broken_edges;
  const Pieces pieces = PiecesOf(demonstration.mesh, incidence, broken);
  Metrics metrics;
  metrics["tets"] = static_cast<double>(demonstration.mesh.tet_count());
  metrics["frames"] = static_cast<double>(run.reports.size());
  metrics["broken_edges"] = static_cast<double>(broken.size());
  metrics["pieces"] = pieces.count;
  metrics["dust"] = pieces.dust_count;
  metrics["dust_share"] = pieces.dust_share;
  metrics["first_fracture"] =
      static_cast<double>(FirstFracture(run.frames, incidence.edge_count()));
  metrics["separation"] = static_cast<double>(run.separation);
  metrics["peak_force"] = run.PeakForce(demonstration);
  metrics["seconds_per_frame"] = run.SecondsPerFrame();
  if (!demonstration.in_map.empty()) {
    const BandShare share = ShareInBand(incidence, broken, demonstration.in_map);
    metrics["band_share"] = share.band;
    metrics["band_base"] = share.base;
    metrics["lift"] = share.lift;
  }
  const std::vector<CrackFacet> crack = CrackOfPieces(demonstration.mesh, incidence, broken);
  metrics["crack_area"] = CrackArea(crack);
  if (!demonstration.fibres.empty()) {
    const auto fibre = [&](int32_t tet) { return demonstration.fibres[static_cast<size_t>(tet)]; };
    metrics["fibre_crossing"] = FibreCrossing(crack, fibre);
    metrics["fibre_crossing_smooth"] =
        FibreCrossing(SmoothedCrack(crack, 2 * demonstration.cell_size), fibre);
  }
  return metrics;
}

absl::StatusOr<Outcome> Measured(Demonstration demonstration,
                                 Metrics (*measure)(const Demonstration&, const Incidence&,
                                                    const Run&),
                                 int threads) {
  Outcome outcome;
  outcome.demonstration = std::move(demonstration);
  CLEAVE_RETURN_IF_ERROR(CheckAndOrientMesh(outcome.demonstration.mesh).ToStatus());
  CLEAVE_ASSIGN_OR_RETURN(outcome.run, RunDemonstration(outcome.demonstration, threads));
  const Incidence incidence = BuildIncidence(outcome.demonstration.mesh);
  outcome.metrics = CommonMetrics(outcome.demonstration, incidence, outcome.run);
  outcome.metrics.merge(measure(outcome.demonstration, incidence, outcome.run));
  return outcome;
}

absl::StatusOr<const DemonstrationKind*> FindDemonstration(absl::string_view name) {
  std::vector<std::string> names;
  for (const DemonstrationKind& kind : DemonstrationKinds()) {
    if (kind.name == name) return &kind;
    names.push_back(kind.name);
  }
  return absl::NotFoundError(absl::StrCat("no demonstration is called ", name,
                                          "; there are: ", absl::StrJoin(names, ", ")));
}

absl::StatusOr<Outcome> Demonstrate(const std::string& name, const Setting& setting, int threads) {
  CLEAVE_ASSIGN_OR_RETURN(const DemonstrationKind* kind, FindDemonstration(name));
  if (std::find(kind->variants.begin(), kind->variants.end(), setting.variant) ==
      kind->variants.end()) {
    return absl::NotFoundError(absl::StrCat(name, " has no variant ", setting.variant,
                                            "; there are: ", absl::StrJoin(kind->variants, ", ")));
  }
  CLEAVE_ASSIGN_OR_RETURN(Demonstration demonstration, kind->make(setting));
  return Measured(std::move(demonstration), kind->measure, threads);
}

}  // namespace cleave
