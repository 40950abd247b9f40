#ifndef CLEAVE_CORE_MODEL_PLASTIC_PASSES_H_
#define CLEAVE_CORE_MODEL_PLASTIC_PASSES_H_

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/material/plasticity.h"
#include "core/model/elastic_passes.h"
#include "core/model/plastic_shape.h"
#include "core/model/plastic_term.h"

namespace cleave {

// Four lanes of a batch, in double: the return to the yield surface is calculated in that.
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

// What flow adds to the passes of an elastic term. Source: method note, section 6.
template <typename T, typename Law, template <typename> typename Fibres>
class PlasticPasses final : public ElasticTerm<T, Law, Fibres, PlasticShape> {
 public:
  using Elastic = ElasticTerm<T, Law, Fibres, PlasticShape>;
  using Elastic::Elastic;

  absl::string_view name() const override { return "plasticity"; }

  void Flow(const NodalVector& displacements, double dt) override {
    ForEachBatch(this->tets_, [&](int64_t begin, int64_t end) {
      for (int64_t b = begin; b < end; ++b) FlowBatch(b, displacements, dt);
    });
  }

  double KeepFlow() override {
    const std::vector<T>& released = this->shape_.released();
    ParallelFor(this->tets_.chunk_count(), 1, [&](int64_t begin, int64_t end) {
      for (int64_t chunk = begin; chunk < end; ++chunk) {
        const int64_t first = chunk * TetBatches<T>::kChunkBatches;
        const int64_t last =
            std::min(first + TetBatches<T>::kChunkBatches, this->tets_.batch_count());
        Double4 energy = Splat(0);
        for (auto b = static_cast<size_t>(first); b < static_cast<size_t>(last); ++b) {
          energy += Fold(this->tets_.batches[b].volume * released[b]);
          this->shape_.kept()[b] = this->shape_.flowed()[b];
        }
        this->chunk_energy_[static_cast<size_t>(chunk)] = Sum(energy);
      }
    });
    double energy = 0;
    for (const double of_chunk : this->chunk_energy_) energy += of_chunk;
    return energy * this->stress_unit_ * std::pow(this->tets_.length_unit, 3);
  }

  void AddEffectiveStress(const NodalVector& displacements,
                          std::span<Eigen::Matrix3d> stresses) const override {
    this->AddStressAt([&](int64_t b) { return FlowedDeformation(b, displacements).g; }, stresses);
  }

  int64_t tet_count() const override { return this->tets_.tet_count; }
  int64_t tet_at(int64_t place) const override { return this->tets_.tet_at(place); }

  void GetPlasticTets(std::span<PlasticTet> tets) const override {
    ForEachBatch(this->tets_, [&](int64_t begin, int64_t end) {
      for (int64_t b = begin; b < end; ++b) {
        const PlasticState<T>& state = this->shape_.flowed()[static_cast<size_t>(b)];
        Matrix3<T> inverse = state.inverse;
        for (int i = 0; i < 3; ++i) inverse(i, i) += 1.0;
        const Matrix3<T> cofactor = Cofactor(inverse);  // determinant 1
        for (int lane = 0; lane < this->tets_.lanes(b); ++lane) {
          PlasticTet& tet = tets[static_cast<size_t>(b * TetBatches<T>::kLanes + lane)];
          for (int k = 0; k < 9; ++k) tet.deformation(k / 3, k % 3) = cofactor(k % 3, k / 3)[lane];
          tet.exhaustion =
              state.strain[lane] * this->shape_.record(b, lane / 4).per_failure_strain[lane % 4];
        }
      }
    });
  }

  void GetPlasticStrains(std::span<double> strains) const override {
    for (size_t place = 0; place < static_cast<size_t>(tet_count()); ++place) {
      strains[place] =
          this->shape_.kept()[place / Lanes<T>::kCount].strain[place % Lanes<T>::kCount];
    }
  }

  // The tets that have flowed, by place, and their F_p^-1 - I and strain.
  void Save(ByteWriter& out) const override {
    std::vector<int64_t> places;
    std::vector<Flowed> states;
    for (int64_t place = 0; place < tet_count(); ++place) {
      const PlasticState<T>& state =
          this->shape_.kept()[static_cast<size_t>(place) / Lanes<T>::kCount];
      const auto lane = static_cast<size_t>(place) % Lanes<T>::kCount;
      if (state.strain[lane] == 0) continue;
      places.push_back(place);
      Flowed& flowed = states.emplace_back();
      for (size_t k = 0; k < 9; ++k)
        flowed[k] = state.inverse(static_cast<int>(k) / 3, static_cast<int>(k) % 3)[lane];
      flowed[9] = state.strain[lane];
    }
    out.PutVector(places);
    out.PutVector(states);
  }

  absl::Status Restore(ByteReader& in) override {
    const auto places = in.GetVector<int64_t>();
    const auto states = in.GetVector<Flowed>();
    if (!in.ok() || places.size() != states.size())
      return absl::DataLossError("the plastic state is truncated");
    for (size_t i = 0; i < places.size(); ++i) {
      if (places[i] < (i > 0 ? places[i - 1] + 1 : 0) || places[i] >= tet_count())
        return absl::DataLossError(absl::StrCat("plastic state: tet ", places[i],
                                                " is out of order or outside [0, ", tet_count(),
                                                ")"));
      Eigen::Matrix3d inverse = Eigen::Matrix3d::Identity();
      for (int k = 0; k < 9; ++k) inverse(k / 3, k % 3) += states[i][static_cast<size_t>(k)];
      // Flow keeps volumes, to the rounding of float.
      if (!(std::abs(inverse.determinant() - 1) < 1e-2) || !(states[i][9] > 0) ||
          !std::isfinite(states[i][9]))
        return absl::DataLossError(
            absl::StrCat("plastic state: tet ", places[i], " cannot have flowed like that"));
    }
    std::vector<PlasticState<T>>& kept = this->shape_.kept();
    kept.assign(kept.size(), PlasticState<T>{});
    using Scalar = typename Lanes<T>::Scalar;
    for (size_t i = 0; i < places.size(); ++i) {
      PlasticState<T>& state = kept[static_cast<size_t>(places[i]) / Lanes<T>::kCount];
      const auto lane = static_cast<size_t>(places[i]) % Lanes<T>::kCount;
      for (size_t k = 0; k < 9; ++k) {
        state.inverse(static_cast<int>(k) / 3, static_cast<int>(k) % 3)[lane] =
            static_cast<Scalar>(states[i][k]);
      }
      state.strain[lane] = static_cast<Scalar>(states[i][9]);
    }
    this->shape_.flowed() = kept;
    return absl::OkStatus();
  }

 private:
  using Flowed = std::array<double, 10>;

  Deformation<T> FlowedDeformation(int64_t b, const NodalVector& displacements) const {
    const TetBatch<T>& batch = this->tets_.batches[static_cast<size_t>(b)];
    return PlasticShape<T>::DeformationFrom(
        this->shape_.flowed()[static_cast<size_t>(b)], batch.gradient,
        VertexMoves(batch, displacements.data(), this->tets_.length_unit));
  }

  void FlowBatch(int64_t b, const NodalVector& displacements, double dt) {
    const auto index = static_cast<size_t>(b);
    const PlasticState<T>& kept = this->shape_.kept()[index];
    PlasticState<T>& flowed = this->shape_.flowed()[index];
    flowed = kept;
    this->shape_.released()[index] = T{};
    const Deformation<T> trial = this->DeformationOf(b, displacements);
    bool any = false;
    for (int part = 0; part < PlasticShape<T>::kParts; ++part) {
      const PlasticRecord& record = this->shape_.record(b, part);
      const FlowRule<Double4> rule = {record.yield_stress, record.hardening, record.flow_rate * dt};
      const PlasticReturn flow =
          ReturnToYield<Law>(PartOf(trial.g, part), record.lame, rule, PartOf(kept.strain, part));
      // Dead tets keep what they have.
      Int64x4 flows = (flow.strain > 0) & (PartOf(this->tets_.batches[index].volume, part) > 0);
      if (!Any(flows)) continue;
      const Matrix3<Double4> inverse = FlowedInverse(PartOf(kept.inverse, part), flow);
      flows = flows & IsWithinPlasticRatio(inverse);
      for (int lane = 0; lane < 4; ++lane) {
        if (flows[lane] == 0) continue;
        any = true;
        using Scalar = typename Lanes<T>::Scalar;
        const int at = 4 * part + lane;
        for (int k = 0; k < 9; ++k)
          flowed.inverse(k / 3, k % 3)[at] = static_cast<Scalar>(inverse(k / 3, k % 3)[lane]);
        flowed.strain[at] += static_cast<Scalar>(flow.strain[lane]);
      }
    }
    if (!any) return;
    // Flow only ever takes energy out. Laws that give way when crushed would have it otherwise, and
    // fibres that are compressed while the solid around them is pulled.
    const T released = this->EnergyDensity(b, trial.g) -
                       this->EnergyDensity(b, FlowedDeformation(b, displacements).g);
    const auto falls = released >= T{};
    for (int k = 0; k < 9; ++k) {
      flowed.inverse(k / 3, k % 3) =
          falls ? flowed.inverse(k / 3, k % 3) : kept.inverse(k / 3, k % 3);
    }
    flowed.strain = falls ? flowed.strain : kept.strain;
    this->shape_.released()[index] = falls ? released : T{};
  }
};

template <typename T, typename Law>
std::unique_ptr<PlasticTerm> MakePlasticTermOfLaw(const TetMesh& mesh, const Incidence& incidence,
                                                  ElasticPart part, FractureStress stress) {
  const int64_t tets =
      part.tets.empty() ? mesh.tet_count() : static_cast<int64_t>(part.tets.size());
  PlasticShape<T> shape(part, tets);
  if (part.fibres.empty()) {
    return std::make_unique<PlasticPasses<T, Law, NoFibres>>(mesh, incidence, std::move(part),
                                                             stress, std::move(shape));
  }
  return std::make_unique<PlasticPasses<T, Law, FibreFamilies>>(mesh, incidence, std::move(part),
                                                                stress, std::move(shape));
}

template <typename T>
std::unique_ptr<PlasticTerm> MakePlasticTermOf(const TetMesh& mesh, const Incidence& incidence,
                                               ElasticPart part, FractureStress stress) {
  switch (part.law) {
    case ElasticLaw::kInvertibleNeoHookean:
      return MakePlasticTermOfLaw<T, InvertibleNeoHookean>(mesh, incidence, std::move(part),
                                                           stress);
    case ElasticLaw::kCorotatedLinear:
      return MakePlasticTermOfLaw<T, CorotatedLinear>(mesh, incidence, std::move(part), stress);
    case ElasticLaw::kStVenantKirchhoff:
      return MakePlasticTermOfLaw<T, StVenantKirchhoff>(mesh, incidence, std::move(part), stress);
    case ElasticLaw::kStableNeoHookean:
      break;
  }
  return MakePlasticTermOfLaw<T, StableNeoHookean>(mesh, incidence, std::move(part), stress);
}

// In a file each: every one of them is eight terms.
extern template std::unique_ptr<PlasticTerm> MakePlasticTermOf<Double4>(const TetMesh&,
                                                                        const Incidence&,
                                                                        ElasticPart,
                                                                        FractureStress);
extern template std::unique_ptr<PlasticTerm> MakePlasticTermOf<Float8>(const TetMesh&,
                                                                       const Incidence&,
                                                                       ElasticPart, FractureStress);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_PLASTIC_PASSES_H_
