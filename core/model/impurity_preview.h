#ifndef CLEAVE_CORE_MODEL_IMPURITY_PREVIEW_H_
#define CLEAVE_CORE_MODEL_IMPURITY_PREVIEW_H_

#include <array>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// What the impurities of a scene do to its body before the first step. Ids are the client's.
struct ImpurityPreview {
  std::vector<double> potencies;              // alpha, a node each
  std::vector<std::array<int32_t, 2>> edges;  // their nodes, by edge id
  // What layers make strengths count, w, [0, infinity], an edge each.
  std::vector<double> weakenings;
  // Tensile strength, Pa, an edge each: kappa w tau; infinite where nothing breaks.
  std::vector<double> strengths;
  std::vector<uint8_t> affected;  // an edge each: 1 where w or kappa is not 1
  int64_t affected_edges = 0;
  double weakest = 0;    // Pa, of all strengths
  double strongest = 0;  // Pa
};

// Makes the model and reads its thresholds, so that they are those of the first step; takes the
// time and the memory of that. Errors: InvalidArgument for a scene without impurities, and those of
// BuildModel. Preconditions: those of BuildModel.
absl::StatusOr<ImpurityPreview> PreviewImpurities(const Scene& scene, const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_IMPURITY_PREVIEW_H_
