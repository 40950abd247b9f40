// The list of all demonstrations.

#include <array>

#include "tests/scenes/demonstration.h"
#include "tests/scenes/fibre_bar.h"

namespace cleave {

std::span<const DemonstrationKind> DemonstrationKinds() {
  static const std::array kKinds = {
      DemonstrationKind{"fibre_bar",
                        "Eq. 6",
                        {"fibre0", "fibre30", "fibre60", "fibre90", "iso0", "iso30", "iso60",
                         "iso90", "plain30", "plain60", "stiff30", "stiff60"},
                        MakeFibreBar,
                        MeasureFibreBar},
  };
  return kKinds;
}

}  // namespace cleave
