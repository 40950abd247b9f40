#include "core/probe/pulled_bar.h"

#include <Eigen/Dense>
#include <cmath>

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMostSteps = 100;
constexpr int kMostFlows = 100;
constexpr double kLeastFlow = 1e-12;  // relative growth of plastic strain that ends the repetition

// Entries of the deformation gradient in the frame of the bar that the sides leave free. The first
// column is the stretch, and one entry below the diagonal stays 0: it would only turn the bar about
// itself. Balance of momentum then frees the last one of stress too.
constexpr std::array<std::pair<int, int>, 5> kFreeEntries = {
    {{0, 1}, {1, 1}, {0, 2}, {1, 2}, {2, 2}}};

}  // namespace

PulledBar::PulledBar(const MaterialPoint& point, const Vector3d& direction) : point_(point) {
  frame_.col(0) = direction;
  frame_.col(1) = direction.unitOrthogonal();
  frame_.col(2) = direction.cross(frame_.col(1));
}

Matrix3d PulledBar::Turned(const Matrix3d& matrix) const {
  return frame_.transpose() * matrix * frame_;
}

PulledBar::Curvature PulledBar::CurvatureAt(const State& state, Unknowns* with_strain,
                                            double* of_strain) const {
  const Matrix9d tangent = point_.Tangent(state.g, state.plastic);
  // The change of P, in the frame, with entry (row, column) of F there.
  const auto changed = [&](int row, int column) {
    const Matrix3d change = frame_.col(row) * frame_.col(column).transpose();
    Matrix3d stress;
    for (int k = 0; k < 9; ++k) {
      double sum = 0;
      for (int l = 0; l < 9; ++l) sum += tangent(k, l) * change(l / 3, l % 3);
      stress(k / 3, k % 3) = sum;
    }
    return Turned(stress);
  };
  Curvature curvature;
  for (int column = 0; column < kFree; ++column) {
    const auto [i, j] = kFreeEntries[static_cast<size_t>(column)];
    const Matrix3d stress = changed(i, j);
    for (int row = 0; row < kFree; ++row) {
      const auto [k, l] = kFreeEntries[static_cast<size_t>(row)];
      curvature(row, column) = stress(k, l);
    }
  }
  if (with_strain != nullptr) {
    const Matrix3d stress = changed(0, 0);
    for (int row = 0; row < kFree; ++row) {
      const auto [k, l] = kFreeEntries[static_cast<size_t>(row)];
      (*with_strain)(row) = stress(k, l);
    }
    *of_strain = stress(0, 0);
  }
  return curvature;
}

double PulledBar::YoungsModulus() const {
  Unknowns coupling;
  double axial = 0;
  const Curvature free = CurvatureAt(AtRest(), &coupling, &axial);
  return axial - coupling.dot(free.ldlt().solve(coupling));
}

PulledBar::State PulledBar::AtRest() const {
  State state;
  state.response = point_.Respond(state.g);
  return state;
}

std::optional<PulledBar::State> PulledBar::Pull(double strain, const State& near) const {
  if (strain == 0) return AtRest();
  std::optional<State> state = Rest(strain, near);
  // Flow at a fixed deformation relaxes the bar too little, so it is repeated.
  for (int flow = 0; flow < kMostFlows && state.has_value(); ++flow) {
    const double before = state->plastic.strain;
    if (!point_.Flow(state->g, state->plastic)) return state;
    state = Rest(strain, *state);
    if (state.has_value() && state->plastic.strain - before <= kLeastFlow * state->plastic.strain)
      return state;
  }
  return std::nullopt;
}

std::optional<PulledBar::State> PulledBar::Rest(double strain, const State& near) const {
  const auto state_at = [&](const Matrix3d& in_frame) {
    State state;
    state.strain = strain;
    state.g = frame_ * in_frame * frame_.transpose();
    state.plastic = near.plastic;
    state.response = point_.Respond(state.g, state.plastic);
    return state;
  };
  const auto residual_of = [&](const State& state) {
    const Matrix3d stress = Turned(state.response.stress);
    Unknowns residual;
    for (int k = 0; k < kFree; ++k) {
      const auto [i, j] = kFreeEntries[static_cast<size_t>(k)];
      residual(k) = stress(i, j);
    }
    return residual;
  };
  const auto axial_of = [&](const State& state) { return Turned(state.response.stress)(0, 0); };

  Matrix3d at = Turned(near.g);
  at.col(0) = Vector3d(strain, 0, 0);
  at(2, 1) = 0;
  State state = state_at(at);
  Unknowns residual = residual_of(state);
  for (int step = 0; step < kMostSteps; ++step) {
    if (residual.norm() <= 1e-12 * std::abs(axial_of(state))) break;
    // Newton on the nearest definite curvature, so that each step leads downhill.
    const Eigen::SelfAdjointEigenSolver<Curvature> modes(CurvatureAt(state, nullptr, nullptr));
    const double stiffest = modes.eigenvalues().cwiseAbs().maxCoeff();
    const Unknowns stiffness = modes.eigenvalues().cwiseAbs().cwiseMax(1e-9 * stiffest);
    const Unknowns change =
        -(modes.eigenvectors() *
          (modes.eigenvectors().transpose() * residual).cwiseQuotient(stiffness));
    bool moved = false;
    for (double share = 1; share > 1e-10 && !moved; share /= 2) {
      Matrix3d next = at;
      for (int k = 0; k < kFree; ++k) {
        const auto [i, j] = kFreeEntries[static_cast<size_t>(k)];
        next(i, j) += share * change(k);
      }
      const State tried = state_at(next);
      const Unknowns left = residual_of(tried);
      const double fall = state.response.energy - tried.response.energy;
      // Close to the solution energies are equal to rounding, and the residual decides.
      const bool level = std::abs(fall) <= 1e-12 * state.response.energy;
      moved =
          fall >= -1e-4 * share * change.dot(residual) || (level && left.norm() < residual.norm());
      if (!moved) continue;
      at = next;
      state = tried;
      residual = left;
    }
    if (!moved) break;
  }
  if (!(residual.norm() <= 1e-7 * std::abs(axial_of(state)))) return std::nullopt;
  state.nominal_stress = axial_of(state);
  state.volume_ratio = (Matrix3d::Identity() + state.g).determinant();
  return state;
}

}  // namespace cleave
