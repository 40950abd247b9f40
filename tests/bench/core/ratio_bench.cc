#include <cmath>
#include <cstdio>

#include "core/base/status.h"
#include "core/mesh/procedural.h"
#include "tests/bench/core/step_cost.h"
#include "tests/bench/pulled_bar.h"

namespace cleave {
namespace {

// A bar that is pulled and twisted, as yet whole: what a step costs without what is asked for.
Scene Plain() {
  Material wood;
  wood.youngs_modulus = 1e7;
  wood.poisson_ratio = 0.3;
  wood.density = 700;
  wood.tensile_strength = 1e7;
  return PulledBar(wood, 0.03, 0.5, 240);
}

}  // namespace

absl::Status PrintRatios() {
  BoxMesh box;
  box.size = {0.3, 0.1, 0.1};
  box.resolution.layout = MeshLayout::kJitteredLattice;
  box.resolution.cell_size = 0.1 / 13;
  CLEAVE_ASSIGN_OR_RETURN(const TetMesh mesh, BuildMesh(box));

  std::vector<BenchCase> cases = {{"isotropic", Plain(), 1}};
  const auto add = [&](const char* name) -> Scene& {
    return cases.emplace_back(BenchCase{name, Plain(), 1}).scene;
  };
  add("anisotropic").materials[0].fibres.push_back({3e7, ConstantDirection{{1, 1, 0}}, 1});
  Scene& two = add("two families");
  two.materials[0].fibres = {{3e7, ConstantDirection{{1, 1, 0}}, 1},
                             {3e7, ConstantDirection{{1, -1, 0}}, 1}};
  Impurities impurities;
  impurities.potency = 0.5;
  impurities.noise = 0.5;
  add("impure").impurities = impurities;
  add("float").quality.precision = Precision::kFloat;
  Scene& both = add("float, anisotropic");
  both.quality.precision = Precision::kFloat;
  both.materials[0].fibres.push_back({3e7, ConstantDirection{{1, 1, 0}}, 1});

  CLEAVE_ASSIGN_OR_RETURN(const std::vector<StepCost> costs, MeasureSteps(mesh, cases, 4, 5));
  std::printf(
      "\nSteps of a bar of %lld tets before it breaks, one thread, against the isotropic one in\n"
      "double. Assembly is that of a Newton iteration, linear that of an iteration of the "
      "solve.\n\n",
      static_cast<long long>(mesh.tet_count()));
  std::printf("%-20s %9s %8s %9s %8s %9s %8s %7s %7s %7s\n", "scene", "a step s", "ratio",
              "newton ms", "ratio", "cg us", "ratio", "newton", "cg", "broken");
  const StepCost& first = costs[0];
  for (size_t k = 0; k < cases.size(); ++k) {
    const StepCost& cost = costs[k];
    const auto newton = [](const StepCost& c) { return 1e3 * c.assembly / c.newton_iterations; };
    const auto cg = [](const StepCost& c) { return 1e6 * c.linear / c.linear_iterations; };
    std::printf("%-20s %9.4f %8.3f %9.2f %8.3f %9.1f %8.3f %7d %7d %7lld\n", cases[k].name.c_str(),
                cost.total / cost.steps, cost.total / first.total, newton(cost),
                newton(cost) / newton(first), cg(cost), cg(cost) / cg(first),
                cost.newton_iterations, cost.linear_iterations, cost.broken_edges);
  }
  return absl::OkStatus();
}

}  // namespace cleave
