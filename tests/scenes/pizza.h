#ifndef CLEAVE_TESTS_SCENES_PIZZA_H_
#define CLEAVE_TESTS_SCENES_PIZZA_H_

#include <optional>
#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// A pizza of dough under soft, ductile cheese, cut into eight through 60 % of its thickness, which
// is the dough: the cheese has flowed together again. One slice is lifted and pulled out by its
// crust. Variants: "cut"; "uncut"; "shuffled", what the cuts do dealt out to other nodes.
absl::StatusOr<Demonstration> MakePizza(const Setting& setting);

// What may differ from one pizza to another.
struct PizzaRecipe {
  std::optional<double> crust_depth = std::nullopt;  // m, to which a thicker crust is cut
  double cheese_failure_strain = 1.5;                // plastic strain at which cheese breaks
  double pull = 0.12;                                // m, that the slice is pulled out
  double seconds = 1;                                // s, lift and pull
};
// The same of any mesh of a pizza about the z axis, 0.3 m wide, that lies on z = 0; its cells are
// `cell_size` (m) long.
Demonstration MakePizzaOf(TetMesh mesh, double cell_size, const PizzaRecipe& recipe,
                          const Setting& setting);

// along_cuts: the share of broken edges with their midpoint within 1.5 cells of one of the eight
// cuts. slice_share: of the body's volume, the piece that holds most of what is pulled; 0 where
// that still hangs on to the rest. half_open: the frame in which half of what breaks is broken.
// strings: edges of cheese across a cut that are whole then and stretched to 1.5 or more.
Metrics MeasurePizza(const Demonstration& demonstration, const Incidence& incidence,
                     const Run& run);

std::vector<Criterion> PizzaCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_PIZZA_H_
