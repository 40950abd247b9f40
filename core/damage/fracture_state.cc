// Saving and restoring the fracture state.

#include <utility>

#include "absl/strings/str_cat.h"
#include "core/damage/fracture.h"

namespace cleave {

std::vector<int32_t> EdgeFracture::BrokenEdges() const {
  std::vector<int32_t> edges;
  edges.reserve(static_cast<size_t>(broken_count_));
  for (size_t edge = 0; edge < broken_.size(); ++edge) {
    if (broken_[edge] != 0) edges.push_back(static_cast<int32_t>(edge));
  }
  return edges;
}

void EdgeFracture::Save(ByteWriter& out) const {
  out.PutVector(BrokenEdges());
  // Tets with no broken edge are intact; the others follow in order.
  std::vector<double> damaged;
  for (size_t tet = 0; tet < masks_.size(); ++tet) {
    if (masks_[tet] != 0) damaged.push_back(factors_[tet]);
  }
  out.PutVector(damaged);
}

absl::Status EdgeFracture::Restore(ByteReader& in) {
  const std::vector<int32_t> edges = in.GetVector<int32_t>();
  const std::vector<double> damaged = in.GetVector<double>();
  if (!in.ok()) return absl::DataLossError("fracture state is truncated");
  for (size_t i = 0; i < edges.size(); ++i) {
    if (edges[i] < 0 || edges[i] >= incidence_.edge_count() || (i > 0 && edges[i] <= edges[i - 1]))
      return absl::DataLossError(absl::StrCat("fracture state: broken edge ", edges[i],
                                              " is out of order or outside [0, ",
                                              incidence_.edge_count(), ")"));
  }
  std::vector<EdgeMask> masks = TetEdgeMasks(incidence_, edges);
  std::vector<double> factors(masks.size(), 1.0);
  size_t next = 0;
  for (size_t tet = 0; tet < masks.size(); ++tet) {
    if (masks[tet] == 0) continue;
    if (next == damaged.size()) return absl::DataLossError("fracture state: factors are missing");
    factors[tet] = damaged[next++];
    const bool in_range = factors[tet] == 0 || (factors[tet] >= kDeadFactor && factors[tet] <= 1);
    if (!in_range || (Separated(masks[tet]) && factors[tet] != 0))
      return absl::DataLossError(
          absl::StrCat("fracture state: tet ", tet, " cannot have factor ", factors[tet]));
  }
  if (next != damaged.size())
    return absl::DataLossError("fracture state: more factors than damaged tets");
  broken_.assign(broken_.size(), 0);
  for (const int32_t edge : edges) broken_[static_cast<size_t>(edge)] = 1;
  broken_count_ = static_cast<int64_t>(edges.size());
  masks_ = std::move(masks);
  factors_ = std::move(factors);
  components_fresh_ = false;
  return absl::OkStatus();
}

}  // namespace cleave
