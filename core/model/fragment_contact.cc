#include "core/model/fragment_contact.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/contact/friction_spring.h"
#include "core/damage/components.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

// Pieces that fly faster than this many edges in a step are not looked for further ahead.
constexpr double kFurthestSight = 2;  // mean edges
constexpr double kPositionRounding = 2e-16;

Eigen::Vector3d ToEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }
Eigen::Vector3d ToEigen(Double4 v) { return {v[0], v[1], v[2]}; }
Double4 ToLanes(const Eigen::Vector3d& v) { return Double4{v[0], v[1], v[2], 0}; }

Eigen::Vector3d Across(const Eigen::Vector3d& v, const Eigen::Vector3d& normal) {
  return v - normal * normal.dot(v);
}

}  // namespace

FragmentContact::FragmentContact(const Contact& contact, std::vector<double> stiffness,
                                 const Model& model)
    : mesh_(*model.mesh),
      incidence_(*model.incidence),
      mean_edge_length_(model.mean_edge_length),
      factor_(contact.stiffness),
      friction_(contact.friction),
      node_stiffness_(std::move(stiffness)) {
  UpdatePieces();
}

FragmentContact::Vector FragmentContact::PointOf(int32_t node,
                                                 const NodalVector& displacements) const {
  const auto n = static_cast<size_t>(node);
  return ToEigen(mesh_.rest_positions[n]) + ToEigen(displacements[n]);
}

double FragmentContact::NodeStiffness(int32_t node) const {
  return node_stiffness_[node_stiffness_.size() == 1 ? 0 : static_cast<size_t>(node)];
}

double FragmentContact::RestLength(int32_t i, int32_t j) const {
  return (ToEigen(mesh_.rest_positions[static_cast<size_t>(i)]) -
          ToEigen(mesh_.rest_positions[static_cast<size_t>(j)]))
      .norm();
}

double FragmentContact::FullLength(int32_t i, int32_t j) const {
  return std::min(RestLength(i, j), mean_edge_length_);
}

FragmentContact::Spring FragmentContact::SpringOf(int32_t edge, double length) const {
  const auto [i, j] = incidence_.edges[static_cast<size_t>(edge)];
  const double length_squared = RestLength(i, j) * RestLength(i, j);
  // Each tet gives a sixth of its volume to each of its edges.
  double volume = 0;
  for (const int32_t tet : incidence_.edge_tets[edge])
    volume += SignedVolume(CornersOf(mesh_, tet)) / 6;
  const double modulus = 0.5 * (NodeStiffness(i) + NodeStiffness(j)) / mean_edge_length_;
  return {edge, length, factor_ * modulus * volume / length_squared};
}

void FragmentContact::UpdatePieces() {
  std::vector<uint8_t> broken(incidence_.edges.size(), 0);
  for (const Spring& spring : springs_) broken[static_cast<size_t>(spring.edge)] = 1;
  piece_count_ = LabelComponents(incidence_, broken, pieces_);
  searched_reach_ = 0;
}

void FragmentContact::StartBroken(std::span<const int32_t> edges) {
  for (const int32_t edge : edges) {
    const auto [i, j] = incidence_.edges[static_cast<size_t>(edge)];
    springs_.push_back(SpringOf(edge, RestLength(i, j)));
  }
  old_springs_ = springs_.size();
  UpdatePieces();
}

void FragmentContact::EdgesBroke(std::span<const int32_t> edges, const NodalVector& displacements) {
  for (const int32_t edge : edges) {
    const auto [i, j] = incidence_.edges[static_cast<size_t>(edge)];
    const double now = (PointOf(i, displacements) - PointOf(j, displacements)).norm();
    springs_.push_back(SpringOf(edge, std::min(RestLength(i, j), now)));
  }
}

double FragmentContact::Reach(double dt, const State& state) const {
  Double4 sum = Splat(0);
  const auto count = mesh_.rest_positions.size();
  for (size_t n = 0; n < count; ++n) sum += state.velocities[n];
  const Double4 mean = sum / static_cast<double>(count);
  double fastest = 0;
  for (size_t n = 0; n < count; ++n) {
    const Double4 relative = state.velocities[n] - mean;
    fastest = std::max(fastest, Dot(relative, relative));
  }
  return mean_edge_length_ +
         std::min(2 * dt * std::sqrt(fastest), kFurthestSight * mean_edge_length_);
}

double FragmentContact::LongestPart(double start, double end, const State& state) const {
  const double dt = end - start;
  double longest = dt;
  // Pairs of the last step: what was in sight then may touch now.
  for (const Pair& pair : pairs_) {
    const Vector apart =
        PointOf(pair.first, state.displacements) - PointOf(pair.second, state.displacements);
    const double distance = apart.norm();
    if (distance == 0) continue;
    const double closing = -apart.dot(ToEigen(state.velocities[static_cast<size_t>(pair.first)] -
                                              state.velocities[static_cast<size_t>(pair.second)])) /
                           distance;
    const double furthest = 0.5 * mean_edge_length_;
    if (closing * dt > furthest && distance - pair.length < closing * dt)
      longest = std::min(longest, furthest / closing);
  }
  return longest;
}

void FragmentContact::BeginStep(double start, double end, const State& state) {
  springs_.resize(old_springs_);
  sighted_.clear();
  active_.clear();
  if (piece_count_ < 2 && springs_.empty()) return;
  start_displacements_ = state.displacements;
  if (piece_count_ < 2) return;
  bool moved = points_.empty();
  points_.resize(mesh_.rest_positions.size());
  for (size_t n = 0; n < points_.size(); ++n) {
    const Vector point = PointOf(static_cast<int32_t>(n), state.displacements);
    moved = moved || point != points_[n];
    points_[n] = point;
  }
  // Where all rests, the last search found what this one would.
  const double reach = Reach(end - start, state);
  if (moved || reach != searched_reach_) near_.Find(points_, pieces_, reach);
  searched_reach_ = reach;
  auto old = pairs_.begin();
  for (const auto& [i, j] : near_.found()) {
    while (old != pairs_.end() && std::pair(old->first, old->second) < std::pair(i, j)) ++old;
    const Vector apart = points_[static_cast<size_t>(i)] - points_[static_cast<size_t>(j)];
    const double distance = apart.norm();
    Pair pair{i, j, std::min(FullLength(i, j), distance), 0, {0, 0, 0}};
    if (old != pairs_.end() && old->first == i && old->second == j) pair = *old;
    const double stiffness = factor_ * 0.5 * (NodeStiffness(i) + NodeStiffness(j));
    sighted_.push_back(pair);
    active_.push_back({stiffness, friction_ * pair.normal_force,
                       distance > 0 ? Vector(apart / distance) : Vector(Vector::Zero())});
  }
}

void FragmentContact::AddInfluences(std::vector<Influence>& influences) const {
  for (const Pair& pair : sighted_) influences.push_back({pair.first, pair.second});
  if (piece_count_ < 2) return;
  // Crack faces whose edge was longer than the sight.
  for (const Spring& spring : springs_) {
    const auto [i, j] = incidence_.edges[static_cast<size_t>(spring.edge)];
    if (pieces_[static_cast<size_t>(i)] == pieces_[static_cast<size_t>(j)]) continue;
    const Vector apart = PointOf(i, start_displacements_) - PointOf(j, start_displacements_);
    if (apart.norm() < spring.length + mean_edge_length_) influences.push_back({i, j});
  }
}

template <typename Push>
void FragmentContact::ForSprings(const NodalVector& displacements, const Push& push) const {
  const auto press = [&](int32_t i, int32_t j, double length, double stiffness, size_t pair) {
    const Vector apart = PointOf(i, displacements) - PointOf(j, displacements);
    const double distance = apart.norm();
    const bool presses = distance < length && distance > 0;
    if (!presses && (pair == sighted_.size() || active_[pair].cap == 0)) return;
    push(i, j, apart, presses ? length - distance : 0, stiffness, pair);
  };
  for (const Spring& spring : springs_) {
    const auto [i, j] = incidence_.edges[static_cast<size_t>(spring.edge)];
    press(i, j, spring.length, spring.stiffness, sighted_.size());
  }
  for (size_t k = 0; k < sighted_.size(); ++k)
    press(sighted_[k].first, sighted_[k].second, sighted_[k].length, active_[k].stiffness, k);
}

double FragmentContact::AddForces(const NodalVector& displacements, NodalVector& forces) {
  double energy = 0;
  ForSprings(displacements, [&](int32_t i, int32_t j, const Vector& apart, double pressed,
                                double stiffness, size_t pair) {
    energy += 0.5 * stiffness * pressed * pressed;
    Vector force = Vector::Zero();
    if (pressed > 0) force = stiffness * pressed * apart.normalized();
    if (pair < sighted_.size() && active_[pair].cap > 0) {
      const FrictionSpring friction{stiffness, active_[pair].cap};
      const Vector stretch = Across(apart - ToEigen(sighted_[pair].anchor), active_[pair].normal);
      energy += friction.Energy(stretch.norm());
      force += friction.Force(stretch);
    }
    forces[static_cast<size_t>(i)] += ToLanes(force);
    forces[static_cast<size_t>(j)] -= ToLanes(force);
  });
  return energy;
}

void FragmentContact::AddStiffness(const NodalVector& displacements, Curvature curvature,
                                   NodeCouplings& couplings) {
  ForSprings(displacements, [&](int32_t i, int32_t j, const Vector& apart, double pressed,
                                double stiffness, size_t pair) {
    Eigen::Matrix3d spring = Eigen::Matrix3d::Zero();
    if (pressed > 0) {
      const Vector normal = apart.normalized();
      spring = stiffness * normal * normal.transpose();
    }
    if (pair < sighted_.size() && active_[pair].cap > 0) {
      const FrictionSpring friction{stiffness, active_[pair].cap};
      const Vector stretch = Across(apart - ToEigen(sighted_[pair].anchor), active_[pair].normal);
      spring += curvature == Curvature::kExact
                    ? friction.ExactStiffness(stretch, active_[pair].normal)
                    : friction.Stiffness(stretch, active_[pair].normal);
    }
    const Double4 block[3] = {ToLanes(spring.col(0)), ToLanes(spring.col(1)),
                              ToLanes(spring.col(2))};
    couplings.AddSpring(i, j, block);
  });
}

double FragmentContact::RoundingForce(const NodalVector& displacements) const {
  double squares = 0;
  ForSprings(
      displacements, [&](int32_t i, int32_t j, const Vector&, double, double stiffness, size_t) {
        const double size = PointOf(i, displacements).norm() + PointOf(j, displacements).norm();
        squares += 2 * stiffness * stiffness * size * size;
      });
  return kPositionRounding * std::sqrt(squares);
}

NodeTermWork FragmentContact::EndStep(const State& state) {
  NodeTermWork work;
  const bool broke = springs_.size() > old_springs_;
  old_springs_ = springs_.size();
  if (piece_count_ >= 2 || !springs_.empty()) {
    scratch_forces_.assign(state.displacements.size(), Splat(0));
    AddForces(state.displacements, scratch_forces_);
    double done = 0;  // J, on the nodes
    if (start_displacements_.size() == state.displacements.size()) {
      for (size_t n = 0; n < scratch_forces_.size(); ++n)
        done += Dot(scratch_forces_[n], state.displacements[n] - start_displacements_[n]);
    }
    ForSprings(state.displacements,
               [&](int32_t, int32_t, const Vector&, double pressed, double stiffness, size_t) {
                 work.stored_energy += 0.5 * stiffness * pressed * pressed;
               });
    for (size_t k = 0; k < sighted_.size(); ++k) {
      Pair& pair = sighted_[k];
      const Vector apart =
          PointOf(pair.first, state.displacements) - PointOf(pair.second, state.displacements);
      const double distance = apart.norm();
      pair.normal_force =
          distance > 0 ? active_[k].stiffness * std::max(0.0, pair.length - distance) : 0;
      Vector kept = Vector::Zero();
      if (active_[k].cap > 0) {
        const FrictionSpring friction{active_[k].stiffness, active_[k].cap};
        const Vector stretch = Across(apart - ToEigen(pair.anchor), active_[k].normal);
        kept = friction.Kept(stretch, friction_ * pair.normal_force);
        if (distance > 0) kept = Across(kept, apart / distance);
        const double stored = 0.5 * friction.stiffness * kept.squaredNorm();
        work.stored_energy += stored;
        work.dissipation += friction.Energy(stretch.norm()) - stored;
      }
      const Vector anchor = pair.normal_force > 0 ? Vector(apart - kept) : Vector(Vector::Zero());
      pair.anchor = {anchor[0], anchor[1], anchor[2]};
      pair.length = std::min(FullLength(pair.first, pair.second), std::max(pair.length, distance));
    }
    work.integration = -done - (work.stored_energy - stored_energy_) - work.dissipation;
    stored_energy_ = work.stored_energy;
  }
  pairs_.swap(sighted_);
  sighted_.clear();
  active_.clear();
  if (broke) UpdatePieces();
  return work;
}

void FragmentContact::Save(ByteWriter& out) const {
  out.PutVector(springs_);
  out.PutVector(pairs_);
  out.Put(stored_energy_);
}

absl::Status FragmentContact::Restore(ByteReader& in) {
  std::vector<Spring> springs = in.GetVector<Spring>();
  std::vector<Pair> pairs = in.GetVector<Pair>();
  const auto stored_energy = in.Get<double>();
  if (!in.ok()) return absl::DataLossError("the saved state of contact is truncated");
  bool known = true;
  for (const Spring& spring : springs)
    known = known && spring.edge >= 0 && spring.edge < incidence_.edge_count();
  for (const Pair& pair : pairs)
    known =
        known && pair.first >= 0 && pair.first < pair.second && pair.second < mesh_.node_count();
  if (!known) return absl::DataLossError("the saved state of contact is of another mesh");
  springs_ = std::move(springs);
  old_springs_ = springs_.size();
  pairs_ = std::move(pairs);
  stored_energy_ = stored_energy;
  UpdatePieces();
  return absl::OkStatus();
}

int64_t FragmentContact::BytesOf(int64_t nodes, int64_t edges) {
  const auto of_node = 3 * sizeof(int32_t) + 4 * sizeof(Vector) + 2 * sizeof(Double4);
  const auto of_pair = 2 * sizeof(Pair) + sizeof(Active) + 2 * sizeof(int32_t);
  return nodes * static_cast<int64_t>(of_node + 4 * of_pair) +
         edges * static_cast<int64_t>(sizeof(Spring));
}

int64_t FragmentContact::bytes() const {
  return near_.bytes() +
         static_cast<int64_t>(
             node_stiffness_.size() * sizeof(double) + springs_.capacity() * sizeof(Spring) +
             (pairs_.capacity() + sighted_.capacity()) * sizeof(Pair) +
             active_.capacity() * sizeof(Active) + pieces_.capacity() * sizeof(int32_t) +
             points_.capacity() * sizeof(Vector) +
             (start_displacements_.capacity() + scratch_forces_.capacity()) * sizeof(Double4));
}

}  // namespace cleave
