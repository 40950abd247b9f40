#include "core/probe/material_point.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>

#include "core/base/double4.h"
#include "core/base/matrix3.h"
#include "core/material/corotated_linear.h"
#include "core/material/fibre.h"
#include "core/material/incremental_potential.h"
#include "core/material/invertible_neo_hookean.h"
#include "core/material/isotropic_stiffness.h"
#include "core/material/plasticity.h"
#include "core/material/st_venant_kirchhoff.h"
#include "core/material/stable_neo_hookean.h"

namespace cleave {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// The laws work on four tets at once; all four lanes are this point.
Matrix3<Double4> Batched(const Matrix3d& matrix) {
  Matrix3<Double4> batch;
  for (int k = 0; k < 9; ++k) batch(k / 3, k % 3) = Splat(matrix(k / 3, k % 3));
  return batch;
}
Matrix3d FirstLane(const Matrix3<Double4>& batch) {
  Matrix3d matrix;
  for (int k = 0; k < 9; ++k) matrix(k / 3, k % 3) = batch(k / 3, k % 3)[0];
  return matrix;
}

// What `visit` makes of the law as a value of its type.
template <typename Visit>
auto WithLaw(ElasticLaw law, const Visit& visit) {
  switch (law) {
    case ElasticLaw::kInvertibleNeoHookean:
      return visit(InvertibleNeoHookean());
    case ElasticLaw::kCorotatedLinear:
      return visit(CorotatedLinear());
    case ElasticLaw::kStVenantKirchhoff:
      return visit(StVenantKirchhoff());
    case ElasticLaw::kStableNeoHookean:
      break;
  }
  return visit(StableNeoHookean());
}

FibreStretch<Double4> Stretched(const Matrix3d& g, const Vector3d& direction) {
  const Vector3d ga = g * direction;
  Double4 a[3], change[3];
  for (int i = 0; i < 3; ++i) {
    a[i] = Splat(direction[i]);
    change[i] = Splat(ga[i]);
  }
  const bool inverted = (g + Matrix3d::Identity()).determinant() < 0;
  Double4 sign = Splat(1);
  if (inverted) sign = FibreSign(ComputeSvd(Batched(g)), a);
  FibreStretch<Double4> fibre = StretchFibre(a, change, sign);
  if (Any(IsCollapsed(fibre))) SetCollapsedDirection(ComputeSvd(Batched(g)), a, fibre);
  return fibre;
}

Vector3d DirectionOf(const FibreStretch<Double4>& fibre) {
  return {fibre.direction[0][0], fibre.direction[1][0], fibre.direction[2][0]};
}

// The change of P that a change of F brings, from the spectrum in the frame of the singular values.
Matrix3d Turned(const SignedSvd<Double4>& svd, const StiffnessSpectrum<Double4>& spectrum,
                const Matrix3d& change) {
  const Matrix3d u = FirstLane(svd.u), v = FirstLane(svd.v);
  const Matrix3d in_frame = u.transpose() * change * v;
  Matrix3d answer = Matrix3d::Zero();
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) answer(k, k) += spectrum.axial[k][i][0] * in_frame(i, i);
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const double even = 0.5 * spectrum.symmetric[k][0] * (in_frame(i, j) + in_frame(j, i));
    const double odd = 0.5 * spectrum.skew[k][0] * (in_frame(i, j) - in_frame(j, i));
    answer(i, j) = even + odd;
    answer(j, i) = even - odd;
  }
  return u * answer * v.transpose();
}

}  // namespace

MaterialPoint::MaterialPoint(const Material& material, std::span<const Vec3> fibre_directions)
    : law_(material.law),
      lame_(ToLame(material.youngs_modulus, material.poisson_ratio)),
      plasticity_(material.plasticity) {
  for (size_t k = 0; k < material.fibres.size(); ++k) {
    const Vector3d direction(fibre_directions[k].data());
    fibres_.push_back({(direction / direction.cwiseAbs().maxCoeff()).normalized(),
                       material.fibres[k].stiffness, material.fibres[k].strength_ratio});
  }
}

PointResponse MaterialPoint::Respond(const Matrix3d& g, const PlasticState& plastic) const {
  const Matrix3d elastic = ElasticChange(g, plastic);
  PointResponse response;
  const LameConstants<Double4> lame{Splat(lame_.mu), Splat(lame_.lambda)};
  const Matrix3<Double4> batch = Batched(elastic);
  WithLaw(law_, [&]<typename Law>(Law) {
    const auto kinematics = Law::KinematicsOf(batch);
    response.energy = Law::Energy(batch, kinematics, lame)[0];
    response.matrix_stress = FirstLane(Law::Stress(batch, kinematics, lame));
  });
  response.elastic_stress = response.matrix_stress;
  for (const Fibre& family : fibres_) {
    if (family.stiffness == 0) continue;
    const FibreStretch<Double4> fibre = Stretched(elastic, family.direction);
    const double excess = fibre.excess[0];
    response.energy += 0.5 * family.stiffness * excess * excess;
    response.elastic_stress +=
        family.stiffness * excess * DirectionOf(fibre) * family.direction.transpose();
  }
  response.stress =
      response.elastic_stress + response.elastic_stress * plastic.inverse_change.transpose();
  return response;
}

Matrix9d MaterialPoint::Tangent(const Matrix3d& g, const PlasticState& plastic) const {
  const Matrix3d elastic = ElasticChange(g, plastic);
  const LameConstants<Double4> lame{Splat(lame_.mu), Splat(lame_.lambda)};
  const SignedSvd<Double4> svd = ComputeSvd(Batched(elastic));
  const StiffnessSpectrum spectrum =
      WithLaw(law_, [&]<typename Law>(Law) { return Law::Spectrum(svd, lame); });
  Matrix9d tangent;
  for (int column = 0; column < 9; ++column) {
    Matrix3d change = Matrix3d::Zero();
    change(column / 3, column % 3) = 1;
    const Matrix3d answer = Turned(svd, spectrum, change);
    for (int row = 0; row < 9; ++row) tangent(row, column) = answer(row / 3, row % 3);
  }
  for (const Fibre& family : fibres_) {
    if (family.stiffness == 0) continue;
    const FibreStretch<Double4> fibre = Stretched(elastic, family.direction);
    const double across = FibreStiffnessAcross(fibre)[0];
    const Vector3d along = DirectionOf(fibre);
    const Matrix3d block = family.stiffness * ((1 - across) * along * along.transpose() +
                                               across * Matrix3d::Identity());
    const Vector3d& a = family.direction;
    for (int row = 0; row < 9; ++row) {
      for (int column = 0; column < 9; ++column)
        tangent(row, column) += block(row / 3, column / 3) * a[row % 3] * a[column % 3];
    }
  }
  if (plastic.strain == 0) return tangent;
  // P = P_e F_p^-T and F_e = F F_p^-1.
  const Matrix3d inverse = Matrix3d::Identity() + plastic.inverse_change;
  Matrix9d turn = Matrix9d::Zero();
  for (int i = 0; i < 3; ++i) turn.block<3, 3>(3 * i, 3 * i) = inverse;
  return turn * tangent * turn.transpose();
}

bool MaterialPoint::Flow(const Matrix3d& g, PlasticState& plastic) const {
  if (!plasticity_.has_value()) return false;
  const LameConstants<Double4> lame{Splat(lame_.mu), Splat(lame_.lambda)};
  const FlowRule<Double4> rule{Splat(plasticity_->yield_stress), Splat(plasticity_->hardening),
                               Splat(std::numeric_limits<double>::infinity())};
  const auto svd = ComputeSvd(Batched(ElasticChange(g, plastic)));
  Double4 log_flow[3];
  const double strain = WithLaw(law_, [&]<typename Law>(Law) {
    const StepFlow<Law> flow =
        FindStepFlow<Law>(svd.strain, lame, rule, Splat(plastic.strain), Int64x4{-1, -1, -1, -1});
    std::copy(flow.log_flow, flow.log_flow + 3, log_flow);
    return flow.strain[0];
  });
  if (!(strain > 0)) return false;
  const Matrix3<Double4> inverse_change =
      FlowedInverse(Batched(plastic.inverse_change), FlowChange(svd.v, log_flow));
  if (IsWithinPlasticRatio(inverse_change)[0] == 0) return false;
  plastic.inverse_change = FirstLane(inverse_change);
  plastic.strain += strain;
  return true;
}

double MaterialPoint::FlowWork(double plastic_strain) const {
  if (!plasticity_.has_value()) return 0;
  const FlowRule<double> rule{plasticity_->yield_stress, plasticity_->hardening, 0};
  return rule.Work(0, plastic_strain);
}

}  // namespace cleave
