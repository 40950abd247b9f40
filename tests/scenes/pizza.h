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
// The same of any mesh of a pizza about the z axis, 0.3 m wide, that lies on z = 0; its cells are
// `cell_size` (m) long, and a thicker crust is cut to `crust_depth` (m).
Demonstration MakePizzaOf(TetMesh mesh, double cell_size, std::optional<double> crust_depth,
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
