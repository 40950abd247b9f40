#include "core/model/load_terms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "core/mesh/boundary_faces.h"
#include "core/model/model.h"

namespace cleave {
namespace {

double Determinant(Double4 a, Double4 b, Double4 c) { return Dot(a, Cross(b, c)); }

// What all loads have in common: how strong they are.
class LoadTerm : public NodeTerm {
 public:
  LoadTerm(const Load& load, int32_t release) : keyframes_(load.keyframes), release_(release) {}

  absl::string_view name() const override { return "load"; }

 protected:
  // Times the load, over a step from `start` to `end` (s).
  double Intensity(double start, double end, const State& state) {
    const bool released = release_ >= 0 && state.released[static_cast<size_t>(release_)] != 0;
    const double intensity = IntensityAt(keyframes_, end);
    changes_ = !released && intensity != IntensityAt(keyframes_, start);
    return released ? 0 : intensity;
  }
  // Of a load on these nodes.
  void AddChange(const std::vector<int32_t>& nodes, std::vector<Influence>& influences) const {
    if (!changes_) return;
    for (const int32_t node : nodes) influences.push_back({node, -1});
  }
  int64_t keyframe_bytes() const {
    return static_cast<int64_t>(keyframes_.size() * sizeof(LoadKeyframe));
  }

 private:
  const std::vector<LoadKeyframe> keyframes_;
  const int32_t release_;
  bool changes_ = false;  // within the step
};

// A fixed vector times a weight a node: a share of a point force, or an area of a traction.
class DeadLoadTerm final : public LoadTerm {
 public:
  static constexpr int64_t kNodeBytes = sizeof(int32_t) + sizeof(double) + sizeof(Double4);

  DeadLoadTerm(const Load& load, std::vector<int32_t> nodes, const TetMesh& mesh,
               const Incidence& incidence, int32_t release)
      : LoadTerm(load, release),
        mesh_(mesh),
        incidence_(incidence),
        nodes_(std::move(nodes)),
        weights_(nodes_.size()),
        start_(nodes_.size()) {
    if (const auto* force = std::get_if<PointForce>(&load.kind)) {
      vector_ = ToDouble4(force->total);
    } else {
      vector_ = ToDouble4(std::get<SurfaceTraction>(load.kind).traction);
      faces_ = FindBoundaryFaces(mesh, nodes_);
    }
    is_point_force_ = std::holds_alternative<PointForce>(load.kind);
    Weigh([](int32_t) { return true; });
  }

  int64_t bytes() const override {
    return static_cast<int64_t>(nodes_.size()) * kNodeBytes +
           static_cast<int64_t>(faces_.size() * sizeof(BoundaryFace)) + keyframe_bytes();
  }

  void SetDamage(std::span<const double> factors) override {
    Weigh([&](int32_t tet) { return factors[static_cast<size_t>(tet)] > 0; });
  }

  void AddInfluences(std::vector<Influence>& influences) const override {
    AddChange(nodes_, influences);
  }

  void BeginStep(double start, double end, const State& state) override {
    force_ = Intensity(start, end, state) * vector_;
    for (size_t i = 0; i < nodes_.size(); ++i)
      start_[i] = state.displacements[static_cast<size_t>(nodes_[i])];
  }

  double AddForces(const NodalVector& displacements, NodalVector& forces) override {
    for (size_t i = 0; i < nodes_.size(); ++i)
      forces[static_cast<size_t>(nodes_[i])] += weights_[i] * force_;
    return -Work(displacements);
  }

  NodeTermWork EndStep(const State& state) override {
    return {.external_work = Work(state.displacements)};
  }

 private:
  // J, since the start of the step.
  double Work(const NodalVector& displacements) const {
    Double4 sum = Splat(0);
    for (size_t i = 0; i < nodes_.size(); ++i)
      sum += weights_[i] * (displacements[static_cast<size_t>(nodes_[i])] - start_[i]);
    return Dot(sum, force_);
  }

  template <typename IsLive>
  void Weigh(const IsLive& is_live) {
    if (is_point_force_) {
      for (size_t i = 0; i < nodes_.size(); ++i) {
        const std::span<const int32_t> tets = incidence_.node_tets[nodes_[i]];
        weights_[i] = std::any_of(tets.begin(), tets.end(), is_live)
                          ? 1 / static_cast<double>(nodes_.size())
                          : 0;
      }
      return;
    }
    std::fill(weights_.begin(), weights_.end(), 0.0);
    for (const BoundaryFace& face : faces_) {
      if (!is_live(face.tet)) continue;
      Double4 corners[3];
      for (size_t k = 0; k < 3; ++k)
        corners[k] = ToDouble4(mesh_.rest_positions[static_cast<size_t>(face.nodes[k])]);
      const Double4 twice = Cross(corners[1] - corners[0], corners[2] - corners[0]);
      for (const int32_t node : face.nodes) {
        const auto place = std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin();
        weights_[static_cast<size_t>(place)] += std::sqrt(Dot(twice, twice)) / 6;
      }
    }
  }

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const std::vector<int32_t> nodes_;  // ascending
  bool is_point_force_ = false;       // else a traction
  std::vector<BoundaryFace> faces_;   // of a traction
  Double4 vector_;                    // N or Pa
  Double4 force_ = Splat(0);          // vector_ as strong as it is in this step
  std::vector<double> weights_;       // a node each; 1 or m^2
  NodalVector start_;                 // m, displacements of nodes_ at the start of the step
};

class PressureTerm final : public LoadTerm {
 public:
  static constexpr int64_t kNodeBytes = sizeof(int32_t) + 5 * sizeof(Double4);
  static constexpr int64_t kFaceBytes = sizeof(BoundaryFace) + sizeof(std::array<int32_t, 3>);
  static constexpr int64_t kSideBytes = 4 * sizeof(int32_t);

  PressureTerm(const Load& load, const std::vector<int32_t>& nodes, const TetMesh& mesh,
               int32_t release)
      : LoadTerm(load, release),
        full_pressure_(std::get<SurfacePressure>(load.kind).pressure),
        mesh_(mesh),
        all_faces_(FindBoundaryFaces(mesh, nodes)) {
    for (const BoundaryFace& face : all_faces_)
      nodes_.insert(nodes_.end(), face.nodes.begin(), face.nodes.end());
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    for (BoundaryFace& face : all_faces_) {
      for (int32_t& node : face.nodes) {
        node = static_cast<int32_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) -
                                    nodes_.begin());
      }
    }
    start_.resize(nodes_.size());
    start_displacements_.resize(nodes_.size());
    points_.resize(nodes_.size());
    moved_.resize(nodes_.size());
    volume_gradient_.resize(nodes_.size());
    FindLive([](int32_t) { return true; });
  }

  int64_t bytes() const override {
    return static_cast<int64_t>(nodes_.size()) * kNodeBytes +
           static_cast<int64_t>(all_faces_.size()) * kFaceBytes +
           static_cast<int64_t>(sides_.capacity()) * kSideBytes + keyframe_bytes();
  }

  void SetDamage(std::span<const double> factors) override {
    FindLive([&](int32_t tet) { return factors[static_cast<size_t>(tet)] > 0; });
  }

  void AddInfluences(std::vector<Influence>& influences) const override {
    AddChange(nodes_, influences);
  }

  void BeginStep(double start, double end, const State& state) override {
    pressure_ = full_pressure_ * Intensity(start, end, state);
    if (pressure_ == 0 || nodes_.empty()) return;
    apex_ = Splat(0);
    for (size_t i = 0; i < nodes_.size(); ++i) {
      start_displacements_[i] = state.displacements[static_cast<size_t>(nodes_[i])];
      start_[i] = Position(i, start_displacements_[i]);
      apex_ += start_[i];
    }
    apex_ /= static_cast<double>(nodes_.size());
    for (Double4& point : start_) point -= apex_;
  }

  double AddForces(const NodalVector& displacements, NodalVector& forces) override {
    if (pressure_ == 0) return 0;
    const double volume = Expand(displacements);
    FindVolumeGradient();
    for (size_t i = 0; i < nodes_.size(); ++i)
      forces[static_cast<size_t>(nodes_[i])] -= pressure_ * volume_gradient_[i];
    return pressure_ * volume;
  }

  void AddStiffness(const NodalVector& displacements, Curvature /*curvature*/,
                    NodeCouplings& couplings) override {
    if (pressure_ == 0) return;
    for (size_t i = 0; i < nodes_.size(); ++i)
      points_[i] = Position(i, displacements[static_cast<size_t>(nodes_[i])]) - apex_;
    for (const Side& side : sides_) {
      Double4 across = points_[static_cast<size_t>(side.left)];
      if (side.right >= 0) across -= points_[static_cast<size_t>(side.right)];
      const Double4 w = pressure_ / 6 * across;
      const Double4 columns[3] = {{0, -w[2], w[1], 0}, {w[2], 0, -w[0], 0}, {-w[1], w[0], 0, 0}};
      couplings.AddCoupling(nodes_[static_cast<size_t>(side.i)],
                            nodes_[static_cast<size_t>(side.j)], columns);
    }
  }

  // As for other loads, the force at the end over the way: backward Euler feels no other.
  NodeTermWork EndStep(const State& state) override {
    if (pressure_ == 0) return {};
    Expand(state.displacements);
    FindVolumeGradient();
    double work = 0;
    for (size_t i = 0; i < nodes_.size(); ++i)
      work -= pressure_ * Dot(volume_gradient_[i], moved_[i]);
    return {.external_work = work};
  }

 private:
  // An edge of live faces, i before j in the face whose third corner is `left`, j before i in that
  // of `right`; -1 where there is none, on the rim.
  struct Side {
    int32_t i, j, left, right;
  };
  static_assert(sizeof(Side) == kSideBytes);

  Double4 Position(size_t i, Double4 displacement) const {
    return ToDouble4(mesh_.rest_positions[static_cast<size_t>(nodes_[i])]) + displacement;
  }

  // Sets points_ and moved_; returns what the volume has gained since the start of the step, m^3,
  // less what its sides at the rim gained as they were pushed then. From differences: volumes may
  // be large against what they gain.
  double Expand(const NodalVector& displacements) {
    double six_volumes = 0;
    for (size_t i = 0; i < nodes_.size(); ++i) {
      moved_[i] = displacements[static_cast<size_t>(nodes_[i])] - start_displacements_[i];
      points_[i] = start_[i] + moved_[i];
    }
    for (const auto& face : faces_) {
      const auto a = static_cast<size_t>(face[0]), b = static_cast<size_t>(face[1]),
                 c = static_cast<size_t>(face[2]);
      six_volumes += Determinant(moved_[a], points_[b], points_[c]) +
                     Determinant(start_[a], moved_[b], points_[c]) +
                     Determinant(start_[a], start_[b], moved_[c]);
    }
    for (const Side& side : sides_) {
      if (side.right >= 0) continue;
      const auto i = static_cast<size_t>(side.i), j = static_cast<size_t>(side.j);
      six_volumes += Dot(Cross(start_[i], start_[j]), moved_[i] + moved_[j]);
    }
    return six_volumes / 6;
  }

  // At points_.
  void FindVolumeGradient() {
    std::fill(volume_gradient_.begin(), volume_gradient_.end(), Splat(0));
    for (const auto& face : faces_) {
      const Double4 a = points_[static_cast<size_t>(face[0])];
      const Double4 sixth = Cross(points_[static_cast<size_t>(face[1])] - a,
                                  points_[static_cast<size_t>(face[2])] - a) /
                            6;
      for (const int32_t corner : face) volume_gradient_[static_cast<size_t>(corner)] += sixth;
    }
    for (const Side& side : sides_) {
      if (side.right >= 0) continue;
      const auto i = static_cast<size_t>(side.i), j = static_cast<size_t>(side.j);
      const Double4 sixth = (Cross(start_[i], start_[j]) - Cross(points_[i], points_[j])) / 6;
      volume_gradient_[i] += sixth;
      volume_gradient_[j] += sixth;
    }
  }

  template <typename IsLive>
  void FindLive(const IsLive& is_live) {
    faces_.clear();
    struct Use {
      int32_t small, large, from, opposite;
    };
    std::vector<Use> uses;
    for (const BoundaryFace& face : all_faces_) {
      if (!is_live(face.tet)) continue;
      faces_.push_back(face.nodes);
      for (size_t k = 0; k < 3; ++k) {
        const int32_t from = face.nodes[k], to = face.nodes[(k + 1) % 3];
        uses.push_back({std::min(from, to), std::max(from, to), from, face.nodes[(k + 2) % 3]});
      }
    }
    std::stable_sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) {
      return std::pair(a.small, a.large) < std::pair(b.small, b.large);
    });
    // Where surfaces touch along an edge, more than two faces meet at it: those that turn each way
    // are paired in order.
    sides_.clear();
    for (auto use = uses.begin(); use != uses.end();) {
      auto after = use;
      std::vector<int32_t> up, down;
      for (; after != uses.end() && after->small == use->small && after->large == use->large;
           ++after)
        (after->from == after->small ? up : down).push_back(after->opposite);
      for (size_t k = 0; k < std::max(up.size(), down.size()); ++k) {
        if (k < up.size()) {
          sides_.push_back({use->small, use->large, up[k], k < down.size() ? down[k] : -1});
        } else {
          sides_.push_back({use->large, use->small, down[k], -1});
        }
      }
      use = after;
    }
    sides_.shrink_to_fit();
  }

  const double full_pressure_;  // Pa
  const TetMesh& mesh_;
  std::vector<int32_t> nodes_;           // of the faces, ascending; below, nodes are places in it
  std::vector<BoundaryFace> all_faces_;  // dead ones too
  std::vector<std::array<int32_t, 3>> faces_;
  std::vector<Side> sides_;
  double pressure_ = 0;              // Pa, in this step
  Double4 apex_ = Splat(0);          // m, the fixed point
  NodalVector start_;                // m, from apex_, at the start of the step
  NodalVector start_displacements_;  // m
  NodalVector points_;               // m, from apex_
  NodalVector moved_;                // m, since the start of the step
  NodalVector volume_gradient_;      // m^2
};

}  // namespace

double IntensityAt(const std::vector<LoadKeyframe>& keyframes, double time) {
  if (keyframes.empty()) return 1;
  const auto next =
      std::upper_bound(keyframes.begin(), keyframes.end(), time,
                       [](double t, const LoadKeyframe& keyframe) { return t < keyframe.time; });
  if (next == keyframes.begin()) return keyframes.front().intensity;
  if (next == keyframes.end()) return keyframes.back().intensity;
  const LoadKeyframe& from = *(next - 1);
  const double share = (time - from.time) / (next->time - from.time);
  return from.intensity + share * (next->intensity - from.intensity);
}

std::unique_ptr<NodeTerm> MakeLoadTerm(const Load& load, std::vector<int32_t> nodes,
                                       const TetMesh& mesh, const Incidence& incidence,
                                       int32_t release) {
  if (std::holds_alternative<SurfacePressure>(load.kind))
    return std::make_unique<PressureTerm>(load, nodes, mesh, release);
  return std::make_unique<DeadLoadTerm>(load, std::move(nodes), mesh, incidence, release);
}

int64_t LoadTermBytes(const Load& load, int64_t node_count) {
  const int64_t faces = 2 * node_count, sides = 3 * node_count;
  if (std::holds_alternative<PointForce>(load.kind)) return node_count * DeadLoadTerm::kNodeBytes;
  if (std::holds_alternative<SurfaceTraction>(load.kind))
    return node_count * DeadLoadTerm::kNodeBytes +
           faces * static_cast<int64_t>(sizeof(BoundaryFace));
  return node_count * PressureTerm::kNodeBytes + faces * PressureTerm::kFaceBytes +
         sides *
             (PressureTerm::kSideBytes + 2 * static_cast<int64_t>(sizeof(NodeCouplings::Entry)));
}

}  // namespace cleave
