#include "core/solver/resting.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/damage/components.h"

namespace cleave {
namespace {

constexpr double kAsleep = std::numeric_limits<double>::infinity();
// Forces balance that leave less than this share of their sizes. In flight it is all of it; a solve
// leaves 1e-4, and a body that comes to rest on springs sways by a few hundredths at the end.
constexpr double kUnbalanced = 0.05;
// In place of 0 and 1 in asleep_, when nobody has been told yet.
constexpr uint8_t kUntold = 2;

}  // namespace

Resting::Resting(const Model& model)
    : model_(model),
      quiet_seconds_(model.masses.size(), 0),
      held_forces_(model.motions.empty() ? 0 : model.masses.size()),
      asleep_(model.masses.size(), 0) {
  SetBroken(std::vector<uint8_t>(static_cast<size_t>(model.incidence->edge_count()), 0));
}

void Resting::SetBroken(std::span<const uint8_t> broken) {
  body_piece_count_ = LabelComponents(*model_.incidence, broken, pieces_);
  piece_count_ = body_piece_count_;
  // Two unknowns of each moving collider.
  while (pieces_.size() < model_.masses.size()) {
    pieces_.insert(pieces_.end(), 2, piece_count_);
    ++piece_count_;
  }
  groups_.resize(static_cast<size_t>(piece_count_));
  stirred_.resize(groups_.size());
  sums_.resize(groups_.size());
}

void Resting::EdgesBroke(std::span<const int32_t> edges) {
  for (const int32_t edge : edges) {
    for (const int32_t node : model_.incidence->edges[static_cast<size_t>(edge)])
      quiet_seconds_[static_cast<size_t>(node)] = 0;
  }
}

void Resting::WakeAll() { std::fill(quiet_seconds_.begin(), quiet_seconds_.end(), 0.0); }

void Resting::TellAgain() { std::fill(asleep_.begin(), asleep_.end(), kUntold); }

int32_t Resting::FindGroup(int32_t piece) {
  while (groups_[static_cast<size_t>(piece)] != piece) {
    int32_t& parent = groups_[static_cast<size_t>(piece)];
    parent = groups_[static_cast<size_t>(parent)];
    piece = parent;
  }
  return piece;
}

bool Resting::Update(std::span<const Influence> influences) {
  std::iota(groups_.begin(), groups_.end(), 0);
  std::fill(stirred_.begin(), stirred_.end(), uint8_t{0});
  for (const auto& [node, other] : influences) {
    const int32_t piece = pieces_[static_cast<size_t>(node)];
    if (piece < 0) continue;
    if (other < 0) {
      stirred_[static_cast<size_t>(piece)] = 1;
      continue;
    }
    if (pieces_[static_cast<size_t>(other)] < 0) continue;
    const int32_t a = FindGroup(piece), b = FindGroup(pieces_[static_cast<size_t>(other)]);
    groups_[static_cast<size_t>(std::max(a, b))] = std::min(a, b);
  }
  // A group sleeps where every unknown in it does.
  std::vector<uint8_t> awake(groups_.size(), 0);
  for (size_t u = 0; u < pieces_.size(); ++u) {
    if (pieces_[u] < 0) continue;
    const auto piece = static_cast<size_t>(pieces_[u]);
    if (quiet_seconds_[u] != kAsleep || stirred_[piece] != 0)
      awake[static_cast<size_t>(FindGroup(pieces_[u]))] = 1;
  }
  bool changed = false;
  all_asleep_ = true;
  for (size_t u = 0; u < pieces_.size(); ++u) {
    const bool sleeps = pieces_[u] >= 0 && awake[static_cast<size_t>(FindGroup(pieces_[u]))] == 0;
    if (!sleeps && quiet_seconds_[u] == kAsleep) quiet_seconds_[u] = 0;
    all_asleep_ = all_asleep_ && (sleeps || pieces_[u] < 0);
    const uint8_t now = sleeps ? 1 : 0;
    changed = changed || asleep_[u] != now;
    asleep_[u] = now;
  }
  return changed;
}

Double4 Resting::PositionOf(size_t unknown, const State& state) const {
  return unknown < model_.mesh->rest_positions.size()
             ? ToDouble4(model_.mesh->rest_positions[unknown]) + state.displacements[unknown]
             : Splat(0);
}

void Resting::AddForce(size_t unknown, Double4 force, const State& state) {
  if (pieces_[unknown] < 0) return;
  Sums& sums = sums_[static_cast<size_t>(pieces_[unknown])];
  const double size = std::sqrt(Dot(force, force));
  const auto nodes = static_cast<size_t>(model_.node_count());
  if (unknown >= nodes && (unknown - nodes) % 2 == 1) {
    // What turns a collider; its unknown is scaled so that this is a force.
    sums.moment += force;
    sums.moment_size += size;
    return;
  }
  const Double4 arm = unknown < nodes ? PositionOf(unknown, state) - sums.center : Splat(0);
  sums.force += force;
  sums.force_size += size;
  sums.moment += Cross(arm, force);
  sums.moment_size += std::sqrt(Dot(arm, arm)) * size;
}

void Resting::AddAllForces(const NewtonSolver& solver, const State& state) {
  const NodalVector& of_terms = solver.node_forces();
  const Double4 gravity = model_.gravity ? ToDouble4(*model_.gravity) : Splat(0);
  for (size_t u = 0; u < pieces_.size(); ++u) {
    AddForce(u, model_.masses[u] * gravity, state);
    if (!of_terms.empty()) AddForce(u, of_terms[u], state);
  }
  for (const FixedNode& fixed : solver.fixed_nodes()) {
    const auto node = static_cast<size_t>(fixed.node);
    AddForce(node, fixed.axes ? solver.outer_forces()[node] : Splat(0), state);
  }
}

double Resting::EndStep(double dt, bool flows, const NewtonSolver& solver, State& state) {
  for (Sums& sums : sums_) sums = {.quiet_seconds = kAsleep};
  for (size_t u = 0; u < pieces_.size(); ++u) {
    if (pieces_[u] < 0) continue;
    Sums& sums = sums_[static_cast<size_t>(pieces_[u])];
    sums.mass += model_.masses[u];
    sums.center += model_.masses[u] * PositionOf(u, state);
    sums.speed_squared =
        std::max(sums.speed_squared, Dot(state.velocities[u], state.velocities[u]));
    sums.quiet_seconds = std::min(sums.quiet_seconds, quiet_seconds_[u]);
  }
  for (Sums& sums : sums_) sums.center /= sums.mass;
  AddAllForces(solver, state);
  const double limit = model_.sleep->speed * model_.sleep->speed;
  for (size_t piece = 0; piece < sums_.size(); ++piece) {
    Sums& sums = sums_[piece];
    const auto balance = [](Double4 sum, double size) {
      return Dot(sum, sum) <= kUnbalanced * kUnbalanced * size * size;
    };
    const bool quiet = !flows && stirred_[piece] == 0 && sums.speed_squared <= limit &&
                       balance(sums.force, sums.force_size) &&
                       balance(sums.moment, sums.moment_size);
    // What sleeps goes on doing so.
    sums.quiet_seconds = sums.quiet_seconds == kAsleep ? kAsleep
                         : quiet                       ? sums.quiet_seconds + dt
                                                       : 0;
  }
  // A group falls asleep together.
  std::vector<double> least(sums_.size(), kAsleep);
  for (size_t piece = 0; piece < sums_.size(); ++piece) {
    double& of_group = least[static_cast<size_t>(FindGroup(static_cast<int32_t>(piece)))];
    of_group = std::min(of_group, sums_[piece].quiet_seconds);
  }
  double energy = 0;
  for (size_t u = 0; u < pieces_.size(); ++u) {
    if (pieces_[u] < 0 || quiet_seconds_[u] == kAsleep) continue;
    quiet_seconds_[u] = sums_[static_cast<size_t>(pieces_[u])].quiet_seconds;
    if (least[static_cast<size_t>(FindGroup(pieces_[u]))] < model_.sleep->time) continue;
    quiet_seconds_[u] = kAsleep;
    energy += 0.5 * model_.masses[u] * Dot(state.velocities[u], state.velocities[u]);
    state.velocities[u] = Splat(0);
    if (!held_forces_.empty()) held_forces_[u] = solver.outer_forces()[u];
  }
  return energy;
}

void Resting::AddFixedNodes(std::vector<FixedNode>& fixed_nodes) const {
  std::vector<FixedNode> merged;
  auto given = fixed_nodes.begin();
  for (size_t u = 0; u < asleep_.size(); ++u) {
    const auto node = static_cast<int32_t>(u);
    const bool is_given = given != fixed_nodes.end() && given->node == node;
    if (asleep_[u] != 0) {
      merged.push_back({node, Int64x4{-1, -1, -1, 0}});
    } else if (is_given) {
      merged.push_back(*given);
    }
    if (is_given) ++given;
  }
  fixed_nodes = std::move(merged);
}

std::vector<std::array<int64_t, 2>> Resting::AwakeRuns() const {
  std::vector<std::array<int64_t, 2>> runs;
  for (size_t u = 0; u < asleep_.size(); ++u) {
    if (asleep_[u] != 0) continue;
    const auto unknown = static_cast<int64_t>(u);
    if (runs.empty() || runs.back()[1] != unknown) runs.push_back({unknown, unknown});
    runs.back()[1] = unknown + 1;
  }
  return runs;
}

int64_t Resting::SleepingPieces() const {
  std::vector<uint8_t> awake(static_cast<size_t>(body_piece_count_), 0);
  for (size_t node = 0; node < static_cast<size_t>(model_.node_count()); ++node) {
    if (pieces_[node] >= 0 && quiet_seconds_[node] != kAsleep)
      awake[static_cast<size_t>(pieces_[node])] = 1;
  }
  return std::count(awake.begin(), awake.end(), 0);
}

void Resting::PutHeldForces(NodalVector& forces) const {
  for (size_t u = 0; u < held_forces_.size(); ++u) {
    if (asleep_[u] != 0) forces[u] = held_forces_[u];
  }
}

void Resting::Save(ByteWriter& out) const {
  out.PutVector(quiet_seconds_);
  out.PutVector(held_forces_);
}

absl::Status Resting::Restore(ByteReader& in) {
  auto seconds = in.GetVector<double>();
  auto forces = in.GetVector<Double4>();
  const bool counted =
      std::all_of(seconds.begin(), seconds.end(), [](double value) { return value >= 0; });
  if (!in.ok() || !counted || seconds.size() != quiet_seconds_.size() ||
      forces.size() != held_forces_.size())
    return absl::DataLossError("the saved state of sleep is of another body");
  quiet_seconds_ = std::move(seconds);
  held_forces_ = std::move(forces);
  TellAgain();
  return absl::OkStatus();
}

int64_t Resting::bytes() const {
  return static_cast<int64_t>(pieces_.size() * sizeof(int32_t) +
                              quiet_seconds_.size() * sizeof(double) +
                              held_forces_.size() * sizeof(Double4) + asleep_.size() +
                              groups_.size() * (sizeof(int32_t) + 1 + sizeof(Sums)));
}

}  // namespace cleave
