#ifndef CLEAVE_CORE_MODEL_PLASTIC_SHAPE_H_
#define CLEAVE_CORE_MODEL_PLASTIC_SHAPE_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/lanes.h"
#include "core/base/matrix3.h"
#include "core/material/moduli.h"
#include "core/model/elastic_passes.h"
#include "core/model/plastic_term.h"

namespace cleave {

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

// From what shape elastic strain is measured in ductile tets: from what plastic flow has made of
// the rest shape. F_e = F F_p^-1 only turns and stretches the shape gradients, g' = F_p^-T g, and
// as det F_p = 1 volumes stay: passes are those of an elastic solid.
template <typename T>
class PlasticShape {
 public:
  using Term = PlasticTerm;
  // Records are of four tets.
  static constexpr int kParts = Lanes<T>::kCount / 4;

  PlasticShape(const ElasticPart& part, int64_t tet_count) {
    const auto batches = static_cast<size_t>((tet_count + Lanes<T>::kCount - 1) / Lanes<T>::kCount);
    kept_.assign(batches, PlasticState<T>{});
    flowed_ = kept_;
    released_.assign(batches, T{});
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
                                released_.size() * sizeof(T) +
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

  // Strain at the start of the step.
  std::vector<PlasticState<T>>& kept() { return kept_; }
  const std::vector<PlasticState<T>>& kept() const { return kept_; }
  // Strain after the last flow, and the energy density that this released.
  std::vector<PlasticState<T>>& flowed() { return flowed_; }
  const std::vector<PlasticState<T>>& flowed() const { return flowed_; }
  std::vector<T>& released() { return released_; }
  const std::vector<T>& released() const { return released_; }

 private:
  std::vector<PlasticState<T>> kept_, flowed_;  // a batch each
  std::vector<T> released_;                     // in the term's unit of stress
  std::vector<PlasticRecord> records_;          // four tets each, or one for all
  bool uniform_ = true;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_PLASTIC_SHAPE_H_
