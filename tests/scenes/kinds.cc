// The list of all demonstrations.

#include <vector>

#include "tests/scenes/branch.h"
#include "tests/scenes/column.h"
#include "tests/scenes/demonstration.h"
#include "tests/scenes/drawn_slab.h"
#include "tests/scenes/ductile_bar.h"
#include "tests/scenes/fibre_bar.h"
#include "tests/scenes/figure.h"
#include "tests/scenes/locality.h"
#include "tests/scenes/meat_loaf.h"
#include "tests/scenes/noise_models.h"
#include "tests/scenes/pizza.h"
#include "tests/scenes/slab_trio.h"
#include "tests/scenes/steak.h"
#include "tests/scenes/struck_column.h"
#include "tests/scenes/tube.h"

namespace cleave {

std::span<const DemonstrationKind> DemonstrationKinds() {
  static const std::vector<DemonstrationKind> kKinds = {
      {"fibre_bar",
       "Bars with fibres at four angles to the pull",
       "Eq. 6",
       {"fibre0", "fibre30", "fibre60", "fibre90", "iso0", "iso30", "iso60", "iso90", "plain30",
        "plain60", "stiff30", "stiff60"},
       MakeFibreBar,
       MeasureFibreBar,
       FibreBarCriteria(),
       {},
       1.4},
      {"slab_trio",
       "A slab, isotropic, with fibres, and with flaws",
       "Figs. 14 and 15",
       {"iso", "aniso", "impure", "shuffled", "turned", "plain", "projected", "projected-coarse",
        "scored", "ruled", "ruled-coarse"},
       MakeSlabTrio,
       MeasureSlabTrio,
       SlabTrioCriteria(),
       {"iso", "aniso", "impure", "shuffled", "turned"},
       2},
      {"ductile_bar",
       "A bar of gold and one of gold-copper",
       "Fig. 3",
       {"gold", "alloy", "off"},
       MakeDuctileBar,
       MeasureDuctileBar,
       DuctileBarCriteria(),
       {},
       2.6},
      {"branch",
       "A branch, dry and damp",
       "Figs. 7 and 13",
       {"dry", "damp", "dry-iso", "damp-iso", "dry-fall", "damp-fall"},
       MakeBranch,
       MeasureBranch,
       BranchCriteria(),
       {},
       2},
      {"locality",
       "Two slabs, one with an impure node",
       "Fig. 5, sec. 5",
       {"without", "with", "shuffled"},
       MakeLocality,
       MeasureLocality,
       LocalityCriteria(),
       {},
       2},
      {"steak",
       "A steak, torn",
       "Figs. 1 and 13",
       {"meat", "iso", "turned"},
       MakeSteak,
       MeasureSteak,
       SteakCriteria(),
       {},
       2},
      {"meat_loaf",
       "A meat loaf with a crust of bread",
       "Fig. 2",
       {"loaf", "meat"},
       MakeMeatLoaf,
       MeasureMeatLoaf,
       MeatLoafCriteria(),
       {},
       1.9},
      {"column",
       "A porcelain column with a weak sheet",
       "sec. 7.7.2",
       {"sheet", "plain"},
       MakeColumn,
       MeasureColumn,
       ColumnCriteria(),
       {},
       2},
      {"tube",
       "A tube with a ring of impurities, ever more potent",
       "Fig. 8",
       {"1", "2", "3", "4", "5", "shuffled", "pure"},
       MakeTube,
       MeasureTube,
       TubeCriteria(),
       {},
       1.6},
      {"struck_column",
       "A porcelain column, struck by a steel ball",
       "Fig. 9",
       {"sheet", "voronoi", "plain", "sheet-shuffled", "voronoi-shuffled"},
       MakeStruckColumn,
       MeasureStruckColumn,
       StruckColumnCriteria(),
       {},
       1.7},
      {"figure",
       "A figure, struck at the arm with the ring",
       "Fig. 11",
       {"graph", "off", "static", "uncorrelated", "shuffled"},
       MakeFigure,
       MeasureFigure,
       FigureCriteria(),
       {},
       1.3},
      {"pizza",
       "A pizza, a slice pulled out",
       "Figs. 1 and 6",
       {"cut", "uncut", "shuffled"},
       MakePizza,
       MeasurePizza,
       PizzaCriteria(),
       {},
       1.6},
      {"noise_models",
       "A tube with Gaussian noise and with uniform noise",
       "Fig. 12",
       NoiseModelsVariants(),
       MakeNoiseModels,
       MeasureNoiseModels,
       NoiseModelsCriteria(),
       {"gaussian-1", "uniform-1", "strong-1"},
       1.5},
#ifdef CLEAVE_SCENES_WITH_PICTURES
      {"drawn_slab",
       "A slab with a drawing pushed through it",
       "Fig. 10",
       {"drawn", "turned", "plain", "shuffled"},
       MakeDrawnSlab,
       MeasureDrawnSlab,
       DrawnSlabCriteria(),
       {},
       1.6},
#endif
  };
  return kKinds;
}

}  // namespace cleave
