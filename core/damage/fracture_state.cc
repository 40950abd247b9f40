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
  if (!strands_.empty()) {
    std::vector<int32_t> strands;
    for (int32_t tet = 0; tet < static_cast<int32_t>(masks_.size()); ++tet) {
      if (IsStrand(tet)) strands.push_back(tet);
    }
    out.PutVector(strands);
  }
  // Tets with no broken edge are intact, but for strands; the others follow in order.
  std::vector<double> damaged;
  for (size_t tet = 0; tet < masks_.size(); ++tet) {
    if (masks_[tet] != 0 || IsStrand(static_cast<int32_t>(tet))) damaged.push_back(factors_[tet]);
  }
  out.PutVector(damaged);
}

absl::Status EdgeFracture::Restore(ByteReader& in) {
  const std::vector<int32_t> edges = in.GetVector<int32_t>();
  const std::vector<int32_t> strands =
      strands_.empty() ? std::vector<int32_t>() : in.GetVector<int32_t>();
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
  std::vector<TetLoad> loads(masks.size(), kNone);
  for (size_t i = 0; i < strands.size(); ++i) {
    const bool in_order = strands[i] >= 0 && static_cast<size_t>(strands[i]) < masks.size() &&
                          (i == 0 || strands[i] > strands[i - 1]);
    if (!in_order || strands_.Of(strands[i]) == nullptr ||
        masks[static_cast<size_t>(strands[i])] == kAllEdges)
      return absl::DataLossError(
          absl::StrCat("fracture state: tet ", strands[i], " cannot be a strand"));
    loads[static_cast<size_t>(strands[i])] = kOut;
  }
  int64_t dead = 0;
  size_t next = 0;
  for (size_t tet = 0; tet < masks.size(); ++tet) {
    const bool is_strand = loads[tet] == kOut;
    if (masks[tet] == 0 && !is_strand) continue;
    if (next == damaged.size()) return absl::DataLossError("fracture state: factors are missing");
    factors[tet] = damaged[next++];
    const bool in_range = factors[tet] == 0 || (factors[tet] >= kDeadFactor && factors[tet] <= 1);
    const bool may_live = is_strand || !Separated(masks[tet]);
    if (!in_range || (factors[tet] != 0 ? !may_live : is_strand))
      return absl::DataLossError(
          absl::StrCat("fracture state: tet ", tet, " cannot have factor ", factors[tet]));
    if (factors[tet] > 0) continue;
    loads[tet] = kOut;
    ++dead;
  }
  if (next != damaged.size())
    return absl::DataLossError("fracture state: more factors than damaged tets");
  broken_.assign(broken_.size(), 0);
  for (const int32_t edge : edges) broken_[static_cast<size_t>(edge)] = 1;
  broken_count_ = static_cast<int64_t>(edges.size());
  masks_ = std::move(masks);
  factors_ = std::move(factors);
  loads_ = std::move(loads);
  dead_count_ = dead;
  components_fresh_ = false;
  return absl::OkStatus();
}

}  // namespace cleave
