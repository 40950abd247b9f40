#include "core/damage/fatigue.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/parallel.h"

namespace cleave {

double FatigueLaw::HalfCycle(double low, double high) const {
  if (!(high > 0)) return 0;
  const double amplitude = std::sqrt(high * 0.5 * (high - low));
  return amplitude > endurance ? std::pow(amplitude / coefficient, power) : 0;
}

double FatigueLaw::ResidualStrength(double damage, double peak) const {
  if (!(damage < 1)) return 0;
  return 1 - std::max(1 - peak, 0.0) * std::pow(damage, degradation);
}

FatigueDamage::FatigueDamage(int64_t edge_count, std::span<const FatigueLaw> laws,
                             std::span<const int16_t> edge_laws)
    : laws_(laws),
      edge_laws_(edge_laws),
      edges_(static_cast<size_t>(edge_count)),
      residual_strengths_(static_cast<size_t>(edge_count), 1.0) {}

bool FatigueDamage::Follow(std::span<const double> stresses, Broadcast<double> tensile,
                           Broadcast<double> compressive, Broadcast<double> kappa) {
  std::atomic<bool> fell = false;
  ParallelFor(static_cast<int64_t>(edges_.size()), 2048, [&](int64_t begin, int64_t end) {
    for (int64_t e = begin; e < end; ++e) {
      const auto index = static_cast<size_t>(e);
      const int16_t which = edge_laws_.empty() ? int16_t{0} : edge_laws_[index];
      if (which < 0) continue;
      const FatigueLaw& law = laws_[static_cast<size_t>(which)];
      const double strength = tensile[e] * kappa[e];
      const double crushing = compressive[e] * kappa[e];
      Edge& edge = edges_[index];
      const double before = edge.damage;
      edge.cycles.Follow(stresses[index], [&](int half_cycles, double low, double high) {
        const double pulled = law.HalfCycle(low / strength, high / strength);
        const double pressed = law.HalfCycle(-high / crushing, -low / crushing);
        const double share = std::max(pulled, pressed);
        if (!(share > 0)) return;
        edge.damage += half_cycles * share;
        edge.peak = std::max(edge.peak, pulled >= pressed ? high / strength : -low / crushing);
      });
      if (edge.damage == before) continue;
      const double left = law.ResidualStrength(edge.damage, edge.peak);
      if (!(left < residual_strengths_[index])) continue;
      residual_strengths_[index] = left;
      fell = true;
    }
  });
  return fell;
}

void FatigueDamage::Save(ByteWriter& out) const {
  out.PutVector(edges_);
  out.PutVector(residual_strengths_);
}

absl::Status FatigueDamage::Restore(ByteReader& in) {
  std::vector<Edge> edges = in.GetVector<Edge>();
  std::vector<double> residual_strengths = in.GetVector<double>();
  if (!in.ok() || edges.size() != edges_.size() ||
      residual_strengths.size() != residual_strengths_.size())
    return absl::DataLossError("fatigue state: it is not one of this many edges");
  for (size_t edge = 0; edge < edges.size(); ++edge) {
    if (!edges[edge].cycles.IsValid() || !(edges[edge].damage >= 0) || !(edges[edge].peak >= 0) ||
        !(residual_strengths[edge] >= 0 && residual_strengths[edge] <= 1))
      return absl::DataLossError(absl::StrCat("fatigue state: edge ", edge, " cannot be so"));
  }
  // In place: others point to the strengths.
  edges_ = std::move(edges);
  std::copy(residual_strengths.begin(), residual_strengths.end(), residual_strengths_.begin());
  return absl::OkStatus();
}

int64_t FatigueDamage::BytesOf(int64_t edge_count) {
  return edge_count * static_cast<int64_t>(sizeof(Edge) + sizeof(double));
}

}  // namespace cleave
