#ifndef CLEAVE_TESTS_SCENES_FIGURE_H_
#define CLEAVE_TESTS_SCENES_FIGURE_H_

#include <vector>

#include "tests/scenes/demonstration.h"

namespace cleave {

// A brittle figure of capsules (torso, head, two arms, two legs), held at head, feet and one hand,
// with a ring of impurities round its other arm, the fist of which two prongs strike from behind.
// Its arm is stronger than all that holds the figure together: without the ring the blow tears that
// apart, and with it the arm comes off before the rest has borne much.
//
// Variants: "graph"; "off", without the random graph, by which alone the paper's impurities act on
// strength: the pure body; "uncorrelated", the other reading of "without": the strengths of the
// impurities dealt out to edges, without the graph; "static", whose lost bonds do not count, for
// comparison; "shuffled", the ring's potencies dealt out to nodes.
absl::StatusOr<Demonstration> MakeFigure(const Setting& setting);

// Any body of that plaster with such a ring, as the variant has it; nothing holds or strikes it.
Demonstration MakeRingedPlaster(TetMesh mesh, double cell_size, const ImpuritySource& ring,
                                const Setting& setting);

// arm_share: of the rest volume, the piece that holds most nodes of the struck fist.
Metrics MeasureFigure(const Demonstration& demonstration, const Incidence& incidence,
                      const Run& run);

std::vector<Criterion> FigureCriteria();

}  // namespace cleave

#endif  // CLEAVE_TESTS_SCENES_FIGURE_H_
