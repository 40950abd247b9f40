// What follows from broken edges: weakened tets, separation, orphans and hinges.

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/damage/edge_stress.h"
#include "core/damage/fracture.h"

namespace cleave {
namespace {

double EdgeLength(const std::array<int32_t, 2>& nodes, std::span<const Vec3> positions) {
  const Vec3& a = positions[static_cast<size_t>(nodes[0])];
  const Vec3& b = positions[static_cast<size_t>(nodes[1])];
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

void SortUnique(std::vector<int32_t>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

}  // namespace

void EdgeFracture::BreakPending(std::span<const Vec3> positions, Stress effective_stress) {
  new_broken_.clear();
  changed_.clear();
  touched_tets_.clear();
  touched_nodes_.clear();
  for (const int32_t edge : pending_) {
    MarkBroken(edge);
    const std::span<const int32_t> tets = incidence_.edge_tets[edge];
    touched_tets_.insert(touched_tets_.end(), tets.begin(), tets.end());
    const std::array<int32_t, 2>& nodes = incidence_.edges[static_cast<size_t>(edge)];
    touched_nodes_.insert(touched_nodes_.end(), nodes.begin(), nodes.end());
  }
  pending_.clear();
  SortUnique(touched_tets_);
  for (const int32_t tet : torn_) Weaken(tet, 0);
  torn_.clear();
  for (const int32_t tet : touched_tets_) {
    const auto t = static_cast<size_t>(tet);
    if (Separated(masks_[t]) || IsStrand(tet)) {
      LeaveSolid(tet);
    } else if (settings_.reformulation == Reformulation::kUniform) {
      const double share = UnbrokenShare(tet, positions, effective_stress);
      const StrandLaw* const strand = strands_.Of(tet);
      Weaken(tet, strand != nullptr ? std::max(share, strand->residual_factor) : share);
    } else if (factors_[t] > 0) {
      changed_.push_back({tet, factors_[t]});
    }
  }

  // What leaves the solid makes hinges, and orphans where it dies; hinges make more leave; orphans
  // change no live tet. `newly_out_` grows while rounds of hinges work through it.
  size_t seen = 0;
  for (;;) {
    for (; seen < newly_out_.size(); ++seen) {
      BreakOrphans(newly_out_[seen]);
      const std::array<int32_t, 4>& nodes = mesh_.tets[static_cast<size_t>(newly_out_[seen])];
      touched_nodes_.insert(touched_nodes_.end(), nodes.begin(), nodes.end());
    }
    if (touched_nodes_.empty()) break;
    SortUnique(touched_nodes_);
    for (const int32_t node : touched_nodes_) KillHinges(node);
    touched_nodes_.clear();
  }
  newly_out_.clear();

  if (!new_broken_.empty()) components_fresh_ = false;
  std::sort(new_broken_.begin(), new_broken_.end());
  // A tet that fell more than once counts with the factor that it had first, its largest.
  std::sort(changed_.begin(), changed_.end(), [](const ChangedTet& a, const ChangedTet& b) {
    return a.tet != b.tet ? a.tet < b.tet : a.previous_factor > b.previous_factor;
  });
  const auto same_tet = [](const ChangedTet& a, const ChangedTet& b) { return a.tet == b.tet; };
  changed_.erase(std::unique(changed_.begin(), changed_.end(), same_tet), changed_.end());
}

void EdgeFracture::MarkBroken(int32_t edge) {
  broken_[static_cast<size_t>(edge)] = 1;
  ++broken_count_;
  new_broken_.push_back(edge);
  for (const int32_t tet : incidence_.edge_tets[edge]) {
    const std::array<int32_t, 6>& edges = incidence_.tet_edges[static_cast<size_t>(tet)];
    const auto k =
        static_cast<unsigned>(std::find(edges.begin(), edges.end(), edge) - edges.begin());
    masks_[static_cast<size_t>(tet)] |= static_cast<EdgeMask>(1u << k);
  }
}

void EdgeFracture::Weaken(int32_t tet, double factor) {
  double& current = factors_[static_cast<size_t>(tet)];
  if (factor >= current) return;
  changed_.push_back({tet, current});
  current = factor < kDeadFactor ? 0 : factor;
  if (current > 0) return;
  loads_[static_cast<size_t>(tet)] = kOut;
  ++dead_count_;
  newly_out_.push_back(tet);
}

void EdgeFracture::LeaveSolid(int32_t tet) {
  const auto t = static_cast<size_t>(tet);
  const StrandLaw* const strand = strands_.Of(tet);
  if (strand == nullptr || masks_[t] == kAllEdges) {
    Weaken(tet, 0);
    return;
  }
  if (!(factors_[t] > 0)) return;
  changed_.push_back({tet, factors_[t]});
  factors_[t] = std::min(factors_[t], strand->residual_factor);
  if (loads_[t] == kOut) return;
  loads_[t] = kOut;
  newly_out_.push_back(tet);
}

void EdgeFracture::FindTorn(std::span<const Vec3> positions) {
  for (int32_t tet = 0; tet < static_cast<int32_t>(factors_.size()); ++tet) {
    if (!IsStrand(tet)) continue;
    const auto t = static_cast<size_t>(tet);
    const double limit = strands_.Of(tet)->stretch_limit;
    for (size_t k = 0; k < 6; ++k) {
      if ((masks_[t] >> k & 1) != 0) continue;
      const auto& nodes = incidence_.edges[static_cast<size_t>(incidence_.tet_edges[t][k])];
      if (!(EdgeLength(nodes, positions) > limit * EdgeLength(nodes, mesh_.rest_positions)))
        continue;
      torn_.push_back(tet);
      break;
    }
  }
}

// Eq. 2 as the method note reads it: the share of the absolute edge stresses that unbroken edges
// carry; the share of edges where there is no stress, or none to be trusted (J <= 0).
double EdgeFracture::UnbrokenShare(int32_t tet, std::span<const Vec3> positions,
                                   Stress effective_stress) const {
  const auto t = static_cast<size_t>(tet);
  double all = 0;
  double unbroken = 0;
  int unbroken_edges = 0;
  for (size_t k = 0; k < 6; ++k) {
    const bool is_unbroken = (masks_[t] >> k & 1) == 0;
    unbroken_edges += is_unbroken ? 1 : 0;
    if (loads_[t] <= kNone) continue;
    const auto edge = static_cast<size_t>(incidence_.tet_edges[t][k]);
    const EdgeDirections directions(incidence_.edges[edge], positions, mesh_.rest_positions);
    const double stress =
        std::abs(plastic_ != nullptr ? Project<true>(directions, t, effective_stress)
                                     : Project<false>(directions, t, effective_stress));
    all += stress;
    if (is_unbroken) unbroken += stress;
  }
  return all > 0 ? unbroken / all : unbroken_edges / 6.0;
}

// Breaks the edges of a dead tet that no live tet is left at.
void EdgeFracture::BreakOrphans(int32_t tet) {
  for (const int32_t edge : incidence_.tet_edges[static_cast<size_t>(tet)]) {
    if (broken_[static_cast<size_t>(edge)] != 0) continue;
    const std::span<const int32_t> tets = incidence_.edge_tets[edge];
    const bool orphan = std::none_of(tets.begin(), tets.end(), [&](int32_t other) {
      return factors_[static_cast<size_t>(other)] > 0;
    });
    if (orphan) MarkBroken(edge);
  }
}

// Takes out the solid tets of a node that unbroken edges at it do not join to the largest cluster
// (by rest volume; of equal ones, that of the lowest tet).
void EdgeFracture::KillHinges(int32_t node) {
  const std::span<const int32_t> tets = incidence_.node_tets[node];
  // Union-find over positions in `tets`, the smallest position of a cluster at its root.
  cluster_of_.resize(tets.size());
  std::iota(cluster_of_.begin(), cluster_of_.end(), 0);
  const auto root_of = [&](int32_t i) {
    while (cluster_of_[static_cast<size_t>(i)] != i) i = cluster_of_[static_cast<size_t>(i)];
    return i;
  };
  for (const int32_t edge : incidence_.node_edges[node]) {
    if (broken_[static_cast<size_t>(edge)] != 0) continue;
    int32_t first = -1;
    for (const int32_t tet : incidence_.edge_tets[edge]) {
      if (loads_[static_cast<size_t>(tet)] == kOut) continue;
      const auto position = std::lower_bound(tets.begin(), tets.end(), tet) - tets.begin();
      const int32_t root = root_of(static_cast<int32_t>(position));
      if (first < 0) {
        first = root;
      } else if (root != first) {
        cluster_of_[static_cast<size_t>(std::max(first, root))] = std::min(first, root);
        first = std::min(first, root);
      }
    }
  }
  cluster_volume_.assign(tets.size(), 0.0);
  int32_t largest = -1;
  int clusters = 0;
  for (size_t i = 0; i < tets.size(); ++i) {
    const auto tet = static_cast<size_t>(tets[i]);
    if (loads_[tet] == kOut) continue;
    const int32_t root = root_of(static_cast<int32_t>(i));
    clusters += root == static_cast<int32_t>(i) ? 1 : 0;
    cluster_of_[i] = root;
    cluster_volume_[static_cast<size_t>(root)] += rest_volumes_[tet];
  }
  if (clusters < 2) return;
  for (size_t i = 0; i < tets.size(); ++i) {
    if (largest < 0 || cluster_volume_[i] > cluster_volume_[static_cast<size_t>(largest)])
      largest = static_cast<int32_t>(i);
  }
  for (size_t i = 0; i < tets.size(); ++i) {
    if (cluster_of_[i] != largest && loads_[static_cast<size_t>(tets[i])] != kOut)
      LeaveSolid(tets[i]);
  }
}

}  // namespace cleave
