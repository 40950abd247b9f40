#include "core/damage/fracture.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/parallel.h"
#include "core/damage/components.h"

namespace cleave {
namespace {

using Eigen::Vector3d;

constexpr int64_t kBlock = 4096;  // edges or tets, the unit of ordered maxima

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

Vector3d DirectionOf(const Vector3d& edge) {
  const double length = edge.norm();
  return length > 0 ? Vector3d(edge / length) : Vector3d::Zero();
}

void SortUnique(std::vector<int32_t>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

}  // namespace

EdgeFracture::EdgeFracture(const TetMesh& mesh, const Incidence& incidence,
                           Broadcast<double> thresholds, const FractureSettings& settings)
    : mesh_(mesh), incidence_(incidence), thresholds_(thresholds), settings_(settings) {
  const auto tets = static_cast<size_t>(mesh.tet_count());
  const auto edges = static_cast<size_t>(incidence.edge_count());
  rest_volumes_.resize(tets);
  for (size_t tet = 0; tet < tets; ++tet)
    rest_volumes_[tet] = SixVolumes(mesh.tets[tet], mesh.rest_positions) / 6;
  broken_.assign(edges, 0);
  masks_.assign(tets, 0);
  factors_.assign(tets, 1.0);
  upright_.assign(tets, 0);
  ratios_.assign(edges, 0.0);
  min_threshold_ = std::numeric_limits<double>::infinity();
  for (int32_t edge = 0; edge < static_cast<int32_t>(edges); ++edge) {
    const double threshold = thresholds_[edge];
    if (threshold == 0) {
      pending_.push_back(edge);
    } else {
      min_threshold_ = std::min(min_threshold_, threshold);
    }
  }
  BreakPending({}, {});
}

PassResult EdgeFracture::BreakPass(std::span<const Vec3> positions, Stress effective_stress) {
  PassResult result;
  if (min_threshold_ == std::numeric_limits<double>::infinity()) return result;

  // No edge of a tet sees more than the norm of its stress.
  const double stress_bound = WeighTets(positions, effective_stress);
  if (stress_bound < min_threshold_) {
    result.max_ratio = stress_bound / min_threshold_;
    return result;
  }

  const auto edges = static_cast<int64_t>(ratios_.size());
  const int64_t blocks = (edges + kBlock - 1) / kBlock;
  block_max_.resize(static_cast<size_t>(blocks));
  ParallelFor(blocks, 1, [&](int64_t begin, int64_t end) {
    for (int64_t block = begin; block < end; ++block) {
      BlockMax max{0, -1};
      for (int64_t edge = block * kBlock; edge < std::min(edges, (block + 1) * kBlock); ++edge) {
        const double stress = EdgeStress(static_cast<int32_t>(edge), positions, effective_stress);
        const double ratio = stress > 0 ? stress / thresholds_[edge] : 0;
        ratios_[static_cast<size_t>(edge)] = ratio;
        if (ratio > max.value) max = {ratio, static_cast<int32_t>(edge)};
      }
      block_max_[static_cast<size_t>(block)] = max;
    }
  });
  for (const BlockMax& max : block_max_) {
    if (max.value <= result.max_ratio) continue;
    result.max_ratio = max.value;
    result.max_edge = max.item;
  }
  if (!(result.max_ratio >= 1)) return result;

  CollectFailing();
  BreakPending(positions, effective_stress);
  result.broken_edges = new_broken_;
  result.changed_tets = changed_;
  return result;
}

double EdgeFracture::WeighTets(std::span<const Vec3> positions, Stress effective_stress) {
  const auto tets = static_cast<int64_t>(factors_.size());
  const int64_t blocks = (tets + kBlock - 1) / kBlock;
  block_max_.resize(static_cast<size_t>(blocks));
  ParallelFor(blocks, 1, [&](int64_t begin, int64_t end) {
    for (int64_t block = begin; block < end; ++block) {
      double max_squared = 0;
      for (int64_t tet = block * kBlock; tet < std::min(tets, (block + 1) * kBlock); ++tet) {
        const auto t = static_cast<size_t>(tet);
        upright_[t] = factors_[t] > 0 && SixVolumes(mesh_.tets[t], positions) > 0;
        if (upright_[t] != 0)
          max_squared = std::max(max_squared, effective_stress[t].squaredNorm());
      }
      block_max_[static_cast<size_t>(block)] = {max_squared, 0};
    }
  });
  double max_squared = 0;
  for (const BlockMax& max : block_max_) max_squared = std::max(max_squared, max.value);
  return std::sqrt(max_squared);
}

double EdgeFracture::EdgeStress(int32_t edge, std::span<const Vec3> positions,
                                Stress effective_stress) const {
  if (broken_[static_cast<size_t>(edge)] != 0) return 0;
  const auto [a, b] = incidence_.edges[static_cast<size_t>(edge)];
  const Vector3d current = DirectionOf(At(positions, b) - At(positions, a));
  const Vector3d rest = DirectionOf(At(mesh_.rest_positions, b) - At(mesh_.rest_positions, a));
  double weighted = 0;
  double volume = 0;
  double max = 0;
  for (const int32_t tet : incidence_.edge_tets[edge]) {
    const auto t = static_cast<size_t>(tet);
    if (!(factors_[t] > 0)) continue;
    volume += rest_volumes_[t];
    if (upright_[t] == 0) continue;
    const double stress = current.dot(effective_stress[t] * rest);
    weighted += rest_volumes_[t] * stress;
    max = std::max(max, stress);
  }
  if (settings_.aggregation == StressAggregation::kMax) return max;
  return volume > 0 ? weighted / volume : 0;
}

void EdgeFracture::EdgeStresses(std::span<const Vec3> positions, Stress effective_stress,
                                std::span<double> stresses) {
  WeighTets(positions, effective_stress);
  ParallelFor(static_cast<int64_t>(stresses.size()), kBlock, [&](int64_t begin, int64_t end) {
    for (int64_t edge = begin; edge < end; ++edge) {
      stresses[static_cast<size_t>(edge)] =
          EdgeStress(static_cast<int32_t>(edge), positions, effective_stress);
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
  for (const int32_t tet : touched_tets_) {
    const bool separated = Separated(masks_[static_cast<size_t>(tet)]);
    Weaken(tet, separated ? 0 : UnbrokenShare(tet, positions, effective_stress));
  }

  // Deaths make orphans and hinges; hinges make deaths; orphans change no live tet. `newly_dead_`
  // grows while rounds of hinges work through it.
  size_t seen = 0;
  for (;;) {
    for (; seen < newly_dead_.size(); ++seen) {
      BreakOrphans(newly_dead_[seen]);
      const std::array<int32_t, 4>& nodes = mesh_.tets[static_cast<size_t>(newly_dead_[seen])];
      touched_nodes_.insert(touched_nodes_.end(), nodes.begin(), nodes.end());
    }
    if (touched_nodes_.empty()) break;
    SortUnique(touched_nodes_);
    for (const int32_t node : touched_nodes_) KillHinges(node);
    touched_nodes_.clear();
  }
  newly_dead_.clear();

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
  if (current == 0) newly_dead_.push_back(tet);
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
    if (upright_[t] == 0) continue;
    const auto [a, b] = incidence_.edges[static_cast<size_t>(incidence_.tet_edges[t][k])];
    const Vector3d current = DirectionOf(At(positions, b) - At(positions, a));
    const Vector3d rest = DirectionOf(At(mesh_.rest_positions, b) - At(mesh_.rest_positions, a));
    const double stress = std::abs(current.dot(effective_stress[t] * rest));
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

// Kills the live tets of a node that unbroken edges at it do not join to the largest cluster (by
// rest volume; of equal ones, that of the lowest tet).
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
      if (!(factors_[static_cast<size_t>(tet)] > 0)) continue;
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
    if (!(factors_[tet] > 0)) continue;
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
    if (cluster_of_[i] != largest) Weaken(tets[i], 0);
  }
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
