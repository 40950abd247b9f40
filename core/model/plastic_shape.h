#ifndef CLEAVE_CORE_MODEL_PLASTIC_SHAPE_H_
#define CLEAVE_CORE_MODEL_PLASTIC_SHAPE_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/lanes.h"
#include "core/base/matrix3.h"
#include "core/material/incremental_potential.h"
#include "core/material/moduli.h"
#include "core/model/elastic_passes.h"
#include "core/model/plastic_term.h"

namespace cleave {

// Four lanes of a batch, in double: flow is calculated in that.
inline Double4 PartOf(Double4 batch, int /*part*/) { return batch; }
inline Double4 PartOf(Float8 batch, int part) {
  return Widen(part == 0 ? LowHalf(batch) : HighHalf(batch));
}
template <typename T>
Matrix3<Double4> PartOf(const Matrix3<T>& batch, int part) {
  Matrix3<Double4> four;
  for (int k = 0; k < 9; ++k) four(k / 3, k % 3) = PartOf(batch(k / 3, k % 3), part);
  return four;
}

// Replaces those of the four lanes that `chosen` has set.
inline void SetPart(Double4& batch, int /*part*/, Int64x4 chosen, Double4 values) {
  batch = chosen ? values : batch;
}
inline void SetPart(Float8& batch, int part, Int64x4 chosen, Double4 values) {
  const Float4 narrow = Narrow(values);
  for (int lane = 0; lane < 4; ++lane) {
    if (chosen[lane] != 0) batch[4 * part + lane] = narrow[lane];
  }
}

// The plastic strain of a batch of tets.
template <typename T>
struct PlasticState {
  Matrix3<T> inverse;  // F_p^-1 - I
  T strain;            // equivalent
};

// Moduli and yielding of four tets.
struct PlasticRecord {
  LameConstants<Double4> lame;  // Pa
  Double4 yield_stress;         // Pa
  Double4 hardening;            // Pa
  Double4 flow_rate;            // 1/s
  Double4 per_failure_strain;   // 1 / failure strain; 0 where there is none
};

// From what shape elastic strain is measured in ductile tets: from what plastic flow had made of
// the rest shape at the start of the step. F_e = F F_p^-1 only turns and stretches the shape
// gradients, g' = F_p^-T g, and as det F_p = 1 volumes stay: passes are those of an elastic solid,
// but for tets beyond yield, whose energy is the incremental potential.
template <typename T>
class PlasticShape {
 public:
  using Term = PlasticTerm;
  static constexpr bool kFlows = true;
  // Records are of four tets.
  static constexpr int kParts = Lanes<T>::kCount / 4;

  PlasticShape(const ElasticPart& part, int64_t tet_count) {
    const auto batches = static_cast<size_t>((tet_count + Lanes<T>::kCount - 1) / Lanes<T>::kCount);
    kept_.assign(batches, PlasticState<T>{});
    flowed_ = kept_;
    barred_.assign(batches, 0);
    uniform_ = part.plasticity.size() == 1 && part.lame.size() == 1;
    records_.resize(uniform_ ? 1 : batches * kParts);
    for (size_t r = 0; r < records_.size(); ++r) {
      for (size_t lane = 0; lane < 4; ++lane) {
        // Lanes past the last tet repeat it.
        const auto& lame = part.lame[std::min(r * 4 + lane, part.lame.size() - 1)];
        const auto& ductile = part.plasticity[std::min(r * 4 + lane, part.plasticity.size() - 1)];
        PlasticRecord& record = records_[r];
        record.lame.mu[lane] = lame.mu;
        record.lame.lambda[lane] = lame.lambda;
        record.yield_stress[lane] = ductile.yield_stress;
        record.hardening[lane] = ductile.hardening;
        record.flow_rate[lane] = ductile.flow_rate;
        record.per_failure_strain[lane] =
            1 / ductile.failure_strain.value_or(std::numeric_limits<double>::infinity());
      }
    }
  }

  int64_t bytes() const {
    return static_cast<int64_t>(2 * kept_.size() * sizeof(PlasticState<T>) +
                                barred_.size() * sizeof(uint8_t) +
                                records_.size() * sizeof(PlasticRecord));
  }

  Deformation<T> DeformationOf(int64_t b, const Matrix3<T>& rest_gradient,
                               const Matrix3<T>& moves) const {
    return DeformationFrom(kept_[static_cast<size_t>(b)], rest_gradient, moves);
  }
  static Deformation<T> DeformationFrom(const PlasticState<T>& state,
                                        const Matrix3<T>& rest_gradient, const Matrix3<T>& moves) {
    Deformation<T> deformation;
    deformation.gradient = rest_gradient * state.inverse;
    for (int k = 0; k < 9; ++k) deformation.gradient(k / 3, k % 3) += rest_gradient(k / 3, k % 3);
    deformation.g = DisplacementGradient(moves, deformation.gradient);
    for (int k = 0; k < 9; ++k) deformation.g(k / 3, k % 3) += state.inverse(k / 3, k % 3);
    return deformation;
  }

  // Of the tets 4 * part to 4 * part + 3 of a batch.
  const PlasticRecord& record(int64_t b, int part) const {
    return records_[uniform_ ? 0 : static_cast<size_t>(b * kParts + part)];
  }

  // Starts a step of `dt` (s).
  void BeginStep(double dt) {
    dt_ = dt;
    barred_.assign(barred_.size(), 0);
  }

  // Of the tets 4 * part to 4 * part + 3 of a batch whose elastic deformation from the start of the
  // step has the singular values 1 + strain.
  template <typename Law>
  StepFlow<Law> FlowOf(int64_t b, int part, const Double4 strain[3]) const {
    return FindStepFlow<Law>(strain, record(b, part).lame, RuleOf(b, part), StrainOf(b, part),
                             MayFlow(b, part));
  }

  // Puts the incremental potential and its stress in the place of the law's, in tets of a batch
  // that flow. `unit`: Pa, of stress.
  template <typename Law>
  void Relax(int64_t b, const Matrix3<T>& g, double unit, T& density, Matrix3<T>& stress) const {
    const T von_mises = VonMisesStress(stress, g);
    for (int part = 0; part < kParts; ++part) {
      // Rounding decides nothing here: FindStepFlow looks again.
      const Double4 yield =
          record(b, part).yield_stress + record(b, part).hardening * StrainOf(b, part);
      if (!Any(unit * PartOf(von_mises, part) > kNearYield * yield)) continue;
      const auto svd = ComputeSvd(PartOf(g, part));
      const StepFlow<Law> flow = FlowOf<Law>(b, part, svd.strain);
      if (!Any(flow.flows)) continue;
      Double4 principal[3];
      SetFlowStress(flow, svd.strain, principal);
      const Matrix3<Double4> relaxed = FromPrincipal(svd, principal);
      for (int k = 0; k < 9; ++k)
        SetPart(stress(k / 3, k % 3), part, flow.flows, relaxed(k / 3, k % 3) / unit);
      SetPart(density, part, flow.flows,
              (flow.elastic.Energy(record(b, part).lame) + flow.potential) / unit);
    }
  }

  // The same for the second derivative.
  template <typename Law>
  void Relax(int64_t b, const SignedSvd<T>& svd, double unit,
             StiffnessSpectrum<T>& spectrum) const {
    for (int part = 0; part < kParts; ++part) {
      const Double4 strain[3] = {PartOf(svd.strain[0], part), PartOf(svd.strain[1], part),
                                 PartOf(svd.strain[2], part)};
      const StepFlow<Law> flow = FlowOf<Law>(b, part, strain);
      if (!Any(flow.flows)) continue;
      const StiffnessSpectrum<Double4> relaxed =
          FlowSpectrum(flow, strain, record(b, part).lame, RuleOf(b, part), StrainOf(b, part));
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j)
          SetPart(spectrum.axial[i][j], part, flow.flows, relaxed.axial[i][j] / unit);
        SetPart(spectrum.symmetric[i], part, flow.flows, relaxed.symmetric[i] / unit);
        SetPart(spectrum.skew[i], part, flow.flows, relaxed.skew[i] / unit);
      }
    }
  }

  // Whether tets of a batch are to stay as they are until the step ends.
  Int64x4 MayFlow(int64_t b, int part) const {
    const int bars = barred_[static_cast<size_t>(b)] >> (4 * part);
    Int64x4 may;
    for (int lane = 0; lane < 4; ++lane) may[lane] = (bars >> lane & 1) == 0 ? -1 : 0;
    return may;
  }
  // Bars a tet from flowing in this step.
  void Bar(int64_t b, int lane) {
    uint8_t& bars = barred_[static_cast<size_t>(b)];
    bars = static_cast<uint8_t>(bars | 1 << lane);
  }

  // The equivalent plastic strain at the start of the step.
  Double4 StrainOf(int64_t b, int part) const {
    return PartOf(kept_[static_cast<size_t>(b)].strain, part);
  }

  // State at the start of the step.
  std::vector<PlasticState<T>>& kept() { return kept_; }
  const std::vector<PlasticState<T>>& kept() const { return kept_; }
  // State after the last flow.
  std::vector<PlasticState<T>>& flowed() { return flowed_; }
  const std::vector<PlasticState<T>>& flowed() const { return flowed_; }

 private:
  static constexpr double kNearYield = 0.99;

  FlowRule<Double4> RuleOf(int64_t b, int part) const {
    const PlasticRecord& of = record(b, part);
    return {of.yield_stress, of.hardening, of.flow_rate * dt_};
  }

  std::vector<PlasticState<T>> kept_, flowed_;  // a batch each
  std::vector<uint8_t> barred_;                 // a batch each, a bit a lane
  std::vector<PlasticRecord> records_;          // four tets each, or one for all
  bool uniform_ = true;
  double dt_ = std::numeric_limits<double>::infinity();  // s
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_PLASTIC_SHAPE_H_
