#include "core/solver/breaking.h"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace cleave {
namespace {

Broadcast<double> OneOrEach(const std::vector<double>& values) {
  return values.size() == 1 ? Broadcast<double>::Uniform(values[0])
                            : Broadcast<double>::PerItem(values.data());
}

EdgeStrengths StrengthsOf(const FracturePart& part, const std::optional<RandomGraph>& graph) {
  EdgeStrengths strengths(OneOrEach(part.edge_thresholds));
  if (!part.compressive_thresholds.empty())
    strengths.compressive = OneOrEach(part.compressive_thresholds);
  if (graph) strengths.kappa = Broadcast<double>::PerItem(graph->factors().data());
  return strengths;
}

std::optional<RandomGraph> GraphOf(const Model& model) {
  if (!model.fracture->impurities) return std::nullopt;
  const ImpurityPart& part = *model.fracture->impurities;
  return RandomGraph(*model.incidence, part.settings, part.potencies, part.edge_draws,
                     part.edge_deal);
}

}  // namespace

Breaking::Breaking(const Model& model)
    : model_(model),
      graph_(GraphOf(model)),
      fracture_(*model.mesh, *model.incidence, StrengthsOf(*model.fracture, graph_),
                model.fracture->settings),
      positions_(model.masses.size()),
      stresses_(static_cast<size_t>(model.tet_count())) {
  // Edges without strength are cut before anything moves.
  if (fracture_.broken_edge_count() > 0) {
    ApplyDamage();
    ResetGraph();
  }
  Mark();
}

int64_t Breaking::BreakPass(const NodalVector& displacements) {
  ParallelFor(model_.node_count(), 4096, [&](int64_t begin, int64_t end) {
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      positions_[node] = ToVec3(ToDouble4(model_.mesh->rest_positions[node]) + displacements[node]);
    }
  });
  ParallelFor(model_.tet_count(), 4096, [&](int64_t begin, int64_t end) {
    std::fill(stresses_.begin() + begin, stresses_.begin() + end, Eigen::Matrix3d::Zero());
  });
  for (const auto& term : model_.tet_terms) term->AddEffectiveStress(displacements, stresses_);
  const PassResult result = fracture_.BreakPass(positions_, stresses_);
  for (const ChangedTet& changed : result.changed_tets) {
    for (const auto& term : model_.tet_terms) {
      term->SetDamageFactor(changed.tet,
                            fracture_.damage_factors()[static_cast<size_t>(changed.tet)]);
    }
  }
  if (graph_) fracture_.LowerThresholds(graph_->Break(result.broken_edges));
  return static_cast<int64_t>(result.broken_edges.size());
}

void Breaking::Mark() {
  // Edges never mend: as many broken edges as at the last mark are the same edges.
  if (!mark_.empty() && marked_broken_edges_ == fracture_.broken_edge_count()) return;
  mark_.clear();
  ByteWriter out(mark_);
  fracture_.Save(out);
  marked_broken_edges_ = fracture_.broken_edge_count();
}

absl::Status Breaking::RollBack() {
  if (marked_broken_edges_ == fracture_.broken_edge_count()) return absl::OkStatus();
  ByteReader in(mark_);
  CLEAVE_RETURN_IF_ERROR(fracture_.Restore(in));
  ApplyDamage();
  ResetGraph();
  return absl::OkStatus();
}

absl::Status Breaking::Restore(ByteReader& in) {
  CLEAVE_RETURN_IF_ERROR(fracture_.Restore(in));
  ApplyDamage();
  ResetGraph();
  mark_.clear();
  Mark();
  return absl::OkStatus();
}

void Breaking::ResetGraph() {
  if (!graph_) return;
  graph_->Reset(fracture_.edge_broken());
  std::vector<int32_t> edges(static_cast<size_t>(model_.incidence->edge_count()));
  std::iota(edges.begin(), edges.end(), 0);
  fracture_.LowerThresholds(edges);
}

void Breaking::ApplyDamage() {
  const auto factors = fracture_.damage_factors();
  for (const auto& term : model_.tet_terms) {
    for (size_t tet = 0; tet < factors.size(); ++tet)
      term->SetDamageFactor(static_cast<int64_t>(tet), factors[tet]);
  }
}

std::vector<int32_t> Breaking::ClientBrokenEdges() const {
  std::vector<int32_t> edges = fracture_.BrokenEdges();
  for (int32_t& edge : edges) edge = model_.fracture->client_edge[static_cast<size_t>(edge)];
  std::sort(edges.begin(), edges.end());
  return edges;
}

int64_t Breaking::bytes() const {
  return static_cast<int64_t>(positions_.size() * sizeof(Vec3) +
                              stresses_.size() * sizeof(Eigen::Matrix3d) + mark_.size()) +
         (graph_ ? graph_->bytes() : 0);
}

}  // namespace cleave
