#include "core/damage/fracture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/damage/components.h"
#include "core/damage/edge_stress.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

constexpr int64_t kBlock = 4096;  // edges or tets, the unit of ordered maxima
// What rounding may add to the square of an edge's stress over that of its tets.
constexpr double kRoundedUp = 1 + 1e-12;

Vector3d At(std::span<const Vec3> positions, int32_t node) {
  return Vector3d(positions[static_cast<size_t>(node)].data());
}

// Six times the signed volume of a tet.
double SixVolumes(const std::array<int32_t, 4>& nodes, std::span<const Vec3> positions) {
  const Vector3d origin = At(positions, nodes[0]);
  const Vector3d a = At(positions, nodes[1]) - origin;
  const Vector3d b = At(positions, nodes[2]) - origin;
  return a.cross(b).dot(At(positions, nodes[3]) - origin);
}

}  // namespace

EdgeFracture::EdgeFracture(const TetMesh& mesh, const Incidence& incidence,
                           const EdgeStrengths& strengths, const FractureSettings& settings,
                           const StrandLaws& strands)
    : mesh_(mesh), incidence_(incidence), strengths_(strengths), settings_(settings) {
  const auto tets = static_cast<size_t>(mesh.tet_count());
  const auto edges = static_cast<size_t>(incidence.edge_count());
  rest_volumes_.resize(tets);
  for (size_t tet = 0; tet < tets; ++tet)
    rest_volumes_[tet] = SixVolumes(mesh.tets[tet], mesh.rest_positions) / 6;
  broken_.assign(edges, 0);
  masks_.assign(tets, 0);
  factors_.assign(tets, 1.0);
  loads_.assign(tets, kNone);
  squared_bounds_.assign(tets, 0.0);
  ratios_.assign(edges, 0.0);
  min_threshold_ = kUnbreakable;
  for (int32_t edge = 0; edge < static_cast<int32_t>(edges); ++edge) {
    if (strengths_.tensile[edge] == 0) {
      pending_.push_back(edge);
    } else {
      LowerBounds(edge);
    }
  }
  BreakPending({}, {});
  strands_ = strands;
}

void EdgeFracture::LowerThresholds(std::span<const int32_t> edges) {
  for (const int32_t edge : edges) {
    if (broken_[static_cast<size_t>(edge)] == 0) LowerBounds(edge);
  }
}

void EdgeFracture::UpdateThresholds() {
  min_threshold_ = kUnbreakable;
  min_kappa_ = kFullStrength;
  for (size_t edge = 0; edge < broken_.size(); ++edge) {
    if (broken_[edge] == 0) LowerBounds(static_cast<int32_t>(edge));
  }
}

void EdgeFracture::LowerBounds(int32_t edge) {
  min_threshold_ = std::min(min_threshold_, Weakest(edge));
  min_kappa_ = std::min(min_kappa_, strengths_.kappa[edge]);
}

double EdgeFracture::Weakest(int32_t edge) const {
  const double left = strengths_.kappa[edge] * strengths_.residual[edge];
  return left == 0 ? 0 : left * std::min(strengths_.tensile[edge], strengths_.compressive[edge]);
}

PassResult EdgeFracture::BreakPass(std::span<const Vec3> positions, Stress effective_stress,
                                   const PlasticTets* plastic) {
  PassResult result;
  plastic_ = plastic;
  FindFailing(positions, effective_stress, result);
  if (!strands_.empty()) FindTorn(positions);
  if (pending_.empty() && torn_.empty()) return result;

  BreakPending(positions, effective_stress);
  result.broken_edges = new_broken_;
  result.changed_tets = changed_;
  return result;
}

void EdgeFracture::FindFailing(std::span<const Vec3> positions, Stress effective_stress,
                               PassResult& result) {
  if (min_threshold_ == kUnbreakable) return;

  // No edge of a tet sees more than the norm of its stress.
  const double stress_bound = WeighTets(positions, effective_stress);
  const double exhaustion_bound = plastic_ != nullptr ? WeighStrains() : 0;
  if (stress_bound < min_threshold_ && exhaustion_bound < min_kappa_) {
    result.max_ratio = std::max(stress_bound / min_threshold_, exhaustion_bound / min_kappa_);
    return;
  }
  if (plastic_ != nullptr) {
    SetRatios<true>(positions, effective_stress);
  } else {
    SetRatios<false>(positions, effective_stress);
  }
  for (const BlockMax& max : block_max_) {
    if (max.value <= result.max_ratio) continue;
    result.max_ratio = max.value;
    result.max_edge = max.item;
  }
  if (result.max_ratio >= 1) CollectFailing();
}

template <bool kPlastic>
void EdgeFracture::SetRatios(std::span<const Vec3> positions, Stress effective_stress) {
  const auto edges = static_cast<int64_t>(ratios_.size());
  const int64_t blocks = (edges + kBlock - 1) / kBlock;
  block_max_.resize(static_cast<size_t>(blocks));
  ParallelFor(blocks, 1, [&](int64_t begin, int64_t end) {
    for (int64_t block = begin; block < end; ++block) {
      BlockMax max{0, -1};
      for (int64_t edge = block * kBlock; edge < std::min(edges, (block + 1) * kBlock); ++edge) {
        const double ratio =
            RatioOf<kPlastic>(static_cast<int32_t>(edge), positions, effective_stress);
        ratios_[static_cast<size_t>(edge)] = ratio;
        if (ratio > max.value) max = {ratio, static_cast<int32_t>(edge)};
      }
      block_max_[static_cast<size_t>(block)] = max;
    }
  });
}

double EdgeFracture::WeighStrains() {
  double largest = 0;
  for (size_t tet = 0; tet < factors_.size(); ++tet) {
    const int32_t record = plastic_->record_of[tet];
    if (record < 0 || !(factors_[tet] > 0)) continue;
    const double exhaustion = plastic_->tets[static_cast<size_t>(record)].exhaustion;
    if (exhaustion >= min_kappa_ && loads_[tet] == kUpright) loads_[tet] = kHot;
    largest = std::max(largest, exhaustion);
  }
  return largest;
}

double EdgeFracture::WeighTets(std::span<const Vec3> positions, Stress effective_stress) {
  const auto tets = static_cast<int64_t>(factors_.size());
  const int64_t blocks = (tets + kBlock - 1) / kBlock;
  block_max_.resize(static_cast<size_t>(blocks));
  const double hot_squared = min_threshold_ * min_threshold_;
  ParallelFor(blocks, 1, [&](int64_t begin, int64_t end) {
    for (int64_t block = begin; block < end; ++block) {
      double max_squared = 0;
      for (int64_t tet = block * kBlock; tet < std::min(tets, (block + 1) * kBlock); ++tet) {
        const auto t = static_cast<size_t>(tet);
        if (loads_[t] == kOut) continue;
        loads_[t] = kNone;
        if (!(SixVolumes(mesh_.tets[t], positions) > 0)) continue;
        const double squared = effective_stress[t].squaredNorm();
        loads_[t] = squared >= hot_squared ? kHot : kUpright;
        squared_bounds_[t] = squared * kRoundedUp;
        max_squared = std::max(max_squared, squared);
      }
      block_max_[static_cast<size_t>(block)] = {max_squared, 0};
    }
  });
  double max_squared = 0;
  for (const BlockMax& max : block_max_) max_squared = std::max(max_squared, max.value);
  return std::sqrt(max_squared);
}

template <bool kPlastic>
double EdgeFracture::Project(const EdgeDirections& directions, size_t tet,
                             Stress effective_stress) const {
  if constexpr (kPlastic) {
    const int32_t record = plastic_->record_of[tet];
    if (record >= 0)
      return directions.Project(effective_stress[tet],
                                plastic_->tets[static_cast<size_t>(record)].deformation);
  }
  return directions.Project(effective_stress[tet]);
}

template double EdgeFracture::Project<true>(const EdgeDirections&, size_t, Stress) const;
template double EdgeFracture::Project<false>(const EdgeDirections&, size_t, Stress) const;

template <bool kPlastic>
EdgeFracture::EdgeLoad EdgeFracture::LoadOf(int32_t edge, std::span<const Vec3> positions,
                                            Stress effective_stress) const {
  const EdgeDirections directions(incidence_.edges[static_cast<size_t>(edge)], positions,
                                  mesh_.rest_positions);
  double weighted = 0;
  double volume = 0;
  double max = -kUnbreakable;
  double min = kUnbreakable;
  double weighted_exhaustion = 0;
  double max_exhaustion = 0;
  for (const int32_t tet : incidence_.edge_tets[edge]) {
    const auto t = static_cast<size_t>(tet);
    if (loads_[t] == kOut) {
      if (factors_[t] > 0) return {0, 0};  // a strand holds it
      continue;
    }
    volume += rest_volumes_[t];
    const double stress =
        loads_[t] == kNone ? 0 : Project<kPlastic>(directions, t, effective_stress);
    weighted += rest_volumes_[t] * stress;
    max = std::max(max, stress);
    min = std::min(min, stress);
    if constexpr (kPlastic) {
      const int32_t record = plastic_->record_of[t];
      if (record < 0) continue;
      const double exhaustion = plastic_->tets[static_cast<size_t>(record)].exhaustion;
      weighted_exhaustion += rest_volumes_[t] * exhaustion;
      max_exhaustion = std::max(max_exhaustion, exhaustion);
    }
  }
  if (!(volume > 0)) return {0, 0};
  if (settings_.aggregation == StressAggregation::kMax) return {max, -min, max_exhaustion};
  return {weighted / volume, -weighted / volume, weighted_exhaustion / volume};
}

template <bool kPlastic>
double EdgeFracture::RatioOf(int32_t edge, std::span<const Vec3> positions,
                             Stress effective_stress) const {
  if (broken_[static_cast<size_t>(edge)] != 0) return 0;
  const double left = strengths_.kappa[edge] * strengths_.residual[edge];
  if (left == 0) return kUnbreakable;  // its life is over: the worst ratio there is
  // Neither the mean nor the largest exceeds every tet's. Strengths may differ widely, as along and
  // across fibres: most edges are far from their own while some are near.
  const double weakest = Weakest(edge);
  const std::span<const int32_t> tets = incidence_.edge_tets[edge];
  const bool may_fail = std::any_of(tets.begin(), tets.end(), [&](int32_t tet) {
    const auto t = static_cast<size_t>(tet);
    return loads_[t] == kHot && (kPlastic || squared_bounds_[t] >= weakest * weakest);
  });
  if (!may_fail) return 0;
  const EdgeLoad load = LoadOf<kPlastic>(edge, positions, effective_stress);
  double ratio = 0;
  if (load.tension > 0) ratio = load.tension / (strengths_.tensile[edge] * left);
  if (load.compression > 0)
    ratio = std::max(ratio, load.compression / (strengths_.compressive[edge] * left));
  if constexpr (kPlastic) {
    if (strengths_.tensile[edge] < kUnbreakable)
      ratio = std::max(ratio, load.exhaustion / strengths_.kappa[edge]);
  }
  return ratio;
}

void EdgeFracture::EdgeStresses(std::span<const Vec3> positions, Stress effective_stress,
                                const PlasticTets* plastic, std::span<double> stresses) {
  plastic_ = plastic;
  WeighTets(positions, effective_stress);
  ParallelFor(static_cast<int64_t>(stresses.size()), kBlock, [&](int64_t begin, int64_t end) {
    for (int64_t edge = begin; edge < end; ++edge) {
      const bool broken = broken_[static_cast<size_t>(edge)] != 0;
      if (broken) {
        stresses[static_cast<size_t>(edge)] = 0;
        continue;
      }
      const auto e = static_cast<int32_t>(edge);
      const EdgeLoad load = plastic_ != nullptr ? LoadOf<true>(e, positions, effective_stress)
                                                : LoadOf<false>(e, positions, effective_stress);
      const bool pressed = load.compression / strengths_.compressive[edge] >
                           std::max(load.tension, 0.0) / strengths_.tensile[edge];
      stresses[static_cast<size_t>(edge)] = pressed ? -load.compression : load.tension;
    }
  });
}

// Fills `pending_` from `ratios_`, of which some is at least 1.
void EdgeFracture::CollectFailing() {
  UpdateComponents();
  const auto component_of = [&](int32_t edge) {
    const int32_t node = incidence_.edges[static_cast<size_t>(edge)][0];
    return static_cast<size_t>(components_[static_cast<size_t>(node)]);
  };
  component_max_.assign(static_cast<size_t>(component_count_), 0.0);
  pending_.clear();
  for (size_t block = 0; block < block_max_.size(); ++block) {
    if (!(block_max_[block].value >= 1)) continue;
    const size_t end = std::min(ratios_.size(), (block + 1) * static_cast<size_t>(kBlock));
    for (size_t edge = block * static_cast<size_t>(kBlock); edge < end; ++edge) {
      if (!(ratios_[edge] >= 1)) continue;
      pending_.push_back(static_cast<int32_t>(edge));
      double& max = component_max_[component_of(static_cast<int32_t>(edge))];
      max = std::max(max, ratios_[edge]);
    }
  }
  std::erase_if(pending_, [&](int32_t edge) {
    return ratios_[static_cast<size_t>(edge)] <
           settings_.simultaneity * component_max_[component_of(edge)];
  });
}

void EdgeFracture::UpdateComponents() {
  if (components_fresh_) return;
  component_count_ = LabelComponents(incidence_, broken_, components_);
  components_fresh_ = true;
}

int32_t EdgeFracture::ComponentCount() {
  UpdateComponents();
  return component_count_;
}

}  // namespace cleave
