#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "core/base/status.h"
#include "core/base/stopwatch.h"
#include "core/impurity/bake.h"
#include "core/mesh/incidence.h"
#include "core/mesh/procedural.h"
#include "tests/bench/core/step_cost.h"

namespace cleave {
namespace {

// So small a push that one Newton iteration does, with its linear solve to 1e-6.
Scene Column(Precision precision) {
  Scene scene;
  Material material;
  material.youngs_modulus = 1e6;
  material.poisson_ratio = 0.3;
  material.density = 1000;
  material.tensile_strength = 1e5;
  scene.materials.push_back(material);
  NodeSet foot;
  foot.name = "foot";
  foot.select.push_back(BoxSelector{{-1, -1, -1}, {1, 1, 1e-6}});
  scene.node_sets.push_back(foot);
  Motion pinned;
  pinned.node_set = "foot";
  scene.motions.push_back(pinned);
  scene.gravity = Vec3{1e-4, 0, 0};
  scene.timing.frames_per_second = 60;
  scene.timing.steps_per_frame = 1;
  scene.quality.linear_tolerance = 1e-6;
  scene.quality.residual_tolerance = 1e-5;
  scene.quality.step_tolerance = 0.5;
  scene.quality.precision = precision;
  return scene;
}

// Sixteen sheets through the column, each a stroke right through it.
Scene CutColumn() {
  Scene scene = Column(Precision::kDouble);
  Strokes strokes;
  strokes.direction = {0, 1, 0};
  for (int k = 0; k < 16; ++k) {
    const double height = 0.05 + 0.06 * k;
    strokes.curves.push_back({{{-0.2, 0, height - 0.03}, {0.2, 0, height + 0.03}}});
  }
  ImpurityLayer layer;
  layer.source = strokes;
  layer.weakening = 0.1;
  scene.impurities.emplace().layers.push_back(layer);
  return scene;
}

// s, the least of five.
double BakeSeconds(const Scene& scene, const TetMesh& mesh, const Incidence& incidence) {
  double least = 1e300;
  for (int round = 0; round < 5; ++round) {
    const Stopwatch watch;
    const BakedImpurities baked = BakeImpurities(scene, mesh, incidence.edges);
    least = std::min(least, watch.Seconds());
  }
  return least;
}

// How fast one thread reads so many bytes over and over, bytes/s: the best of five.
double ReadingRate(int64_t bytes) {
  const Eigen::ArrayXf block = Eigen::ArrayXf::Ones(bytes / static_cast<int64_t>(sizeof(float)));
  constexpr int kRounds = 100;
  double least = 1e300;
  float sum = 0;
  for (int round = 0; round < 5; ++round) {
    const Stopwatch watch;
    for (int k = 0; k < kRounds; ++k) sum += block.sum();
    least = std::min(least, watch.Seconds());
  }
  return sum > 0 ? kRounds * static_cast<double>(bytes) / least : 0;
}

}  // namespace

absl::Status PrintColumn() {
  CylinderMesh cylinder;
  cylinder.radius = 0.1;
  cylinder.height = 1;
  cylinder.resolution.cell_size = 0.019;
  CLEAVE_ASSIGN_OR_RETURN(const TetMesh mesh, BuildMesh(cylinder));
  std::vector<BenchCase> cases;
  for (const Precision precision : {Precision::kDouble, Precision::kFloat}) {
    for (const int threads : {1, 2})
      cases.push_back(
          {precision == Precision::kFloat ? "float" : "double", Column(precision), threads});
  }
  CLEAVE_ASSIGN_OR_RETURN(const std::vector<StepCost> costs, MeasureSteps(mesh, cases, 2, 5));
  const Incidence incidence = BuildIncidence(mesh);
  const int64_t edges = incidence.edge_count();
  const int64_t matrix_bytes = 2 * (36 + 4) * edges;
  std::printf(
      "\nA step of 1/60 s of a column of %lld tets, %lld nodes, %lld edges, E = 1e6 Pa, linear "
      "solves\nto 1e-6. A linear iteration reads %.1f MB of matrix.\n\n",
      static_cast<long long>(mesh.tet_count()), static_cast<long long>(mesh.node_count()),
      static_cast<long long>(edges), 1e-6 * static_cast<double>(matrix_bytes));
  std::printf("%-9s %7s %9s %9s %9s %9s %7s %7s %8s %7s\n", "precision", "threads", "a step s",
              "assembly", "linear", "fracture", "newton", "cg", "cg us", "GB/s");
  for (size_t k = 0; k < cases.size(); ++k) {
    const StepCost& cost = costs[k];
    const double steps = cost.steps;
    const double iteration = cost.linear / cost.linear_iterations;
    std::printf("%-9s %7d %9.4f %9.4f %9.4f %9.4f %7.1f %7.1f %8.1f %7.1f\n", cases[k].name.c_str(),
                cases[k].threads, cost.total / steps, cost.assembly / steps, cost.linear / steps,
                cost.fracture / steps, cost.newton_iterations / steps,
                cost.linear_iterations / steps, 1e6 * iteration,
                1e-9 * static_cast<double>(matrix_bytes) / iteration);
  }
  const double rate = ReadingRate(matrix_bytes);
  const double reached =
      static_cast<double>(matrix_bytes) * costs[0].linear_iterations / costs[0].linear;
  std::printf(
      "\nOne thread that does nothing else reads that much at %.1f GB/s. Linear iterations, most "
      "of "
      "a\nstep, reach %.0f %% of that: %s bound them.\n",
      1e-9 * rate, 100 * reached / rate,
      reached > 0.6 * rate ? "reads of memory" : "instructions, not reads of memory,");
  std::printf("\nEmbedding 16 cuts, each a sheet right through it: %.4f s.\n",
              BakeSeconds(CutColumn(), mesh, incidence));
  return absl::OkStatus();
}

}  // namespace cleave
