#include "core/model/impurity_preview.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "absl/status/status.h"
#include "core/base/status.h"
#include "core/damage/random_graph.h"
#include "core/impurity/bake.h"
#include "core/mesh/incidence.h"
#include "core/model/build_model.h"

namespace cleave {

absl::StatusOr<ImpurityPreview> PreviewImpurities(const Scene& scene, const TetMesh& mesh) {
  if (!scene.impurities.has_value())
    return absl::InvalidArgumentError("impurities: the scene has none");
  CLEAVE_ASSIGN_OR_RETURN(const Model model, BuildModel(scene, mesh));
  ImpurityPreview preview;
  preview.edges = BuildIncidence(mesh).edges;
  BakedImpurities baked = BakeImpurities(scene, mesh, preview.edges);
  preview.potencies = std::move(baked.potencies);
  preview.weakenings = std::move(baked.edge_factors);
  preview.weakenings.resize(preview.edges.size(), 1);
  preview.strengths.assign(preview.edges.size(), std::numeric_limits<double>::infinity());
  preview.affected.assign(preview.edges.size(), 0);
  for (size_t edge = 0; edge < preview.edges.size(); ++edge)
    preview.affected[edge] = preview.weakenings[edge] != 1;
  if (model.fracture) {
    const FracturePart& part = *model.fracture;
    const auto threshold = [&](size_t edge) {
      return part.edge_thresholds[part.edge_thresholds.size() == 1 ? 0 : edge];
    };
    for (size_t edge = 0; edge < preview.edges.size(); ++edge)
      preview.strengths[static_cast<size_t>(part.client_edge[edge])] = threshold(edge);
    if (part.impurities) {
      const RandomGraph graph(*model.incidence, part.impurities->settings,
                              part.impurities->potencies, part.impurities->edge_draws,
                              part.impurities->edge_deal);
      for (size_t edge = 0; edge < preview.edges.size(); ++edge) {
        const auto client = static_cast<size_t>(part.client_edge[edge]);
        const double factor = graph.factors()[edge];
        preview.strengths[client] *= factor;
        // Pure bonds count 1 but for rounding.
        if (std::abs(factor - 1) > 1e-12) preview.affected[client] = 1;
      }
    }
  }
  preview.affected_edges = std::count(preview.affected.begin(), preview.affected.end(), 1);
  const auto [weakest, strongest] =
      std::minmax_element(preview.strengths.begin(), preview.strengths.end());
  preview.weakest = *weakest;
  preview.strongest = *strongest;
  return preview;
}

}  // namespace cleave
