#include "core/solver/rigid_steps.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "core/damage/components.h"

namespace cleave {
namespace {

// Axes about which a piece has less than this share of its largest moment of inertia have no spin:
// all of a lone node, that of two.
constexpr double kNoInertia = 1e-9;

Double4 Times(const Double4 columns[3], Double4 v) {
  return columns[0] * SplatLane<0>(v) + columns[1] * SplatLane<1>(v) + columns[2] * SplatLane<2>(v);
}

// rad/s, of a piece with this spin (kg m^2/s) and second moment of mass (kg m^2) about its centre.
Eigen::Vector3d AngularVelocity(Double4 spin, const Double4 moment[3]) {
  Eigen::Matrix3d inertia;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) inertia(row, column) = -moment[column][row];
  }
  inertia.diagonal().array() += moment[0][0] + moment[1][1] + moment[2][2];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(inertia);
  Eigen::Vector3d about =
      axes.eigenvectors().transpose() * Eigen::Vector3d(spin[0], spin[1], spin[2]);
  const double largest = axes.eigenvalues()[2];
  for (int axis = 0; axis < 3; ++axis) {
    const double of_axis = axes.eigenvalues()[axis];
    about[axis] = of_axis > kNoInertia * largest ? about[axis] / of_axis : 0;
  }
  return axes.eigenvectors() * about;
}

}  // namespace

RigidSteps::RigidSteps(const Model& model) : model_(model), ways_(model.masses.size(), Splat(0)) {
  SetBroken(std::vector<uint8_t>(static_cast<size_t>(model.incidence->edge_count()), 0));
}

void RigidSteps::SetBroken(std::span<const uint8_t> broken) {
  pieces_.resize(static_cast<size_t>(LabelComponents(*model_.incidence, broken, labels_)));
}

void RigidSteps::BeginStep(const State& start, double dt) {
  const auto position = [&](size_t node) {
    return ToDouble4(model_.mesh->rest_positions[node]) + start.displacements[node];
  };
  const auto for_each_node = [&](const auto& body) {
    for (size_t node = 0; node < labels_.size(); ++node) {
      if (labels_[node] >= 0) body(node, pieces_[static_cast<size_t>(labels_[node])]);
    }
  };
  for (Piece& piece : pieces_) piece = Piece{};
  for_each_node([&](size_t node, Piece& piece) {
    const double mass = model_.masses[node];
    piece.mass += mass;
    piece.center += mass * position(node);
    piece.velocity += mass * start.velocities[node];
  });
  for (Piece& piece : pieces_) {
    piece.center = piece.center / piece.mass;
    piece.velocity = piece.velocity / piece.mass;
  }
  for_each_node([&](size_t node, Piece& piece) {
    const double mass = model_.masses[node];
    const Double4 arm = position(node) - piece.center;
    piece.spin += mass * Cross(arm, start.velocities[node] - piece.velocity);
    for (int axis = 0; axis < 3; ++axis) piece.columns[axis] += mass * arm[axis] * arm;
  });
  for (Piece& piece : pieces_) {
    const Eigen::Vector3d turn = dt * AngularVelocity(piece.spin, piece.columns);
    const Eigen::AngleAxisd rotation(turn.norm(), turn.stableNormalized());
    const Eigen::Matrix3d turned = rotation.toRotationMatrix() - Eigen::Matrix3d::Identity();
    for (int axis = 0; axis < 3; ++axis)
      piece.columns[axis] = Double4{turned(0, axis), turned(1, axis), turned(2, axis), 0};
  }
  for_each_node([&](size_t node, const Piece& piece) {
    ways_[node] = dt * piece.velocity + Times(piece.columns, position(node) - piece.center);
  });
}

int64_t RigidSteps::bytes() const {
  return static_cast<int64_t>(labels_.size() * sizeof(int32_t) + ways_.size() * sizeof(Double4) +
                              pieces_.size() * sizeof(Piece));
}

}  // namespace cleave
