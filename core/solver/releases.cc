#include "core/solver/releases.h"

#include <algorithm>
#include <vector>

#include "core/damage/components.h"

namespace cleave {

Releases::Releases(const Model& model, const Breaking* breaking) : model_(model) {
  if (breaking != nullptr) cut_edges_ = breaking->broken_edge_count();
}

void Releases::Update(double time, const Breaking* breaking, State& state) {
  const int64_t broken_edges = breaking != nullptr ? breaking->broken_edge_count() : 0;
  if (broken_edges != seen_broken_edges_) {
    seen_broken_edges_ = broken_edges;
    const auto edges = static_cast<size_t>(model_.incidence->edge_count());
    progress_.broken_share =
        static_cast<double>(broken_edges - cut_edges_) / static_cast<double>(edges);
    const std::vector<uint8_t> whole(breaking != nullptr ? 0 : edges, 0);
    const int32_t pieces = LabelComponents(
        *model_.incidence, breaking != nullptr ? breaking->fracture().edge_broken() : whole,
        progress_.node_pieces);
    std::vector<int32_t> sizes(static_cast<size_t>(pieces), 0);
    for (const int32_t piece : progress_.node_pieces) {
      if (piece >= 0) ++sizes[static_cast<size_t>(piece)];
    }
    progress_.pieces =
        std::count_if(sizes.begin(), sizes.end(), [](int32_t size) { return size > 1; });
  }
  for (size_t rule = 0; rule < model_.releases.size(); ++rule) {
    if (state.released[rule] == 0 && IsDue(model_.releases[rule], time, progress_))
      state.released[rule] = 1;
  }
}

}  // namespace cleave
