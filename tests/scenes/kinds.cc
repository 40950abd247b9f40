// The list of all demonstrations.

#include <vector>

#include "tests/scenes/branch.h"
#include "tests/scenes/column.h"
#include "tests/scenes/demonstration.h"
#include "tests/scenes/ductile_bar.h"
#include "tests/scenes/fibre_bar.h"
#include "tests/scenes/locality.h"
#include "tests/scenes/meat_loaf.h"
#include "tests/scenes/slab_trio.h"
#include "tests/scenes/steak.h"

namespace cleave {

std::span<const DemonstrationKind> DemonstrationKinds() {
  static const std::vector<DemonstrationKind> kKinds = {
      {"fibre_bar",
       "Eq. 6",
       {"fibre0", "fibre30", "fibre60", "fibre90", "iso0", "iso30", "iso60", "iso90", "plain30",
        "plain60", "stiff30", "stiff60"},
       MakeFibreBar,
       MeasureFibreBar},
      {"slab_trio",
       "Figs. 14 and 15",
       {"iso", "aniso", "impure", "shuffled", "turned"},
       MakeSlabTrio,
       MeasureSlabTrio},
      {"ductile_bar", "Fig. 3", {"gold", "alloy", "off"}, MakeDuctileBar, MeasureDuctileBar},
      {"branch",
       "Figs. 7 and 13",
       {"dry", "damp", "dry-iso", "damp-iso"},
       MakeBranch,
       MeasureBranch},
      {"locality", "Fig. 5, sec. 5", {"without", "with"}, MakeLocality, MeasureLocality},
      {"steak", "Figs. 1 and 13", {"meat", "iso", "turned"}, MakeSteak, MeasureSteak},
      {"meat_loaf", "Fig. 2", {"loaf", "meat"}, MakeMeatLoaf, MeasureMeatLoaf},
      {"column", "sec. 7.7.2", {"sheet", "plain"}, MakeColumn, MeasureColumn},
  };
  return kKinds;
}

}  // namespace cleave
