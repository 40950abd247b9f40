#include "core/solver/stepper.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/base/stopwatch.h"

namespace cleave {
namespace {

// What moves faster than this many parts can follow passes through: a scene that moves a collider
// at the speed of light shall not take forever.
constexpr int32_t kMaxParts = 64;
// A body whose flow takes more than this share of its elastic energy in a step is not at rest.
constexpr double kFlowing = 1e-9;

}  // namespace

Stepper::Stepper(const Model& model)
    : model_(model),
      newton_(model),
      fixed_for_(model.releases.size(), 0),
      displacements_(model.masses.size()) {
  if (model.fracture) breaking_.emplace(model);
  if (!model.releases.empty()) releases_.emplace(model, breaking());
  if (model.sleep) resting_.emplace(model);
  if (!breaking_ || breaking_->broken_edge_count() == 0) return;
  const std::vector<int32_t> edges = breaking_->fracture().BrokenEdges();
  for (const auto& term : model.node_terms) term->StartBroken(edges);
}

absl::Status Stepper::Step(double start, double end, const StopFlag& stop, State& state,
                           StepReport& report) {
  // Parts of the step still to do, the next one last.
  struct Part {
    double start, end;
    int32_t halvings;
  };
  std::vector<Part> parts;
  const int32_t count = PartCount(start, end, state);
  const auto time_of = [&](int32_t k) {
    return k == count ? end : start + (end - start) * k / count;
  };
  for (int32_t k = count - 1; k >= 0; --k) parts.push_back({time_of(k), time_of(k + 1), 0});
  while (!parts.empty()) {
    const Part part = parts.back();
    const absl::Status status = SolveStep(part.start, part.end, stop, state, report);
    if (status.ok()) {
      parts.pop_back();
      continue;
    }
    if (!absl::IsAborted(status)) return status;
    if (part.halvings == model_.quality.max_step_halvings) {
      return absl::AbortedError(absl::StrCat("from ", part.start, " s to ", part.end, " s, after ",
                                             part.halvings,
                                             " halvings of the step: ", status.message()));
    }
    if (breaking_) CLEAVE_RETURN_IF_ERROR(breaking_->RollBack());
    ++report.step_halvings;
    const double middle = 0.5 * (part.start + part.end);
    parts.back() = {middle, part.end, part.halvings + 1};
    parts.push_back({part.start, middle, part.halvings + 1});
  }
  return absl::OkStatus();
}

int32_t Stepper::PartCount(double start, double end, const State& state) const {
  double longest = end - start;
  for (const auto& term : model_.node_terms)
    longest = std::min(longest, term->LongestPart(start, end, state));
  // A NaN or a colliders' jump asks for no more than this.
  const double parts = std::ceil((end - start) / longest);
  return parts > 1 ? static_cast<int32_t>(std::min<double>(parts, kMaxParts)) : 1;
}

void Stepper::Prepare(double start, State& state) {
  if (breaking_ && !model_.node_terms.empty() &&
      damage_told_ != breaking_->fracture().damage_count()) {
    damage_told_ = breaking_->fracture().damage_count();
    for (const auto& term : model_.node_terms) term->SetDamage(breaking_->SolidFactors());
  }
  if (breaking_ && pieces_told_ != breaking_->broken_edge_count()) {
    pieces_told_ = breaking_->broken_edge_count();
    if (resting_) resting_->SetBroken(breaking_->fracture().edge_broken());
    newton_.SetBroken(breaking_->fracture().edge_broken());
  }
  if (!releases_) return;
  const std::vector<uint8_t> held = state.released;
  releases_->Update(start, breaking(), state);
  // What lets go in this step is felt wherever it held; it happens once.
  if (resting_ && state.released != held) resting_->WakeAll();
  if (state.released != fixed_for_) {
    newton_.SetFixedNodes(FindFixedNodes(model_, state.released));
    fixed_for_ = state.released;
    if (resting_) resting_->TellAgain();
  }
}

void Stepper::UpdateResting(double end, const State& state) {
  influences_.clear();
  for (const auto& term : model_.node_terms) term->AddInfluences(influences_);
  AddMotionInfluences(model_, state.released, end, state.displacements, influences_);
  if (breaking_) breaking_->AddStrandInfluences(influences_);
  if (!resting_->Update(influences_)) return;
  // A live tet is of one piece; strands are of pieces that sleep together.
  std::vector<uint8_t> asleep;
  if (std::count(resting_->asleep().begin(), resting_->asleep().end(), 1) > 0) {
    for (const auto& tet : model_.mesh->tets) {
      asleep.push_back(std::all_of(tet.begin(), tet.end(), [&](int32_t node) {
        return resting_->asleep()[static_cast<size_t>(node)] != 0;
      }));
    }
  }
  left_out_energy_ = 0;
  if (breaking_) {
    for (const auto& term : model_.tet_terms) term->LeaveOut({}, state.displacements);
    breaking_->LeaveOut({});
    breaking_->FindStresses(state.displacements);
  }
  for (const auto& term : model_.tet_terms)
    left_out_energy_ += term->LeaveOut(asleep, state.displacements);
  if (breaking_) breaking_->LeaveOut(std::move(asleep));
  std::vector<FixedNode> fixed_nodes = FindFixedNodes(model_, state.released);
  resting_->AddFixedNodes(fixed_nodes);
  newton_.SetFixedNodes(std::move(fixed_nodes));
  newton_.SetRuns(resting_->AwakeRuns());
}

absl::Status Stepper::SolveStep(double start, double end, const StopFlag& stop, State& state,
                                StepReport& report) {
  const double dt = end - start;
  if (breaking_) breaking_->Mark();
  Prepare(start, state);
  for (const auto& term : model_.node_terms) term->BeginStep(start, end, state);
  for (PlasticTerm* term : model_.plastic_terms) term->BeginStep(dt);
  if (resting_) UpdateResting(end, state);
  // Free nodes go on as they moved; given ones are where they will be.
  for (size_t node = 0; node < displacements_.size(); ++node)
    displacements_[node] = state.displacements[node] + dt * state.velocities[node];
  ApplyMotions(model_, state.released, end, displacements_);
  newton_.BeginStep(state, dt, displacements_, report);
  CLEAVE_RETURN_IF_ERROR(newton_.Solve(state, dt, stop, displacements_, report));
  // Motions move the body as it was, then it breaks: that way work and fracture energy match. What
  // integration loses is the elastic energy beyond its tangent, the squared change of velocity and
  // what re-solves give away, each positive where energies are convex.
  const double motion_work = MotionWork(state);
  double integration = elastic_energy_ - newton_.elastic_energy() - left_out_energy_ -
                       newton_.ElasticWork(state, dt, displacements_);
  const KineticEnergies intact = MovingEnergies(dt, state);
  const double node_balance = NodeTermBalance(state);
  const double damped = newton_.DampingLoss(state, displacements_);
  const double damping_potential = newton_.damping_potential();
  KineticEnergies moving = intact;
  double fracture_energy = 0;
  std::vector<EdgeBreak> breaks;
  if (all_asleep()) {
    // Stresses stay what they were.
  } else if (breaking_) {
    CLEAVE_RETURN_IF_ERROR(Break(dt, stop, state, fracture_energy, integration, breaks, report));
    moving = MovingEnergies(dt, state);
    // Node terms tell below what they did up to where the last solve ended; the motion that the
    // first one found is what their forces then drove.
    integration += NodeTermBalance(state) - node_balance;
  } else {
    Flow();
  }
  FlowWork flow;
  for (PlasticTerm* term : model_.plastic_terms) {
    if (all_asleep()) break;
    const FlowWork of_term = term->KeepFlow();
    flow.work += of_term.work;
    flow.potential += of_term.potential;
  }
  // What the potential has of viscosity is half of what that takes; the other half was counted as
  // lost to integration.
  integration += moving.change + intact.end - moving.end + flow.potential - flow.work;
  elastic_energy_ = newton_.elastic_energy() + left_out_energy_ - flow.potential;

  for (EdgeBreak& broken : breaks) broken.time = end;
  report.edge_breaks.insert(report.edge_breaks.end(), breaks.begin(), breaks.end());
  report.fracture_energy += fracture_energy;
  report.plastic_work += flow.work;
  // The potential that re-solves lower counts what they take back of damping's as lost to
  // integration.
  report.damping_dissipation += damped - (damping_potential - newton_.damping_potential());
  report.integration_dissipation += integration;
  report.external_work += motion_work + GravityWork(state);
  for (size_t node = 0; node < displacements_.size(); ++node)
    state.velocities[node] = (displacements_[node] - state.displacements[node]) / dt;
  state.displacements.swap(displacements_);
  if (breaking_ && !all_asleep()) {
    ScopedTimer timer(report.fracture_seconds);
    breaking_->EndStep(state.displacements);
  }
  double stored_energy = 0;
  for (const auto& term : model_.node_terms) {
    const NodeTermWork work = term->EndStep(state);
    report.external_work += work.external_work;
    report.friction_dissipation += work.dissipation;
    report.integration_dissipation += work.integration;
    stored_energy += work.stored_energy;
    term->Renew(state);
  }
  if (resting_) report.integration_dissipation += EndRest(dt, flow.work, state);
  report.contact_energy = stored_energy;
  report.shortest_step = report.steps == 0 ? dt : std::min(report.shortest_step, dt);
  ++report.steps;
  return absl::OkStatus();
}

absl::Status Stepper::Break(double dt, const StopFlag& stop, const State& state,
                            double& fracture_energy, double& integration,
                            std::vector<EdgeBreak>& breaks, StepReport& report) {
  for (int32_t pass = 0; pass < model_.fracture->max_passes; ++pass) {
    {
      ScopedTimer timer(report.fracture_seconds);
      Flow();
      if (!breaking_->BreakPass(displacements_)) return absl::OkStatus();
    }
    for (const auto& term : model_.node_terms)
      term->EdgesBroke(breaking_->newly_broken(), displacements_);
    if (resting_) resting_->EdgesBroke(breaking_->newly_broken());
    AddBreaks(breaks);
    ++report.break_passes;
    const double before = newton_.elastic_energy();
    CLEAVE_RETURN_IF_ERROR(newton_.Solve(state, dt, stop, displacements_, report));
    fracture_energy += before - newton_.initial_elastic_energy();
    integration += newton_.decrease();
  }
  Flow();
  return absl::OkStatus();
}

void Stepper::AddBreaks(std::vector<EdgeBreak>& breaks) const {
  const std::span<const int32_t> edges = breaking_->newly_broken();
  for (size_t i = 0; i < edges.size(); ++i) {
    EdgeBreak broken;
    broken.edge = edges[i];
    broken.energy = breaking_->break_energies()[i];
    Double4 middle = Splat(0);
    for (const int32_t node : model_.incidence->edges[static_cast<size_t>(edges[i])]) {
      const auto n = static_cast<size_t>(node);
      middle += ToDouble4(model_.mesh->rest_positions[n]) + displacements_[n];
    }
    broken.position = ToVec3(0.5 * middle);
    breaks.push_back(broken);
  }
}

void Stepper::Flow() {
  for (PlasticTerm* term : model_.plastic_terms) term->Flow(displacements_);
}

Stepper::KineticEnergies Stepper::MovingEnergies(double dt, const State& state) const {
  KineticEnergies energies;
  for (size_t node = 0; node < displacements_.size(); ++node) {
    const Double4 velocity = (displacements_[node] - state.displacements[node]) / dt;
    const Double4 change = velocity - state.velocities[node];
    energies.end += 0.5 * model_.masses[node] * Dot(velocity, velocity);
    energies.change += 0.5 * model_.masses[node] * Dot(change, change);
  }
  return energies;
}

double Stepper::MotionWork(const State& state) const {
  Double4 sum = Splat(0);
  for (const FixedNode& fixed : newton_.fixed_nodes()) {
    const auto node = static_cast<size_t>(fixed.node);
    const Double4 work =
        newton_.outer_forces()[node] * (displacements_[node] - state.displacements[node]);
    sum += fixed.axes ? work : Splat(0);
  }
  return Sum(sum);
}

double Stepper::GravityWork(const State& state) const {
  if (!model_.gravity) return 0;
  Double4 sum = Splat(0);
  for (size_t node = 0; node < displacements_.size(); ++node)
    sum += model_.masses[node] * (displacements_[node] - state.displacements[node]);
  return Dot(sum, ToDouble4(*model_.gravity));
}

double Stepper::NodeTermBalance(const State& state) const {
  const NodalVector& forces = newton_.node_forces();
  double sum = newton_.node_energy();
  for (size_t node = 0; node < forces.size(); ++node)
    sum += Dot(forces[node], displacements_[node] - state.displacements[node]);
  return sum;
}

double Stepper::EndRest(double dt, double plastic_work, State& state) {
  const bool flows = plastic_work > kFlowing * elastic_energy_;
  return resting_->EndStep(dt, flows, newton_, state);
}

std::vector<Vec3> Stepper::MotionForces(const State& state) const {
  if (!resting_ || model_.motions.empty())
    return SumMotionForces(model_, state.released, newton_.outer_forces());
  NodalVector forces = newton_.outer_forces();
  resting_->PutHeldForces(forces);
  return SumMotionForces(model_, state.released, forces);
}

int64_t Stepper::bytes() const {
  return newton_.bytes() + static_cast<int64_t>(displacements_.size() * sizeof(Double4)) +
         (resting_ ? resting_->bytes() : 0);
}

namespace {

// A part's bytes with their length before them, so that no part can read another's.
template <typename Part>
void SavePart(const Part& part, ByteWriter& out) {
  std::string bytes;
  ByteWriter writer(bytes);
  part.Save(writer);
  out.Put<uint64_t>(bytes.size());
  out.PutBytes(bytes);
}

template <typename Part>
absl::Status RestorePart(Part& part, absl::string_view name, ByteReader& in) {
  ByteReader reader(in.GetBytes(in.Get<uint64_t>()));
  if (!in.ok()) return absl::DataLossError("the saved state is truncated");
  CLEAVE_RETURN_IF_ERROR(part.Restore(reader));
  return reader.Finish(absl::StrCat("the saved state of ", name));
}

}  // namespace

void Stepper::Save(ByteWriter& out) const {
  out.Put(elastic_energy_);
  if (breaking_) SavePart(*breaking_, out);
  for (const auto& term : model_.tet_terms) SavePart(*term, out);
  for (const auto& term : model_.node_terms) SavePart(*term, out);
  if (resting_) SavePart(*resting_, out);
}

absl::Status Stepper::Restore(ByteReader& in) {
  const auto elastic_energy = in.Get<double>();
  damage_told_ = -1;
  if (releases_) releases_->Forget();
  if (breaking_) CLEAVE_RETURN_IF_ERROR(RestorePart(*breaking_, "fracture", in));
  for (const auto& term : model_.tet_terms)
    CLEAVE_RETURN_IF_ERROR(RestorePart(*term, term->name(), in));
  for (const auto& term : model_.node_terms)
    CLEAVE_RETURN_IF_ERROR(RestorePart(*term, term->name(), in));
  if (resting_) CLEAVE_RETURN_IF_ERROR(RestorePart(*resting_, "sleep", in));
  pieces_told_ = -1;
  elastic_energy_ = elastic_energy;
  return absl::OkStatus();
}

double KineticEnergy(const Model& model, const State& state) {
  double sum = 0;
  for (size_t node = 0; node < state.velocities.size(); ++node)
    sum += 0.5 * model.masses[node] * Dot(state.velocities[node], state.velocities[node]);
  return sum;
}

}  // namespace cleave
