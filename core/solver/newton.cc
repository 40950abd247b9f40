#include "core/solver/newton.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/base/stopwatch.h"

namespace cleave {
namespace {

constexpr double kArmijo = 1e-4;
// A full Newton step that leaves more of the residual than this has met the projection's limits.
constexpr double kSlow = 0.1;
// Within this many tolerances of the solution, after a full step that was not slow, the last matrix
// does for one more: assembly costs as much as the iterations that it could save.
constexpr double kNear = 30;
// Linear solves aim this far below what the whole step has to reach.
constexpr double kLinearMargin = 0.1;
constexpr int kMaxBacktracks = 40;
// Newton's method needs a few iterations to find out which nodes touch, however good its steps are;
// half a step would not spare it that.
constexpr int32_t kTouchingIterations = 40;
// Energies are sums of about as many roundings as there are tets, mostly of random sign.
constexpr double kEnergyRounding = 1e-14;
// Elastic terms of an edge carry a few roundings each.
constexpr double kTermRounding = 1e-15;
// How much coarser floats round.
constexpr double kFloatOverDouble = 0x1.0p29;

}  // namespace

NewtonSolver::NewtonSolver(const Model& model)
    : model_(model),
      fixed_nodes_(FindFixedNodes(model, std::vector<uint8_t>(model.releases.size(), 0))),
      gravity_(model.gravity ? ToDouble4(*model.gravity) : Splat(0)),
      blocks_(model.unknown_count()),
      matrix_(model.incidence->edges, model.unknown_count()),
      pcg_(model.unknown_count(), model.node_count(), fixed_nodes_, model.quality.precision),
      element_rounding_(model.quality.precision == Precision::kFloat ? kFloatOverDouble : 1),
      inertia_(model.masses.size()),
      gradient_(model.masses.size()),
      residual_(model.masses.size()),
      search_(model.masses.size()),
      trial_(model.masses.size()),
      node_forces_(model.node_terms.empty() ? 0 : model.masses.size()) {
  if (model.damping) damping_.emplace(model);
  double squares = 0;
  for (const double mass : model.masses) squares += mass * mass;
  gravity_force_ = std::sqrt(squares * Dot(gravity_, gravity_));
}

void NewtonSolver::SetFixedNodes(std::vector<FixedNode> fixed_nodes) {
  fixed_nodes_ = std::move(fixed_nodes);
  pcg_.SetFixedNodes(fixed_nodes_);
}

void NewtonSolver::SetRuns(std::span<const std::array<int64_t, 2>> runs) {
  blocks_.SetRuns(runs);
  pcg_.SetRuns(runs);
  std::fill(residual_.begin(), residual_.end(), Splat(0));
  std::fill(search_.begin(), search_.end(), Splat(0));
}

void NewtonSolver::Evaluate(const State& start, double dt, const NodalVector& displacements,
                            double share) {
  ForAll([&](int64_t begin, int64_t end) {
    std::fill(gradient_.begin() + begin, gradient_.begin() + end, Splat(0));
  });
  elastic_energy_ = 0;
  for (const auto& term : model_.tet_terms)
    elastic_energy_ += term->AddForces(displacements, gradient_);

  // Inertial energy, gravity's energy, squared inertial and elastic forces.
  const Double4 sums = blocks_.Sum([&](int64_t begin, int64_t end) {
    Double4 inertial = Splat(0), outer = Splat(0), inertial_force = Splat(0);
    Double4 elastic_force = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      const Double4 moved = displacements[node] - start.displacements[node];
      const Double4 ahead = moved - dt * start.velocities[node];
      const Double4 push = inertia_[node] * ahead;
      const Double4 weight = model_.masses[node] * gravity_;
      const Double4 elastic = gradient_[node];
      inertial += 0.5 * push * ahead;
      outer -= weight * moved;
      inertial_force += push * push;
      elastic_force += elastic * elastic;
      gradient_[node] = push - elastic - weight;
      residual_[node] = -gradient_[node];
    }
    return Double4{Sum(inertial), Sum(outer), Sum(inertial_force), Sum(elastic_force)};
  });
  energy_ = sums[0] + sums[1] + elastic_energy_;
  energy_magnitude_ = sums[0] + std::abs(sums[1]) + element_rounding_ * std::abs(elastic_energy_);
  force_scale_ = std::sqrt(sums[2]) + std::sqrt(sums[3]) + gravity_force_;
  if (!model_.node_terms.empty()) EvaluateNodeTerms(displacements);
  if (damping_) EvaluateDamping(share);
  for (const FixedNode& fixed : fixed_nodes_) {
    Double4& residual = residual_[static_cast<size_t>(fixed.node)];
    residual = fixed.axes ? Splat(0) : residual;
  }
  const Double4 squares = blocks_.Sum([&](int64_t begin, int64_t end) {
    Double4 sum = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
      sum += residual_[node] * residual_[node];
    return sum;
  });
  residual_norm_ = std::sqrt(Sum(squares));
}

void NewtonSolver::EvaluateNodeTerms(const NodalVector& displacements) {
  ForAll([&](int64_t begin, int64_t end) {
    std::fill(node_forces_.begin() + begin, node_forces_.begin() + end, Splat(0));
  });
  node_energy_ = 0;
  for (const auto& term : model_.node_terms) {
    const double energy = term->AddForces(displacements, node_forces_);
    node_energy_ += energy;
    energy_magnitude_ += std::abs(energy);
  }
  energy_ += node_energy_;
  force_scale_ += std::sqrt(Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
    Double4 sum = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      sum += node_forces_[node] * node_forces_[node];
      gradient_[node] -= node_forces_[node];
      residual_[node] = -gradient_[node];
    }
    return sum;
  })));
}

void NewtonSolver::EvaluateDamping(double share) {
  const double potential = damping_->Potential(share);
  energy_ += potential;
  energy_magnitude_ += std::abs(potential);
  force_scale_ += std::sqrt(Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
    Double4 sum = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      const Double4 resistance = damping_->Resistance(node, share);
      sum += resistance * resistance;
      gradient_[node] += resistance;
      residual_[node] = -gradient_[node];
    }
    return sum;
  })));
}

double NewtonSolver::DampingLoss(const State& start, const NodalVector& displacements) {
  if (!damping_) return 0;
  return Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
    Double4 sum = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      sum += damping_->Resistance(node, 0) * (displacements[node] - start.displacements[node]);
    }
    return sum;
  }));
}

double NewtonSolver::ElasticWork(const State& start, double dt, const NodalVector& displacements) {
  return Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
    Double4 sum = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node) {
      const Double4 moved = displacements[node] - start.displacements[node];
      Double4 force = inertia_[node] * (moved - dt * start.velocities[node]) -
                      model_.masses[node] * gravity_ - gradient_[node];
      if (!node_forces_.empty()) force -= node_forces_[node];
      if (damping_) force += damping_->Resistance(node, 0);
      sum += force * moved;
    }
    return sum;
  }));
}

void NewtonSolver::SetBroken(std::span<const uint8_t> broken) {
  if (damping_) damping_->SetBroken(broken);
}

void NewtonSolver::BeginStep(const State& start, double dt, const NodalVector& displacements,
                             StepReport& report) {
  if (damping_) {
    ScopedTimer timer(report.assembly_seconds);
    ChooseBranches(start.displacements, BranchChoice::kStart);
    damping_->BeginStep(start, dt);
  }
  ChooseBranches(displacements, BranchChoice::kStart);
  exact_pays_ = false;
}

bool NewtonSolver::ChooseBranches(const NodalVector& displacements, BranchChoice choice) {
  bool changed = false;
  for (const auto& term : model_.tet_terms) changed |= term->ChooseBranches(displacements, choice);
  return changed;
}

absl::Status NewtonSolver::NotConverged(double relative_residual) const {
  size_t worst = 0;
  double largest = -1;
  for (size_t node = 0; node < residual_.size(); ++node) {
    const double size = Dot(residual_[node], residual_[node]);
    if (size > largest || !std::isfinite(size)) {
      largest = size;
      worst = node;
    }
    if (!std::isfinite(size)) break;
  }
  const std::string where = worst < static_cast<size_t>(model_.node_count())
                                ? absl::StrCat("node ", model_.order.old_node[worst])
                                : std::string("a moving collider");
  return absl::AbortedError(absl::StrCat("the solve did not converge: relative residual ",
                                         relative_residual, ", largest at ", where));
}

void NewtonSolver::Assemble(const NodalVector& displacements, Curvature curvature,
                            StepReport& report) {
  ScopedTimer timer(report.assembly_seconds);
  EdgeBlocks& blocks = matrix_.Clear();
  for (const auto& term : model_.tet_terms) term->AddStiffness(displacements, curvature, blocks);
  for (const auto& term : model_.node_terms)
    term->AddStiffness(displacements, curvature, matrix_.couplings());
  matrix_.Finish(inertia_);
  const Double4 gross = blocks_.Sum(
      [&](int64_t begin, int64_t end) { return matrix_.GrossTerms(displacements, begin, end); });
  if (damping_) damping_->AddTo(matrix_, inertia_);
  for (size_t node = 0; node < model_.mesh->rest_positions.size(); ++node)
    trial_[node] = ToDouble4(model_.mesh->rest_positions[node]) + displacements[node];
  pcg_.Prepare(matrix_, trial_);
  // Displacements are double in any case, and so are their differences; elements see the latter.
  // Strain has rounding of the size of element rotations, energy that times stress.
  const double in_strain = element_rounding_ * kTermRounding;
  rounding_energy_ = kTermRounding * gross[0] +
                     in_strain * std::sqrt(gross[0] * std::abs(elastic_energy_)) +
                     in_strain * in_strain * gross[0];
  rounding_force_ =
      rounding_inertia_ +
      kTermRounding * std::max(std::sqrt(gross[1]), element_rounding_ * std::sqrt(gross[2]));
  for (const auto& term : model_.node_terms) rounding_force_ += term->RoundingForce(displacements);
}

absl::StatusOr<bool> NewtonSolver::FindSearchDirection(const StopFlag& stop, StepReport& report) {
  ScopedTimer timer(report.linear_solve_seconds);
  const Quality& quality = model_.quality;
  const double needed = kLinearMargin * quality.residual_tolerance * force_scale_ / residual_norm_;
  const double tolerance = std::clamp(needed, quality.linear_tolerance,
                                      std::max(kLinearMargin, quality.linear_tolerance));
  CLEAVE_ASSIGN_OR_RETURN(const PcgSolver::Result result,
                          pcg_.Solve(matrix_, residual_, tolerance, stop, search_));
  report.linear_iterations += result.iterations;
  slope_ = -Sum(blocks_.Sum([&](int64_t begin, int64_t end) {
    Double4 sum = Splat(0);
    for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
      sum += residual_[node] * search_[node];
    return sum;
  }));
  return result.positive && slope_ <= 0;
}

absl::Status NewtonSolver::Solve(const State& start, double dt, const StopFlag& stop,
                                 NodalVector& displacements, StepReport& report) {
  const Quality& quality = model_.quality;
  const double step_limit = quality.step_tolerance * model_.mean_edge_length;
  double rounded_squares = 0;
  for (size_t node = 0; node < inertia_.size(); ++node) {
    inertia_[node] = model_.masses[node] / (dt * dt);
    const Double4 reach = Abs(start.displacements[node]) + dt * Abs(start.velocities[node]);
    rounded_squares += inertia_[node] * inertia_[node] * Dot(reach, reach);
  }
  rounding_inertia_ = kTermRounding * std::sqrt(rounded_squares);

  {
    ScopedTimer timer(report.assembly_seconds);
    ChooseBranches(displacements, BranchChoice::kAccepted);
    if (damping_) {
      ForAll([&](int64_t begin, int64_t end) {
        for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
          trial_[node] = displacements[node] - start.displacements[node];
      });
      damping_->SetMotion(trial_, blocks_);
    }
    Evaluate(start, dt, displacements, 0);
    initial_elastic_energy_ = elastic_energy_;
    initial_energy_ = energy_;
  }
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  rounding_force_ = rounding_inertia_;
  double last_step = kInfinity;
  double last_norm = kInfinity;
  double last_share = 0;
  bool exact_works = true;
  bool branched = false;
  for (int32_t iteration = 0;; ++iteration) {
    const double relative = force_scale_ > 0 ? residual_norm_ / force_scale_ : 0;
    const bool converged = residual_norm_ <= rounding_force_ ||
                           (relative <= quality.residual_tolerance && last_step <= step_limit);
    if (converged) {
      report.residual = std::max(report.residual, relative);
      return absl::OkStatus();
    }
    const bool touching = !matrix_.couplings().empty();
    const int32_t most = touching ? std::max(quality.newton_iterations, kTouchingIterations)
                                  : quality.newton_iterations;
    if (iteration >= most || !std::isfinite(relative)) return NotConverged(relative);
    ++report.newton_iterations;

    const bool slow = last_share == 1 && residual_norm_ > kSlow * last_norm;
    const bool near =
        last_share == 1 && !slow && !branched && relative <= kNear * quality.residual_tolerance;
    bool downhill = false;
    if (near) {
      CLEAVE_ASSIGN_OR_RETURN(downhill, FindSearchDirection(stop, report));
    } else if ((slow || (iteration == 0 && exact_pays_)) && exact_works) {
      Assemble(displacements, Curvature::kExact, report);
      CLEAVE_ASSIGN_OR_RETURN(downhill, FindSearchDirection(stop, report));
      exact_works = downhill;
      exact_pays_ = downhill && model_.fibrous;
    }
    if (!downhill) {
      Assemble(displacements, Curvature::kSemidefinite, report);
      CLEAVE_RETURN_IF_ERROR(FindSearchDirection(stop, report).status());
    }

    // Line search. Evaluate replaces the residual, so what the decrease is measured against is
    // kept.
    ScopedTimer timer(report.assembly_seconds);
    const double energy = energy_;
    const double norm = residual_norm_;
    const double rounding = kEnergyRounding * energy_magnitude_ + rounding_energy_;
    double share = 1;
    bool accepted = false;
    bool at_rounding = false;
    branched = false;
    if (damping_) damping_->SetSearch(search_, blocks_);
    for (int backtrack = 0; backtrack < kMaxBacktracks; ++backtrack, share /= 2) {
      ForAll([&](int64_t begin, int64_t end) {
        for (auto node = static_cast<size_t>(begin); node < static_cast<size_t>(end); ++node)
          trial_[node] = displacements[node] + share * search_[node];
      });
      // A branch is left for a lower one only: where the minimum of each lies in the domain of the
      // other, as of fibres that are crushed, a solve that went by domains alone had no end. What
      // was turned over goes through no length on its way back, where its own branch has an edge.
      branched |= ChooseBranches(trial_, BranchChoice::kTrial);
      Evaluate(start, dt, trial_, share);
      accepted = energy_ <= energy + kArmijo * share * slope_;
      if (accepted) break;
      // The promised decrease drowns in rounding: there the forces judge.
      at_rounding = share * -slope_ <= rounding;
      if (at_rounding) {
        accepted = energy_ <= energy + rounding && residual_norm_ < norm;
        break;
      }
    }
    if (accepted) {
      double largest = 0;
      for (const Double4& step : search_) {
        for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(step[axis]));
      }
      last_step = share * largest;
      last_share = share;
      last_norm = norm;
      displacements.swap(trial_);
      if (damping_) damping_->Accept(share, blocks_);
      if (ChooseBranches(displacements, BranchChoice::kAccepted)) {
        branched = true;
        Evaluate(start, dt, displacements, 0);
      }
      continue;
    }
    Evaluate(start, dt, displacements, 0);
    const double stopped_at = force_scale_ > 0 ? residual_norm_ / force_scale_ : 0;
    if (!at_rounding) return NotConverged(stopped_at);
    report.residual = std::max(report.residual, stopped_at);
    return absl::OkStatus();
  }
}

int64_t NewtonSolver::bytes() const {
  return matrix_.bytes() + pcg_.bytes() + blocks_.bytes() + (damping_ ? damping_->bytes() : 0) +
         static_cast<int64_t>((4 * gradient_.size() + node_forces_.size()) * sizeof(Double4) +
                              inertia_.size() * sizeof(double) +
                              fixed_nodes_.size() * sizeof(FixedNode));
}

}  // namespace cleave
