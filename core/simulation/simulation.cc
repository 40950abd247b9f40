#include "core/simulation/simulation.h"

#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/bytes.h"
#include "core/base/crc32c.h"
#include "core/base/state_hash.h"
#include "core/base/status.h"
#include "core/base/stopwatch.h"
#include "core/damage/components.h"
#include "core/model/build_model.h"
#include "core/model/collider_term.h"
#include "core/simulation/scene_digest.h"
#include "core/solver/stepper.h"

namespace cleave {
namespace {

constexpr uint64_t kSavedMagic = 0x3145544154535643u;  // "CVSTATE1"
constexpr uint32_t kSavedVersion = 4;

// J, summed up since the start.
struct Energies {
  double external_work = 0;
  double fracture_energy = 0;
  double plastic_work = 0;
  double friction_dissipation = 0;
  double integration_dissipation = 0;
};

class BodySimulation final : public Simulation {
 public:
  BodySimulation(const Scene& scene, const TetMesh& mesh, Model model, int threads)
      : timing_(scene.timing),
        digest_(DigestScene(scene, mesh)),
        model_(std::move(model)),
        arena_(std::max(1, threads)),
        stepper_(model_),
        state_(InitialState(scene, mesh, model_)),
        positions_(mesh.rest_positions) {
    std::vector<int32_t> labels;
    const std::vector<uint8_t> broken(static_cast<size_t>(model_.incidence->edge_count()), 0);
    fragments_ = LabelComponents(*model_.incidence, broken, labels);
    PublishPositions();
    PublishBroken();
    if (Breaking* breaking = stepper_.breaking()) {
      pieces_.emplace(*model_.mesh, *model_.incidence,
                      NodeNames{model_.order.old_node, model_.order.new_node});
      pieces_->Break(breaking->fracture().BrokenEdges());
    }
  }

  absl::StatusOr<FrameReport> Advance(const StopFlag& stop) override {
    const Stopwatch watch;
    const State before = state_;
    const std::string parts_before = SaveParts();
    StepReport steps;
    const absl::Status status = arena_.execute([&] { return RunFrame(stop, steps); });
    if (!status.ok()) {
      state_ = before;
      ByteReader in(parts_before);
      CLEAVE_RETURN_IF_ERROR(stepper_.Restore(in));
      return status;
    }
    ++frame_;
    energies_.external_work += steps.external_work;
    energies_.fracture_energy += steps.fracture_energy;
    energies_.plastic_work += steps.plastic_work;
    energies_.friction_dissipation += steps.friction_dissipation;
    energies_.integration_dissipation += steps.integration_dissipation;
    damping_dissipation_ += steps.damping_dissipation;
    PublishPositions();

    FrameReport report;
    report.new_broken_edges = -static_cast<int64_t>(broken_edges_.size());
    PublishBroken();
    report.broken_edges = static_cast<int64_t>(broken_edges_.size());
    report.new_broken_edges += report.broken_edges;
    if (pieces_) report.events = NameEvents(steps.edge_breaks);
    report.break_passes = steps.break_passes;
    report.fracture_energy = energies_.fracture_energy;
    report.fracture_seconds = steps.fracture_seconds;
    report.frame = frame_;
    report.time = time();
    report.steps = steps.steps;
    report.step_halvings = steps.step_halvings;
    report.shortest_step = steps.shortest_step;
    report.newton_iterations = steps.newton_iterations;
    report.linear_iterations = steps.linear_iterations;
    report.residual = steps.residual;
    report.kinetic_energy = KineticEnergy(model_, state_);
    report.elastic_energy = stepper_.elastic_energy();
    report.external_work = energies_.external_work;
    report.plastic_work = energies_.plastic_work;
    report.contact_energy = steps.contact_energy;
    report.friction_dissipation = energies_.friction_dissipation;
    report.damping_dissipation = damping_dissipation_;
    report.integration_dissipation = energies_.integration_dissipation;
    report.fragments = fragments_;
    if (const Resting* resting = stepper_.resting())
      report.sleeping_pieces = resting->SleepingPieces();
    report.motion_forces = stepper_.MotionForces(state_);
    if (model_.colliders != nullptr) {
      for (const ColliderPose& pose : model_.colliders->Poses(time(), state_)) {
        const Eigen::Vector3d translation = pose.to - pose.turn * pose.from;
        report.colliders.push_back({{pose.turn.w(), pose.turn.x(), pose.turn.y(), pose.turn.z()},
                                    {translation[0], translation[1], translation[2]}});
      }
    }
    report.assembly_seconds = steps.assembly_seconds;
    report.linear_solve_seconds = steps.linear_solve_seconds;
    report.total_seconds = watch.Seconds();
    return report;
  }

  int64_t frame() const override { return frame_; }
  double time() const override { return TimeOf(frame_, 0); }
  const std::vector<Vec3>& positions() const override { return positions_; }
  int64_t fragments() const override { return fragments_; }
  const std::vector<int32_t>& broken_edges() const override { return broken_edges_; }

  std::vector<double> plastic_strains() const override {
    if (model_.plastic_terms.empty()) return {};
    std::vector<double> strains(static_cast<size_t>(model_.tet_count()), 0);
    std::vector<double> of_term;
    for (const PlasticTerm* term : model_.plastic_terms) {
      of_term.resize(static_cast<size_t>(term->tet_count()));
      term->GetPlasticStrains(of_term);
      for (size_t place = 0; place < of_term.size(); ++place) {
        const auto tet = static_cast<size_t>(term->tet_at(static_cast<int64_t>(place)));
        strains[static_cast<size_t>(model_.order.old_tet[tet])] = of_term[place];
      }
    }
    return strains;
  }

  std::string Save() const override {
    std::string saved;
    ByteWriter out(saved);
    out.Put(kSavedMagic);
    out.Put(kSavedVersion);
    out.Put(digest_);
    out.Put(frame_);
    out.Put(energies_);
    if (model_.damping) out.Put(damping_dissipation_);
    out.PutVector(state_.displacements);
    out.PutVector(state_.velocities);
    if (!model_.releases.empty()) out.PutVector(state_.released);
    if (pieces_) out.PutVector(pieces_->FirstNodes());
    out.PutBytes(SaveParts());
    out.Put(Crc32c(saved));
    return saved;
  }

  absl::Status Restore(absl::string_view saved) override {
    if (saved.size() < sizeof(uint32_t)) return absl::DataLossError("the saved state is truncated");
    const absl::string_view body = saved.substr(0, saved.size() - sizeof(uint32_t));
    ByteReader checksum(saved.substr(body.size()));
    if (checksum.Get<uint32_t>() != Crc32c(body))
      return absl::DataLossError("the saved state does not match its checksum");
    ByteReader in(body);
    if (in.Get<uint64_t>() != kSavedMagic)
      return absl::DataLossError("these bytes are not a saved state");
    if (const auto version = in.Get<uint32_t>(); version != kSavedVersion)
      return absl::FailedPreconditionError(absl::StrCat("the saved state has format ", version,
                                                        ", this build reads ", kSavedVersion));
    if (in.Get<uint64_t>() != digest_)
      return absl::FailedPreconditionError("the saved state is of another scene or mesh");
    const auto frame = in.Get<int64_t>();
    const auto energies = in.Get<Energies>();
    const double damping_dissipation = model_.damping ? in.Get<double>() : 0;
    State state;
    state.displacements = in.GetVector<Double4>();
    state.velocities = in.GetVector<Double4>();
    if (!model_.releases.empty()) state.released = in.GetVector<uint8_t>();
    std::vector<int32_t> first_nodes;
    if (pieces_) first_nodes = in.GetVector<int32_t>();
    if (!in.ok()) return absl::DataLossError("the saved state is truncated");
    if (frame < 0 || state.displacements.size() != state_.displacements.size() ||
        state.velocities.size() != state_.velocities.size() ||
        state.released.size() != state_.released.size())
      return absl::DataLossError("the saved state contradicts itself");
    const std::string parts_before = SaveParts();
    absl::Status status = stepper_.Restore(in);
    if (status.ok()) status = in.Finish("the saved state");
    if (status.ok() && pieces_ &&
        !pieces_->Reset(stepper_.breaking()->fracture().BrokenEdges(), first_nodes))
      status = absl::DataLossError("the saved state names other pieces than it has");
    if (!status.ok()) {
      ByteReader undo(parts_before);
      CLEAVE_RETURN_IF_ERROR(stepper_.Restore(undo));
      return status;
    }
    frame_ = frame;
    energies_ = energies;
    damping_dissipation_ = damping_dissipation;
    state_ = std::move(state);
    PublishPositions();
    PublishBroken();
    return absl::OkStatus();
  }

  uint64_t state_hash() const override { return StateHash::Of(Save()); }

 private:
  FrameEvents NameEvents(std::span<const EdgeBreak> breaks) {
    std::vector<int32_t> edges;
    std::vector<EdgeBreakEvent> events;
    for (const EdgeBreak& broken : breaks) {
      const auto edge = static_cast<size_t>(broken.edge);
      edges.push_back(broken.edge);
      EdgeBreakEvent event;
      event.edge = model_.fracture->client_edge[edge];
      event.place = {broken.time, {0, 0, 0}, broken.position, broken.energy};
      for (size_t i = 0; i < 2; ++i) {
        const auto node = static_cast<size_t>(model_.incidence->edges[edge][i]);
        event.nodes[i] = model_.order.old_node[node];
        for (size_t axis = 0; axis < 3; ++axis)
          event.place.rest[axis] += 0.5 * model_.mesh->rest_positions[node][axis];
      }
      std::sort(event.nodes.begin(), event.nodes.end());
      events.push_back(event);
    }
    const std::span<const PieceSplit> splits = pieces_->Break(edges);
    return MakeFrameEvents(std::move(events), splits, *pieces_, model_.order.new_node);
  }

  // s; the same number however a run comes to it.
  double TimeOf(int64_t frame, int32_t step) const {
    return (static_cast<double>(frame) + static_cast<double>(step) / timing_.steps_per_frame) /
           timing_.frames_per_second;
  }

  std::string SaveParts() const {
    std::string parts;
    ByteWriter out(parts);
    stepper_.Save(out);
    return parts;
  }

  absl::Status RunFrame(const StopFlag& stop, StepReport& report) {
    for (int32_t step = 0; step < timing_.steps_per_frame; ++step) {
      if (stop.requested()) return absl::CancelledError("stopped between steps");
      CLEAVE_RETURN_IF_ERROR(
          stepper_.Step(TimeOf(frame_, step), TimeOf(frame_, step + 1), stop, state_, report));
    }
    return absl::OkStatus();
  }

  void PublishPositions() {
    for (size_t node = 0; node < positions_.size(); ++node) {
      positions_[static_cast<size_t>(model_.order.old_node[node])] =
          ToVec3(ToDouble4(model_.mesh->rest_positions[node]) + state_.displacements[node]);
    }
  }

  void PublishBroken() {
    if (Breaking* breaking = stepper_.breaking()) {
      broken_edges_ = breaking->ClientBrokenEdges();
      fragments_ = breaking->ComponentCount();
    }
  }

  const Timing timing_;
  const uint64_t digest_;
  const Model model_;
  tbb::task_arena arena_;
  Stepper stepper_;
  State state_;
  int64_t frame_ = 0;
  Energies energies_;
  double damping_dissipation_ = 0;  // J, since the start
  int64_t fragments_ = 0;
  std::optional<NamedPieces> pieces_;  // where the body can break
  std::vector<Vec3> positions_;
  std::vector<int32_t> broken_edges_;
};

}  // namespace

absl::StatusOr<std::unique_ptr<Simulation>> Simulation::Create(const Scene& scene, TetMesh mesh,
                                                               const Options& options) {
  using Result = absl::StatusOr<std::unique_ptr<Simulation>>;
  tbb::task_arena arena(std::max(1, options.threads));
  return arena.execute([&]() -> Result {
    CLEAVE_ASSIGN_OR_RETURN(Model model, BuildModel(scene, mesh));
    return std::make_unique<BodySimulation>(scene, mesh, std::move(model), options.threads);
  });
}

}  // namespace cleave
