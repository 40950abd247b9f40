#include "core/solver/breaking.h"

#include <algorithm>
#include <array>

#include "core/base/parallel.h"
#include "core/base/status.h"

namespace cleave {
namespace {

Broadcast<double> OneOrEach(const std::vector<double>& values) {
  return values.size() == 1 ? Broadcast<double>::Uniform(values[0])
                            : Broadcast<double>::PerItem(values.data());
}

EdgeStrengths StrengthsOf(const FracturePart& part, const std::optional<RandomGraph>& graph,
                          const std::optional<FatigueDamage>& fatigue) {
  EdgeStrengths strengths(OneOrEach(part.edge_thresholds));
  if (!part.compressive_thresholds.empty())
    strengths.compressive = OneOrEach(part.compressive_thresholds);
  if (fatigue)
    strengths.residual = Broadcast<double>::PerItem(fatigue->residual_strengths().data());
  if (graph) strengths.kappa = Broadcast<double>::PerItem(graph->factors().data());
  return strengths;
}

std::optional<RandomGraph> GraphOf(const Model& model) {
  if (!model.fracture->impurities) return std::nullopt;
  const ImpurityPart& part = *model.fracture->impurities;
  return RandomGraph(*model.incidence, part.settings, part.potencies, part.edge_draws,
                     part.edge_deal);
}

StrandLaws StrandsOf(const FracturePart& part) {
  if (!part.strands) return {};
  return {part.strands->laws, part.strands->tet_laws};
}

std::optional<FatigueDamage> FatigueOf(const Model& model) {
  if (!model.fracture->fatigue) return std::nullopt;
  const FatiguePart& part = *model.fracture->fatigue;
  return FatigueDamage(model.incidence->edge_count(), part.laws, part.edge_laws);
}

}  // namespace

Breaking::Breaking(const Model& model)
    : model_(model),
      graph_(GraphOf(model)),
      fatigue_(FatigueOf(model)),
      fracture_(*model.mesh, *model.incidence, StrengthsOf(*model.fracture, graph_, fatigue_),
                model.fracture->settings, StrandsOf(*model.fracture)),
      positions_(model.masses.size()),
      stresses_(static_cast<size_t>(model.tet_count())),
      edge_stresses_(fatigue_ ? static_cast<size_t>(model.incidence->edge_count()) : 0) {
  if (!model.plastic_terms.empty()) {
    plastic_record_of_.assign(static_cast<size_t>(model.tet_count()), -1);
    int32_t record = 0;
    for (const PlasticTerm* term : model.plastic_terms) {
      for (int64_t place = 0; place < term->tet_count(); ++place)
        plastic_record_of_[static_cast<size_t>(term->tet_at(place))] = record++;
    }
    plastic_tets_.resize(static_cast<size_t>(record));
  }
  // Edges without strength are cut before anything moves.
  if (fracture_.broken_edge_count() > 0) {
    // At rest nothing has energy that could rise.
    ApplyDamage(std::vector<double>(ProjectedTets().size(), 1.0));
    ResetStrengths();
  }
  Mark();
}

void Breaking::FindStresses(const NodalVector& displacements) {
  ParallelFor(model_.node_count(), 4096, [&](int64_t begin, int64_t end) {
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      positions_[node] = ToVec3(ToDouble4(model_.mesh->rest_positions[node]) + displacements[node]);
    }
  });
  ParallelFor(model_.tet_count(), 4096, [&](int64_t begin, int64_t end) {
    for (auto tet = static_cast<size_t>(begin); tet < static_cast<size_t>(end); ++tet) {
      if (left_out_.empty() || left_out_[tet] == 0) stresses_[tet].setZero();
    }
  });
  for (const auto& term : model_.tet_terms) term->AddEffectiveStress(displacements, stresses_);
  size_t record = 0;
  for (const PlasticTerm* term : model_.plastic_terms) {
    const auto count = static_cast<size_t>(term->tet_count());
    term->GetPlasticTets(std::span(plastic_tets_).subspan(record, count));
    record += count;
  }
}

void Breaking::AddStrandInfluences(std::vector<Influence>& influences) const {
  if (!model_.fracture->strands) return;
  for (int32_t tet = 0; tet < model_.tet_count(); ++tet) {
    if (!fracture_.IsStrand(tet)) continue;
    const auto& nodes = model_.mesh->tets[static_cast<size_t>(tet)];
    for (size_t k = 1; k < 4; ++k) influences.push_back({nodes[0], nodes[k]});
  }
}

bool Breaking::BreakPass(const NodalVector& displacements) {
  FindStresses(displacements);
  const PlasticTets plastic = {plastic_record_of_, plastic_tets_};
  const PassResult result =
      fracture_.BreakPass(positions_, stresses_, plastic_tets_.empty() ? nullptr : &plastic);
  newly_broken_ = result.broken_edges;
  break_energies_.assign(newly_broken_.size(), 0);
  double unshared = 0;
  for (const ChangedTet& changed : result.changed_tets) {
    const double before = TetEnergy(changed.tet, displacements);
    Weaken(changed.tet, displacements);
    unshared += ShareOut(changed.tet, before - TetEnergy(changed.tet, displacements));
  }
  for (double& energy : break_energies_)
    energy += unshared / static_cast<double>(newly_broken_.size());
  if (graph_) fracture_.LowerThresholds(graph_->Break(result.broken_edges));
  // A strand may tear whose edges others hold.
  stresses_are_last_ = result.broken_edges.empty() && result.changed_tets.empty();
  return !stresses_are_last_;
}

void Breaking::EndStep(const NodalVector& displacements) {
  if (!fatigue_) return;
  // After the last pass that a step may have, the body was solved for once more.
  if (!stresses_are_last_) FindStresses(displacements);
  const PlasticTets plastic = {plastic_record_of_, plastic_tets_};
  fracture_.EdgeStresses(positions_, stresses_, plastic_tets_.empty() ? nullptr : &plastic,
                         edge_stresses_);
  const EdgeStrengths strengths = StrengthsOf(*model_.fracture, graph_, fatigue_);
  if (fatigue_->Follow(edge_stresses_, strengths.tensile, strengths.compressive, strengths.kappa))
    fracture_.UpdateThresholds();
}

double Breaking::TetEnergy(int32_t tet, const NodalVector& displacements) const {
  double energy = 0;
  for (const auto& term : model_.tet_terms) energy += term->TetEnergy(tet, displacements);
  return energy;
}

double Breaking::ShareOut(int32_t tet, double energy) {
  std::array<size_t, 6> places{};
  size_t count = 0;
  for (const int32_t edge : model_.incidence->tet_edges[static_cast<size_t>(tet)]) {
    const auto found = std::lower_bound(newly_broken_.begin(), newly_broken_.end(), edge);
    if (found != newly_broken_.end() && *found == edge)
      places[count++] = static_cast<size_t>(found - newly_broken_.begin());
  }
  for (size_t i = 0; i < count; ++i)
    break_energies_[places[i]] += energy / static_cast<double>(count);
  return count == 0 ? energy : 0;
}

void Breaking::Weaken(int32_t tet, const NodalVector& displacements) {
  const double factor = fracture_.damage_factors()[static_cast<size_t>(tet)];
  EdgeProjectedTerm* const projected = model_.fracture->edge_projected;
  if (!IsProjected(tet)) {
    for (const auto& term : model_.tet_terms) term->SetDamageFactor(tet, factor);
    return;
  }
  const double energy = TetEnergy(tet, displacements);
  for (const auto& term : model_.tet_terms) {
    if (term.get() != projected) term->SetDamageFactor(tet, 0);
  }
  projected->Weaken(tet, fracture_.tet_masks()[static_cast<size_t>(tet)], RestModuli(tet), factor,
                    energy, displacements);
}

Matrix6 Breaking::RestModuli(int32_t tet) const {
  Matrix6 moduli = Matrix6::Zero();
  for (const auto& term : model_.tet_terms) term->AddRestModuli(tet, moduli);
  return moduli;
}

void Breaking::Mark() {
  // Nothing mends: as much damage as at the last mark is the same damage.
  if (!mark_.empty() && marked_damage_ == fracture_.damage_count()) return;
  mark_.clear();
  ByteWriter out(mark_);
  SaveBroken(out);
  marked_damage_ = fracture_.damage_count();
}

absl::Status Breaking::RollBack() {
  if (marked_damage_ == fracture_.damage_count()) return absl::OkStatus();
  ByteReader in(mark_);
  return LoadBroken(in);
}

void Breaking::Save(ByteWriter& out) const {
  SaveBroken(out);
  if (fatigue_) fatigue_->Save(out);
}

void Breaking::SaveBroken(ByteWriter& out) const {
  fracture_.Save(out);
  if (model_.fracture->edge_projected != nullptr)
    out.PutVector(model_.fracture->edge_projected->betas());
}

absl::Status Breaking::Restore(ByteReader& in) {
  std::string before;
  ByteWriter out(before);
  Save(out);
  absl::Status status = LoadBroken(in);
  if (status.ok() && fatigue_) status = fatigue_->Restore(in);
  if (!status.ok()) {
    ByteReader again(before);
    CLEAVE_RETURN_IF_ERROR(LoadBroken(again));
    return status;
  }
  if (fatigue_) fracture_.UpdateThresholds();
  mark_.clear();
  Mark();
  return absl::OkStatus();
}

absl::Status Breaking::LoadBroken(ByteReader& in) {
  CLEAVE_RETURN_IF_ERROR(fracture_.Restore(in));
  std::vector<double> betas;
  if (model_.fracture->edge_projected != nullptr) {
    betas = in.GetVector<double>();
    const bool in_range =
        std::all_of(betas.begin(), betas.end(), [](double beta) { return beta >= 0 && beta <= 1; });
    if (!in.ok() || !in_range || betas.size() != ProjectedTets().size())
      return absl::DataLossError("fracture state: what is left of tets contradicts their edges");
  }
  ApplyDamage(betas);
  ResetStrengths();
  return absl::OkStatus();
}

void Breaking::ResetStrengths() {
  if (graph_) graph_->Reset(fracture_.edge_broken());
  fracture_.UpdateThresholds();
}

bool Breaking::IsProjected(int32_t tet) const {
  const FracturePart& part = *model_.fracture;
  if (part.edge_projected == nullptr) return false;
  const auto t = static_cast<size_t>(tet);
  if (!(fracture_.damage_factors()[t] > 0)) return false;
  const bool is_damaged =
      part.settings.reformulation == Reformulation::kEdgeProjected && fracture_.tet_masks()[t] != 0;
  return is_damaged || fracture_.IsStrand(tet);
}

std::vector<int32_t> Breaking::ProjectedTets() const {
  std::vector<int32_t> tets;
  if (model_.fracture->edge_projected == nullptr) return tets;
  for (int32_t tet = 0; tet < static_cast<int32_t>(model_.tet_count()); ++tet) {
    if (IsProjected(tet)) tets.push_back(tet);
  }
  return tets;
}

std::span<const double> Breaking::SolidFactors() {
  const std::span<const double> factors = fracture_.damage_factors();
  if (!model_.fracture->strands) return factors;
  solid_factors_.assign(factors.begin(), factors.end());
  for (int32_t tet = 0; tet < static_cast<int32_t>(model_.tet_count()); ++tet) {
    if (fracture_.IsStrand(tet)) solid_factors_[static_cast<size_t>(tet)] = 0;
  }
  return solid_factors_;
}

void Breaking::ApplyDamage(std::span<const double> betas) {
  const auto factors = fracture_.damage_factors();
  for (const auto& term : model_.tet_terms) {
    for (size_t tet = 0; tet < factors.size(); ++tet)
      term->SetDamageFactor(static_cast<int64_t>(tet), factors[tet]);
  }
  EdgeProjectedTerm* const projected = model_.fracture->edge_projected;
  if (projected == nullptr) return;
  projected->Clear();
  const std::vector<int32_t> tets = ProjectedTets();
  for (size_t k = 0; k < tets.size(); ++k) {
    const auto tet = static_cast<size_t>(tets[k]);
    for (const auto& term : model_.tet_terms) term->SetDamageFactor(tets[k], 0);
    projected->Put(tets[k], fracture_.tet_masks()[tet], RestModuli(tets[k]), betas[k]);
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
                              stresses_.size() * sizeof(Eigen::Matrix3d) +
                              edge_stresses_.size() * sizeof(double) +
                              plastic_record_of_.size() * sizeof(int32_t) +
                              plastic_tets_.size() * sizeof(PlasticTet) + mark_.size() +
                              solid_factors_.size() * sizeof(double)) +
         (graph_ ? graph_->bytes() : 0) + (fatigue_ ? fatigue_->bytes() : 0);
}

}  // namespace cleave
