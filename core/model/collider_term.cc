#include "core/model/collider_term.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/contact/friction_spring.h"

namespace cleave {
namespace {

// A collider may turn this much in a part of a step: its points then move nearly straight.
constexpr double kMostTurn = 0.25;  // rad

// Gaps are differences of positions, which carry about one rounding each.
constexpr double kPositionRounding = 2e-16;

Eigen::Vector3d ToEigen(const Vec3& v) { return {v[0], v[1], v[2]}; }
Eigen::Vector3d ToEigen(Double4 v) { return {v[0], v[1], v[2]}; }
Double4 ToLanes(const Eigen::Vector3d& v) { return Double4{v[0], v[1], v[2], 0}; }

// The part of a vector across a unit normal.
Eigen::Vector3d Across(const Eigen::Vector3d& v, const Eigen::Vector3d& normal) {
  return v - normal * normal.dot(v);
}

void Split(const Eigen::Matrix3d& matrix, Double4 columns[3]) {
  for (int k = 0; k < 3; ++k) columns[k] = ToLanes(matrix.col(k));
}

PrescribedMotion MotionOf(const Collider& collider) {
  PrescribedMotion motion;
  motion.keyframes = collider.keyframes;
  motion.center = ToDouble4(collider.rotation_center);
  motion.axis = ToLanes(ToEigen(collider.rotation_axis).normalized());
  return motion;
}

}  // namespace

ColliderTerm::ColliderTerm(const Scene& scene, std::vector<double> stiffness, Model& model)
    : mesh_(*model.mesh),
      mean_edge_length_(model.mean_edge_length),
      node_stiffness_(std::move(stiffness)),
      gravity_(scene.gravity ? ToEigen(*scene.gravity) : Vector(Vector::Zero())) {
  for (size_t node = 0; node < model.masses.size(); ++node) {
    if (model.masses[node] > 0) nodes_.push_back(static_cast<int32_t>(node));
  }
  for (const Collider& collider : scene.colliders) {
    Part part{ShapeDistance(collider.shape),
              MotionOf(collider),
              std::nullopt,
              collider.friction,
              collider.stiffness,
              collider.margin};
    if (collider.body) {
      Body& body = part.body.emplace();
      body.mass = MassOf(collider.shape, *collider.body);
      body.unknown = model.masses.size();
      body.scale = (body.mass.moments / body.mass.mass).cwiseSqrt();
      body.velocity = ToEigen(collider.body->velocity);
      body.spin = ToEigen(collider.body->angular_velocity);
      model.masses.insert(model.masses.end(), 2, body.mass.mass);
      turns_.push_back(Eigen::Quaterniond::Identity());
    }
    parts_.push_back(std::move(part));
  }
  start_poses_.resize(parts_.size());
  end_poses_.resize(parts_.size());
}

void ColliderTerm::Start(State& state) const {
  for (const Part& part : parts_) {
    if (!part.body) continue;
    const Body& body = *part.body;
    state.velocities[body.unknown] = ToLanes(body.velocity);
    state.velocities[body.unknown + 1] =
        ToLanes(body.scale.cwiseProduct(body.mass.axes.transpose() * body.spin));
  }
}

ColliderTerm::Pose ColliderTerm::StartPose(size_t collider, double time,
                                           const NodalVector& displacements) const {
  const Part& part = parts_[collider];
  Pose pose;
  if (part.body) {
    const size_t index = static_cast<size_t>(
        std::count_if(parts_.begin(), parts_.begin() + static_cast<std::ptrdiff_t>(collider),
                      [](const Part& p) { return p.body.has_value(); }));
    pose.turn = turns_[index].toRotationMatrix();
    pose.from = part.body->mass.center;
    pose.to = pose.from + ToEigen(displacements[part.body->unknown]);
    pose.change = pose.turn * part.body->mass.axes * part.body->scale.cwiseInverse().asDiagonal();
  } else if (!part.motion.keyframes.empty()) {
    const Keyframe at = PoseAt(part.motion, time);
    pose.turn = RotationBy(at.rotation * ToEigen(part.motion.axis));
    pose.from = ToEigen(part.motion.center);
    pose.to = pose.from + ToEigen(at.translation);
  }
  return pose;
}

ColliderTerm::Pose ColliderTerm::TrialPose(size_t collider,
                                           const NodalVector& displacements) const {
  const Part& part = parts_[collider];
  if (!part.body) return end_poses_[collider];
  const Pose& start = start_poses_[collider];
  Pose pose = start;
  pose.to = start.from + ToEigen(displacements[part.body->unknown]);
  const Vector turn = start.change * ToEigen(displacements[part.body->unknown + 1]);
  pose.turn = RotationBy(turn) * start.turn;
  pose.change = RotationChange(turn) * start.change;
  return pose;
}

std::vector<ColliderPose> ColliderTerm::Poses(double time, const State& state) const {
  std::vector<ColliderPose> poses;
  for (size_t c = 0; c < parts_.size(); ++c) {
    const Pose pose = StartPose(c, time, state.displacements);
    poses.push_back({Eigen::Quaterniond(pose.turn), pose.from, pose.to});
  }
  return poses;
}

ColliderTerm::Vector ColliderTerm::PointOf(int32_t node, const NodalVector& displacements) const {
  const auto n = static_cast<size_t>(node);
  return ToEigen(mesh_.rest_positions[n]) + ToEigen(displacements[n]);
}

ColliderTerm::Normal ColliderTerm::Press(double stiffness, double gap) const {
  if (gap >= 0) return {0, 0, 0};
  const double deepest = mean_edge_length_;
  if (gap > -deepest) return {0.5 * stiffness * gap * gap, -stiffness * gap, stiffness};
  return {stiffness * deepest * (-gap - 0.5 * deepest), stiffness * deepest, 0};
}

template <typename Found>
void ColliderTerm::ForNearNodes(size_t collider, const Pose& start, const Pose& end, double dt,
                                const State& state, const Found& found) const {
  const Part& part = parts_[collider];
  const Vector middle = start.Apply(part.shape.center());
  const Vector velocity =
      part.body ? ToEigen(state.velocities[part.body->unknown]) : Vector(Vector::Zero());
  const Vector spin = part.body
                          ? Vector(start.change * ToEigen(state.velocities[part.body->unknown + 1]))
                          : Vector(Vector::Zero());
  for (const int32_t node : nodes_) {
    const auto n = static_cast<size_t>(node);
    const Vector point = PointOf(node, state.displacements);
    const Vector local = start.Invert(point);
    const Vector surface = part.body ? Vector(velocity + spin.cross(point - start.to))
                                     : Vector((end.Apply(local) - point) / dt);
    const Vector relative = ToEigen(state.velocities[n]) - surface;
    const double reach =
        part.margin + mean_edge_length_ + 2 * dt * (relative.norm() + dt * gravity_.norm());
    if ((point - middle).norm() > part.shape.radius() + reach) continue;
    SignedDistance distance = part.shape.At(local);
    distance.value -= part.margin;
    distance.normal = start.turn * distance.normal;
    if (distance.value + part.margin < reach) found(node, local, distance, relative);
  }
}

double ColliderTerm::LongestPart(double start, double end, const State& state) const {
  const double dt = end - start;
  double longest = dt;
  for (size_t c = 0; c < parts_.size(); ++c) {
    const Pose from = StartPose(c, start, state.displacements);
    const Pose to = parts_[c].body ? from : StartPose(c, end, state.displacements);
    double turn = 0;
    if (parts_[c].body) {
      turn = dt * (from.change * ToEigen(state.velocities[parts_[c].body->unknown + 1])).norm();
    } else if (!parts_[c].motion.keyframes.empty()) {
      turn = std::abs(PoseAt(parts_[c].motion, end).rotation -
                      PoseAt(parts_[c].motion, start).rotation);
    }
    if (turn > kMostTurn) longest = std::min(longest, dt * kMostTurn / turn);
    const double furthest =
        0.5 * std::min(mean_edge_length_, parts_[c].shape.depth() + parts_[c].margin);
    ForNearNodes(
        c, from, to, dt, state,
        [&](int32_t, const Vector&, const SignedDistance& distance, const Vector& relative) {
          const double closing = -relative.dot(distance.normal);
          if (closing * dt > furthest && distance.value < closing * dt)
            longest = std::min(longest, furthest / closing);
        });
  }
  return longest;
}

void ColliderTerm::BeginStep(double start, double end, const State& state) {
  end_ = end;
  start_displacements_ = state.displacements;
  candidates_.clear();
  auto touch = touches_.begin();
  for (size_t c = 0; c < parts_.size(); ++c) {
    const Part& part = parts_[c];
    start_poses_[c] = StartPose(c, start, state.displacements);
    end_poses_[c] = part.body ? start_poses_[c] : StartPose(c, end, state.displacements);
    const auto collider = static_cast<int32_t>(c);
    ForNearNodes(
        c, start_poses_[c], end_poses_[c], end - start, state,
        [&](int32_t node, const Vector& local, const SignedDistance& distance, const Vector&) {
          const double modulus =
              node_stiffness_[node_stiffness_.size() == 1 ? 0 : static_cast<size_t>(node)];
          Candidate candidate{collider, node, part.stiffness * modulus, 0, distance.normal,
                              local,    local};
          while (touch != touches_.end() &&
                 std::pair(touch->collider, touch->node) < std::pair(collider, node)) {
            ++touch;
          }
          if (touch != touches_.end() && touch->collider == collider && touch->node == node) {
            candidate.friction_cap = part.friction * touch->normal_force;
            candidate.anchor = ToEigen(touch->anchor);
          }
          candidates_.push_back(candidate);
        });
  }
}

void ColliderTerm::AddInfluences(std::vector<Influence>& influences) const {
  for (const Candidate& candidate : candidates_) {
    const auto c = static_cast<size_t>(candidate.collider);
    if (parts_[c].body) {
      influences.push_back({candidate.node, static_cast<int32_t>(parts_[c].body->unknown)});
    } else if (start_poses_[c].turn != end_poses_[c].turn ||
               start_poses_[c].to != end_poses_[c].to) {
      influences.push_back({candidate.node, -1});
    }
  }
}

double ColliderTerm::AddForces(const NodalVector& displacements, NodalVector& forces) {
  double energy = 0;
  auto candidate = candidates_.begin();
  for (size_t c = 0; c < parts_.size(); ++c) {
    const Part& part = parts_[c];
    const Pose pose = TrialPose(c, displacements);
    Vector force = Vector::Zero(), torque = Vector::Zero();  // on the collider
    for (; candidate != candidates_.end() && candidate->collider == static_cast<int32_t>(c);
         ++candidate) {
      const Vector point = PointOf(candidate->node, displacements);
      const SignedDistance distance = part.shape.At(pose.Invert(point));
      const Normal press = Press(candidate->stiffness, distance.value - part.margin);
      Vector push = Vector::Zero();
      if (press.force > 0) {
        energy += press.energy;
        push = press.force * (pose.turn * distance.normal);
        torque -= (point - pose.to).cross(push);
      }
      if (candidate->friction_cap > 0) {
        const Vector anchor = pose.Apply(candidate->anchor);
        const FrictionSpring friction{candidate->stiffness, candidate->friction_cap};
        const Vector stretch = Across(point - anchor, candidate->normal);
        energy += friction.Energy(stretch.norm());
        const Vector drag = friction.Force(stretch);
        push += drag;
        torque -= (anchor - pose.to).cross(drag);
      }
      forces[static_cast<size_t>(candidate->node)] += ToLanes(push);
      force -= push;
    }
    if (!part.body) continue;
    const size_t unknown = part.body->unknown;
    // Gravity pulls at every unknown alike, but does not turn a body.
    const Vector weight = part.body->mass.mass * gravity_;
    energy += weight.dot(ToEigen(displacements[unknown + 1]));
    forces[unknown] += ToLanes(force);
    forces[unknown + 1] += ToLanes(pose.change.transpose() * torque - weight);
  }
  return energy;
}

void ColliderTerm::AddSpring(const Candidate& candidate, const Pose& pose, const Matrix& spring,
                             const Vector& arm, NodeCouplings& couplings) const {
  Double4 block[3];
  Split(spring, block);
  const std::optional<Body>& body = parts_[static_cast<size_t>(candidate.collider)].body;
  if (!body) {
    couplings.AddNode(candidate.node, block);
    return;
  }
  const auto center = static_cast<int32_t>(body->unknown);
  couplings.AddSpring(candidate.node, center, block);
  // The stretch changes by dx - dt + arm x (change d) for a change d of the turn.
  const Matrix lever = CrossMatrix(arm) * pose.change;
  Split(spring * lever, block);
  couplings.AddCoupling(candidate.node, center + 1, block);
  Split(-spring * lever, block);
  couplings.AddCoupling(center, center + 1, block);
  Split(lever.transpose() * spring * lever, block);
  couplings.AddNode(center + 1, block);
}

void ColliderTerm::AddStiffness(const NodalVector& displacements, Curvature curvature,
                                NodeCouplings& couplings) {
  auto candidate = candidates_.begin();
  for (size_t c = 0; c < parts_.size(); ++c) {
    const Part& part = parts_[c];
    const Pose pose = TrialPose(c, displacements);
    for (; candidate != candidates_.end() && candidate->collider == static_cast<int32_t>(c);
         ++candidate) {
      const Vector point = PointOf(candidate->node, displacements);
      const SignedDistance distance = part.shape.At(pose.Invert(point));
      const Normal press = Press(candidate->stiffness, distance.value - part.margin);
      if (press.slope > 0) {
        const Vector normal = pose.turn * distance.normal;
        AddSpring(*candidate, pose, press.slope * normal * normal.transpose(), point - pose.to,
                  couplings);
      }
      if (candidate->friction_cap > 0) {
        const Vector anchor = pose.Apply(candidate->anchor);
        const FrictionSpring friction{candidate->stiffness, candidate->friction_cap};
        const Vector stretch = Across(point - anchor, candidate->normal);
        const Matrix spring = curvature == Curvature::kExact
                                  ? friction.ExactStiffness(stretch, candidate->normal)
                                  : friction.Stiffness(stretch, candidate->normal);
        AddSpring(*candidate, pose, spring, anchor - pose.to, couplings);
      }
    }
  }
}

double ColliderTerm::RoundingForce(const NodalVector& displacements) const {
  double squares = 0;
  for (const Candidate& candidate : candidates_) {
    const Pose& pose = start_poses_[static_cast<size_t>(candidate.collider)];
    const double size = PointOf(candidate.node, displacements).norm() + pose.from.norm() +
                        pose.to.norm() + mean_edge_length_;
    squares += candidate.stiffness * candidate.stiffness * size * size;
  }
  return kPositionRounding * std::sqrt(squares);
}

NodeTermWork ColliderTerm::EndStep(const State& state) {
  NodeTermWork work;
  touches_.clear();
  scratch_forces_.assign(state.displacements.size(), Splat(0));
  AddForces(state.displacements, scratch_forces_);
  double done = 0;  // J, on the unknowns
  for (size_t n = 0; n < scratch_forces_.size(); ++n) {
    done += Dot(scratch_forces_[n], state.displacements[n] - start_displacements_[n]);
  }
  for (const Candidate& candidate : candidates_) {
    const auto c = static_cast<size_t>(candidate.collider);
    const Part& part = parts_[c];
    const Pose pose = TrialPose(c, state.displacements);
    const Vector point = PointOf(candidate.node, state.displacements);
    const Vector local = pose.Invert(point);
    const SignedDistance distance = part.shape.At(local);
    const Normal press = Press(candidate.stiffness, distance.value - part.margin);
    const Vector normal = pose.turn * distance.normal;
    work.stored_energy += press.energy;
    Vector push = press.force * normal;
    Vector kept = Vector::Zero();  // stretch of the friction spring
    if (candidate.friction_cap > 0) {
      const FrictionSpring friction{candidate.stiffness, candidate.friction_cap};
      const Vector stretch = Across(point - pose.Apply(candidate.anchor), candidate.normal);
      push += friction.Force(stretch);
      kept = Across(friction.Kept(stretch, part.friction * press.force), normal);
      const double stored = 0.5 * friction.stiffness * kept.squaredNorm();
      work.stored_energy += stored;
      work.dissipation += friction.Energy(stretch.norm()) - stored;
    }
    if (!part.body) {
      work.external_work += push.dot(pose.Apply(local) - start_poses_[c].Apply(local));
    }
    if (press.force <= 0 || part.friction == 0) continue;
    const Vector anchor = pose.Invert(point - kept);
    touches_.push_back(
        {candidate.collider, candidate.node, press.force, {anchor[0], anchor[1], anchor[2]}});
  }
  // Gravity's work counts the turns of bodies too.
  for (const Part& part : parts_) {
    if (!part.body) continue;
    work.external_work -=
        part.body->mass.mass * gravity_.dot(ToEigen(state.displacements[part.body->unknown + 1]));
  }
  work.integration =
      work.external_work - done - (work.stored_energy - stored_energy_) - work.dissipation;
  stored_energy_ = work.stored_energy;
  return work;
}

void ColliderTerm::Renew(State& state) {
  size_t index = 0;
  for (size_t c = 0; c < parts_.size(); ++c) {
    if (!parts_[c].body) continue;
    const Body& body = *parts_[c].body;
    const Pose pose = TrialPose(c, state.displacements);
    // Angular momentum about the centre stays while the axes turn with the body.
    const Vector momentum =
        start_poses_[c].turn * body.mass.axes *
        (body.mass.moments.cwiseProduct(
            ToEigen(state.velocities[body.unknown + 1]).cwiseQuotient(body.scale)));
    const Vector spin = (pose.turn * body.mass.axes).transpose() * momentum;
    state.velocities[body.unknown + 1] =
        ToLanes(body.scale.cwiseProduct(spin.cwiseQuotient(body.mass.moments)));
    // What has not turned keeps its bits.
    const bool turned =
        Dot(state.displacements[body.unknown + 1], state.displacements[body.unknown + 1]) > 0;
    if (turned) turns_[index] = Eigen::Quaterniond(pose.turn).normalized();
    state.displacements[body.unknown + 1] = Splat(0);
    ++index;
  }
}

void ColliderTerm::Save(ByteWriter& out) const {
  out.PutVector(touches_);
  for (const Eigen::Quaterniond& turn : turns_) {
    for (int k = 0; k < 4; ++k) out.Put(turn.coeffs()[k]);
  }
  out.Put(stored_energy_);
}

absl::Status ColliderTerm::Restore(ByteReader& in) {
  std::vector<Touch> touches = in.GetVector<Touch>();
  std::vector<Eigen::Quaterniond> turns(turns_.size());
  for (Eigen::Quaterniond& turn : turns) {
    for (int k = 0; k < 4; ++k) turn.coeffs()[k] = in.Get<double>();
  }
  const auto stored_energy = in.Get<double>();
  if (!in.ok()) return absl::DataLossError("the saved state of colliders is truncated");
  for (const Touch& touch : touches) {
    if (touch.collider < 0 || touch.collider >= static_cast<int32_t>(parts_.size()) ||
        touch.node < 0 || touch.node >= mesh_.node_count())
      return absl::DataLossError("the saved state of colliders is of another scene");
  }
  touches_ = std::move(touches);
  turns_ = std::move(turns);
  stored_energy_ = stored_energy;
  return absl::OkStatus();
}

int64_t ColliderTerm::BytesPerNode() {
  return static_cast<int64_t>(sizeof(Candidate) + sizeof(Touch) + 2 * sizeof(Double4) +
                              sizeof(int32_t));
}

int64_t ColliderTerm::BytesOf(size_t keyframes, size_t triangles) {
  return static_cast<int64_t>(sizeof(Part) + 2 * sizeof(Pose) + keyframes * sizeof(Keyframe)) +
         SurfaceDistance::BytesOf(triangles);
}

int64_t ColliderTerm::bytes() const {
  auto bytes = static_cast<int64_t>(
      node_stiffness_.size() * sizeof(double) + nodes_.size() * sizeof(int32_t) +
      candidates_.capacity() * sizeof(Candidate) + touches_.capacity() * sizeof(Touch) +
      (start_displacements_.capacity() + scratch_forces_.capacity()) * sizeof(Double4));
  for (const Part& part : parts_) {
    bytes += BytesOf(part.motion.keyframes.size(), 0) + part.shape.bytes() -
             static_cast<int64_t>(sizeof(ShapeDistance));
  }
  return bytes;
}

}  // namespace cleave
