#ifndef CLEAVE_CORE_MATERIAL_INCREMENTAL_POTENTIAL_H_
#define CLEAVE_CORE_MATERIAL_INCREMENTAL_POTENTIAL_H_

#include "core/base/double4.h"
#include "core/base/matrix3.h"
#include "core/material/isotropic_stiffness.h"
#include "core/material/moduli.h"
#include "core/material/plasticity.h"

// What a ductile tet costs over a step, as a function of the deformation at its end alone:
//
//   W(F) = min over p of  psi(exp(ln s - p)) + Y g + (hardening + viscosity) g^2 / 2
//
// with the principal stretches s of F F_p^-1, F_p that of the start of the step, principal
// logarithmic plastic strains p of trace 0, g = sqrt(2/3) |p| and the yield stress Y at the start.
// dW/dF is the stress that is left after the flow, so that a minimum of inertia and W over a body
// is its equilibrium at the end of the step, and W is an energy that a line search can hold on to.
// At the minimum q = Y + (hardening + viscosity) g exactly, and p points along dev t: for all but
// the first order of elastic strain this is the radial return of plasticity.h, along e, which
// coincides with it where two stretches are equal and which no energy has for its derivative. The
// viscosity, (3 mu + hardening) / (exp(flow_rate dt) - 1), is that whose step leaves
// exp(-flow_rate dt) of a small overstrain. Source: method note, section 6; Ortiz and Stainier, The
// variational formulation of viscoplastic constitutive updates, Computer Methods in Applied
// Mechanics and Engineering 171 (1999) 419.

namespace cleave {

// The minimum in four tets. In lanes that do not flow `log_flow`, `strain` and the energies are 0.
template <typename Law>
struct StepFlow {
  Int64x4 flows;
  Double4 log_flow[3];  // p
  Double4 strain;       // g
  Double4 overstress;   // Pa, q above the yield stress at the start
  Double4 potential;    // J/m^3, of W what is not elastic energy
  Double4 work;  // J/m^3, what flow takes out: at the end of the step viscosity has twice that
  PrincipalState<Law> elastic;  // after the flow
};

namespace plasticity_internal {

// Two orthogonal directions without trace.
inline constexpr double kFirst[3] = {0.70710678118654752, -0.70710678118654752, 0};
inline constexpr double kSecond[3] = {0.40824829046386302, 0.40824829046386302,
                                      -0.81649658092772603};

inline Double4 Viscosity(const LameConstants<Double4>& lame, const FlowRule<Double4>& rule) {
  return (3.0 * lame.mu + rule.hardening) / Expm1(rule.relaxation);
}

// The second derivative by p within these directions: of psi, from its tangent, and of the rest.
struct FlowCurvature {
  Double4 first, mixed, second;
  Double4 determinant() const { return first * second - mixed * mixed; }
};
inline FlowCurvature CurvatureOf(const Double4 tangent[3][3], Double4 y0, Double4 y1, Double4 yield,
                                 Double4 modulus) {
  FlowCurvature c = {Splat(0), Splat(0), Splat(0)};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      c.first += kFirst[i] * kFirst[j] * tangent[i][j];
      c.mixed += kFirst[i] * kSecond[j] * tangent[i][j];
      c.second += kSecond[i] * kSecond[j] * tangent[i][j];
    }
  }
  const Double4 squares = y0 * y0 + y1 * y1;
  const Double4 along = 2.0 / 3.0 * modulus;
  const Double4 across = __builtin_sqrt(2.0 / 3.0) * yield / Sqrt(squares);
  const Double4 share = (along - across) / squares;
  c.first += across + share * y0 * y0;
  c.mixed += share * y0 * y1;
  c.second += across + share * y1 * y1;
  return c;
}

}  // namespace plasticity_internal

// Of tets whose elastic deformation would be F_e = U diag(1 + strain) V^T without flow and whose
// equivalent plastic strain is `plastic_strain`. Tets below yield, inverted or crushed below
// kLeastFlowingStretch do not flow, as those do not that are not finite or in a lane that is not
// set in `may_flow`.
template <typename Law>
StepFlow<Law> FindStepFlow(const Double4 strain[3], const LameConstants<Double4>& lame,
                           const FlowRule<Double4>& rule, Double4 plastic_strain,
                           Int64x4 may_flow) {
  using namespace plasticity_internal;
  const Double4 yield = rule.Yield(plastic_strain);
  const Double4 zero = Splat(0);
  const PrincipalState<Law> trial(strain, lame);
  StepFlow<Law> flow{may_flow, {zero, zero, zero}, zero, zero, zero, zero, trial};
  for (int k = 0; k < 3; ++k) flow.flows = flow.flows & (1.0 + strain[k] >= kLeastFlowingStretch);
  flow.flows = flow.flows & (trial.VonMises() > (1.0 + kYieldRounding) * yield);
  if (!Any(flow.flows)) return flow;

  const Double4 held[3] = {flow.flows ? strain[0] : zero, flow.flows ? strain[1] : zero,
                           flow.flows ? strain[2] : zero};
  const LogStrain log = LogStrainOf(held);
  constexpr double kRadial = 1e-4;
  const Double4 share = RadialShare<Law>(log, lame, rule, plastic_strain, flow.flows, kRadial);
  const Double4 viscosity = Viscosity(lame, rule);
  const Double4 modulus = rule.hardening + viscosity;

  // Newton's method in the plane of strains without trace, from the radial return: y are the
  // coordinates of p there. Lanes that do not flow get a p that no formula chokes on.
  Double4 y[2] = {zero, zero};
  for (int k = 0; k < 3; ++k) {
    y[0] += kFirst[k] * (1.0 - share) * log.deviator[k];
    y[1] += kSecond[k] * (1.0 - share) * log.deviator[k];
  }
  y[0] = flow.flows ? y[0] : Splat(1);
  const Double4 radial[2] = {y[0], y[1]};
  Double4 first_residual = zero;
  const auto state_at = [&](const Double4 at[2]) {
    Double4 left[3];
    for (int k = 0; k < 3; ++k) {
      flow.log_flow[k] = flow.flows ? kFirst[k] * at[0] + kSecond[k] * at[1] : zero;
      left[k] = log.mean + log.deviator[k] - flow.log_flow[k];
    }
    flow.strain = flow.flows ? Sqrt(2.0 / 3.0 * (at[0] * at[0] + at[1] * at[1])) : zero;
    flow.overstress = modulus * flow.strain;
    return StateAt<Law>(left, lame);
  };
  constexpr int kMaxIterations = 12;
  constexpr double kMet = 1e-13;
  constexpr double kPressureShare = 0.01;  // of whose rounding there is a digit more
  for (int iteration = 0;; ++iteration) {
    flow.elastic = state_at(y);
    const Double4 length = Sqrt(y[0] * y[0] + y[1] * y[1]);
    const Double4 drag = __builtin_sqrt(2.0 / 3.0) * (yield + flow.overstress) / length;
    Double4 residual[2] = {-drag * y[0], -drag * y[1]};
    Double4 magnitude = yield;
    for (int k = 0; k < 3; ++k) {
      magnitude += kPressureShare * Abs(flow.elastic.Kirchhoff(k));
      residual[0] += kFirst[k] * flow.elastic.Kirchhoff(k);
      residual[1] += kSecond[k] * flow.elastic.Kirchhoff(k);
    }
    const Double4 norm = Sqrt(residual[0] * residual[0] + residual[1] * residual[1]);
    if (iteration == 0) first_residual = norm;
    const Int64x4 open = flow.flows & ~(norm <= kMet * magnitude);
    if (!Any(open)) break;
    if (iteration == kMaxIterations) {
      // Where the law gives way, as when crushed, the radial return stands.
      const Int64x4 worse = open & ~(norm <= first_residual);
      y[0] = worse ? radial[0] : y[0];
      y[1] = worse ? radial[1] : y[1];
      flow.elastic = state_at(y);
      break;
    }
    Double4 tangent[3][3];
    flow.elastic.LogTangent(lame, tangent);
    const FlowCurvature c = CurvatureOf(tangent, y[0], y[1], yield + flow.overstress, modulus);
    const Int64x4 definite = open & (c.first > 0) & (c.determinant() > 0);
    if (!Any(definite)) break;
    const Double4 per = 1.0 / (definite ? c.determinant() : Splat(1));
    y[0] += definite ? per * (c.second * residual[0] - c.mixed * residual[1]) : zero;
    y[1] += definite ? per * (c.first * residual[1] - c.mixed * residual[0]) : zero;
  }
  const Double4 viscous = viscosity * flow.strain * flow.strain;
  const Double4 spent = rule.Work(plastic_strain, flow.strain);
  flow.potential = spent + 0.5 * viscous;
  flow.work = spent + viscous;
  // The lower of the two: crushed laws may have a minimum that is none.
  const Int64x4 falls =
      flow.flows & (flow.elastic.Energy(lame) + flow.potential <= trial.Energy(lame));
  for (int k = 0; k < 3; ++k) flow.log_flow[k] = falls ? flow.log_flow[k] : zero;
  flow.strain = falls ? flow.strain : zero;
  flow.overstress = falls ? flow.overstress : zero;
  flow.potential = falls ? flow.potential : zero;
  flow.work = falls ? flow.work : zero;
  flow.flows = falls;
  return flow;
}

// dW/ds of a flow that FindStepFlow found from 1 + strain; of use in lanes that flow.
template <typename Law>
void SetFlowStress(const StepFlow<Law>& flow, const Double4 strain[3], Double4 stress[3]) {
  for (int k = 0; k < 3; ++k) stress[k] = flow.elastic.Kirchhoff(k) / (1.0 + strain[k]);
}

// The second derivative of W at the singular values, not projected; of use in lanes that flow.
template <typename Law>
StiffnessSpectrum<Double4> FlowSpectrum(const StepFlow<Law>& flow, const Double4 strain[3],
                                        const LameConstants<Double4>& lame,
                                        const FlowRule<Double4>& rule, Double4 plastic_strain) {
  using namespace plasticity_internal;
  Double4 tangent[3][3];
  flow.elastic.LogTangent(lame, tangent);
  Double4 y[2] = {Splat(0), Splat(0)};
  for (int k = 0; k < 3; ++k) {
    y[0] += kFirst[k] * flow.log_flow[k];
    y[1] += kSecond[k] * flow.log_flow[k];
  }
  y[0] = flow.flows ? y[0] : Splat(1);
  const Double4 yield = rule.Yield(plastic_strain) + flow.overstress;
  const FlowCurvature c =
      CurvatureOf(tangent, y[0], y[1], yield, rule.hardening + Viscosity(lame, rule));
  const Double4 per = 1.0 / c.determinant();
  // What flow yields of the tangent: along the two directions.
  Double4 given[2][3];
  for (int i = 0; i < 3; ++i) {
    given[0][i] = given[1][i] = Splat(0);
    for (int j = 0; j < 3; ++j) {
      given[0][i] += kFirst[j] * tangent[i][j];
      given[1][i] += kSecond[j] * tangent[i][j];
    }
  }
  StiffnessSpectrum<Double4> spectrum;
  Double4 stress[3], s[3];
  SetFlowStress(flow, strain, stress);
  for (int i = 0; i < 3; ++i) s[i] = 1.0 + strain[i];
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      const Double4 yielded =
          per * (c.second * given[0][i] * given[0][j] + c.first * given[1][i] * given[1][j] -
                 c.mixed * (given[0][i] * given[1][j] + given[1][i] * given[0][j]));
      spectrum.axial[i][j] = spectrum.axial[j][i] = (tangent[i][j] - yielded) / (s[i] * s[j]);
    }
    spectrum.axial[i][i] -= stress[i] / s[i];
  }
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const Double4 gap = strain[i] - strain[j];
    const Int64x4 apart = Abs(gap) > 1e-7;
    spectrum.symmetric[k] =
        apart ? (stress[i] - stress[j]) / (apart ? gap : Splat(1))
              : 0.5 * (spectrum.axial[i][i] + spectrum.axial[j][j]) - spectrum.axial[i][j];
    spectrum.skew[k] = (stress[i] + stress[j]) / (s[i] + s[j]);
  }
  return spectrum;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_MATERIAL_INCREMENTAL_POTENTIAL_H_
