#ifndef CLEAVE_TESTS_SCENES_DEMONSTRATION_H_
#define CLEAVE_TESTS_SCENES_DEMONSTRATION_H_

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/base/vec3.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"
#include "core/simulation/simulation.h"
#include "core/stream/frame.h"
#include "tests/scenes/criteria.h"

// The paper's demonstrations, each defined once: for tests, the scene runner and pictures.
// Magnitudes are Cleave's own; what is claimed are orderings and geometry.

namespace cleave {

// What is to be simulated, and what its metrics need to know of it.
struct Demonstration {
  Scene scene;  // its mesh source is empty: the mesh is here
  TetMesh mesh;
  double cell_size = 0;                 // m, h
  std::vector<int32_t> grip = {};       // node ids of what holds
  std::vector<int32_t> pulled = {};     // node ids of what is moved
  size_t pull_motion = 0;               // the motion that moves it
  Vec3 pull_direction{1, 0, 0};         // unit
  double rest_length = 1;               // m, between the grips: what elongation counts by
  std::vector<uint8_t> in_map = {};     // nonzero: a node of the impurity map; empty: no map
  std::vector<Vec3> fibres = {};        // unit, a tet each; empty: no fibre to compare with
  int64_t frames_after_separation = 2;  // until a run ends
};

// One run, frame by frame; [0] is the rest state, reports[i] belongs to frames[i + 1].
struct Run {
  std::vector<Frame> frames;
  std::vector<FrameReport> reports;
  int64_t separation = -1;  // the frame in which grips came apart; -1: never
  // Equivalent, of every tet, when grips came apart or else at the end; empty where nothing flows.
  std::vector<double> plastic_strains = {};

  double SecondsPerFrame() const;
  // N, along the pull, a report each; empty where nothing is pulled.
  std::vector<double> PullForces(const Demonstration& demonstration) const;
  double PeakForce(const Demonstration& demonstration) const;  // N, along the pull
};

// Simulates until the scene's last frame, or a few after the grips came apart. InvalidArgument for
// a scene or mesh that Cleave refuses, naming every fault; what the simulation returns.
absl::StatusOr<Run> RunDemonstration(const Demonstration& demonstration, int threads = 1);

// What every run has: counts of pieces, dust, broken edges, frames of first fracture and
// separation, peak force, lift where there is a map, A(a) where there are fibres, seconds a frame.
Metrics CommonMetrics(const Demonstration& demonstration, const Incidence& incidence,
                      const Run& run);

// A demonstration by name.
struct DemonstrationKind {
  std::string name;   // of the runner, tests and pictures
  std::string title;  // what is seen
  std::string paper;  // the figure or section
  std::vector<std::string> variants;
  absl::StatusOr<Demonstration> (*make)(const Setting&);
  // Those of the demonstration's own, besides the common ones.
  Metrics (*measure)(const Demonstration&, const Incidence&, const Run&);
  std::vector<Criterion> criteria;
  std::vector<std::string> pictured = {};  // variants of the gallery; empty: all of the criteria
  double coarsest = 1;  // coarseness of short tests: with longer cells the body is no longer itself
};
std::span<const DemonstrationKind> DemonstrationKinds();
// NotFound, with the names that there are.
absl::StatusOr<const DemonstrationKind*> FindDemonstration(absl::string_view name);

// Runs and measures. Errors: those of RunDemonstration.
struct Outcome {
  Demonstration demonstration;
  Run run;
  Metrics metrics;
};
absl::StatusOr<Outcome> Measured(Demonstration demonstration,
                                 Metrics (*measure)(const Demonstration&, const Incidence&,
                                                    const Run&),
                                 int threads = 1);

// Makes, runs and measures in one go. Errors: NotFound for an unknown name; of the parts.
absl::StatusOr<Outcome> Demonstrate(const std::string& name, const Setting& setting,
                                    int threads = 1);

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_DEMONSTRATION_H_
