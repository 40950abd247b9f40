#include "core/solver/rayleigh_damping.h"

#include "core/base/parallel.h"

namespace cleave {
namespace {

// J, work of forces (N) along a way (m).
double Work(const NodalVector& forces, const NodalVector& way, NodeBlocks& blocks) {
  return Sum(blocks.Sum([&](int64_t begin, int64_t end) {
    Double4 sum = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
      sum += forces[node] * way[node];
    return sum;
  }));
}

}  // namespace

RayleighDamping::RayleighDamping(const Model& model)
    : model_(model),
      rates_(model.masses.size(), 0),
      diagonal_(model.masses.size()),
      forces_(model.masses.size()),
      search_forces_(model.masses.size()) {
  // Unknowns of colliders, which come after the nodes, move freely.
  for (size_t node = 0; node < static_cast<size_t>(model.node_count()); ++node)
    rates_[node] = model.damping->mass_coefficient * model.masses[node];
  if (model.damping->stiffness_coefficient > 0) {
    resistance_.emplace(model.incidence->edges, model.unknown_count());
    rigid_steps_.emplace(model);
  }
}

void RayleighDamping::SetBroken(std::span<const uint8_t> broken) {
  if (rigid_steps_) rigid_steps_->SetBroken(broken);
}

void RayleighDamping::BeginStep(const State& start, double dt) {
  dt_ = dt;
  if (!resistance_) return;
  rigid_steps_->BeginStep(start, dt);
  EdgeBlocks& blocks = resistance_->Clear();
  for (const auto& term : model_.tet_terms)
    term->AddStiffness(start.displacements, Curvature::kSemidefinite, blocks);
  const auto coefficient = static_cast<float>(model_.damping->stiffness_coefficient);
  ParallelFor(static_cast<int64_t>(blocks.size()), 1 << 16, [&](int64_t begin, int64_t end) {
    for (auto k = static_cast<size_t>(begin); k < static_cast<size_t>(end); ++k)
      blocks[k] *= coefficient;
  });
  resistance_->Finish(rates_);
}

void RayleighDamping::SetForces(const NodalVector& way, NodeBlocks& blocks,
                                NodalVector& forces) const {
  blocks.Run([&](int64_t begin, int64_t end) {
    if (resistance_) {
      resistance_->Multiply(way, dt_, begin, end, forces);
      return;
    }
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
      forces[node] = rates_[node] / dt_ * way[node];
  });
}

void RayleighDamping::SetMotion(NodalVector& moved, NodeBlocks& blocks) {
  slope_ = half_curvature_ = 0;
  if (!rigid_steps_) {
    SetForces(moved, blocks, forces_);
    potential_ = 0.5 * Work(forces_, moved, blocks);
    return;
  }
  const NodalVector& ways = rigid_steps_->ways();
  ParallelFor(static_cast<int64_t>(moved.size()), 4096, [&](int64_t begin, int64_t end) {
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
      moved[node] -= ways[node];
  });
  SetForces(moved, blocks, forces_);
  potential_ = 0.5 * Work(forces_, moved, blocks);
  // Of mass the rest of the way counts, too.
  potential_ += Sum(blocks.Sum([&](int64_t begin, int64_t end) {
    Double4 sum = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      const Double4 push = rates_[node] / dt_ * ways[node];
      sum += push * (moved[node] + 0.5 * ways[node]);
      forces_[node] += push;
    }
    return sum;
  }));
}

void RayleighDamping::SetSearch(const NodalVector& search, NodeBlocks& blocks) {
  SetForces(search, blocks, search_forces_);
  slope_ = Work(forces_, search, blocks);
  half_curvature_ = 0.5 * Work(search_forces_, search, blocks);
}

void RayleighDamping::Accept(double share, NodeBlocks& blocks) {
  potential_ = Potential(share);
  blocks.Run([&](int64_t begin, int64_t end) {
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
      forces_[node] += share * search_forces_[node];
  });
  slope_ = half_curvature_ = 0;
}

void RayleighDamping::AddTo(StiffnessMatrix& matrix, const std::vector<double>& inertia) {
  for (size_t node = 0; node < rates_.size(); ++node)
    diagonal_[node] = inertia[node] + rates_[node] / dt_;
  matrix.SetInertia(diagonal_);
  if (resistance_) matrix.AddBlocks(*resistance_, 1 / dt_);
}

int64_t RayleighDamping::bytes() const {
  return static_cast<int64_t>((rates_.size() + diagonal_.size()) * sizeof(double) +
                              (forces_.size() + search_forces_.size()) * sizeof(Double4)) +
         (resistance_ ? resistance_->bytes() + rigid_steps_->bytes() : 0);
}

}  // namespace cleave
