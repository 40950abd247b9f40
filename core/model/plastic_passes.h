#ifndef CLEAVE_CORE_MODEL_PLASTIC_PASSES_H_
#define CLEAVE_CORE_MODEL_PLASTIC_PASSES_H_

#include <Eigen/LU>
#include <array>
#include <atomic>
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

// What flow adds to the passes of an elastic term: the end of a step. Source: method note, section
// 6.
template <typename T, typename Law, template <typename> typename Fibres>
class PlasticPasses final : public ElasticTerm<T, Law, Fibres, PlasticShape> {
 public:
  using Elastic = ElasticTerm<T, Law, Fibres, PlasticShape>;
  using Elastic::Elastic;

  absl::string_view name() const override { return "plasticity"; }

  void BeginStep(double dt) override { this->shape_.BeginStep(dt); }

  // Bars tets whose flow would leave kLargestPlasticRatio, or load fibres with more energy than it
  // takes: fibres that are pulled while the solid around them is crushed that way. In pairs of
  // energies that jump, as those of fibres that turn over.
  bool ChooseBranches(const NodalVector& displacements, BranchChoice choice) override {
    bool changed = Elastic::ChooseBranches(displacements, choice);
    if (choice == BranchChoice::kTrial) return changed;  // a bar adds energy
    std::atomic<bool> barred = false;
    ForEachBatch(this->tets_, [&](int64_t begin, int64_t end) {
      for (int64_t b = begin; b < end; ++b) {
        if (BarBatch(b, this->DeformationOf(b, displacements).g)) barred = true;
      }
    });
    return changed || barred;
  }

  void Flow(const NodalVector& displacements) override {
    chunk_work_.resize(static_cast<size_t>(this->tets_.pass_chunk_count()));
    ForEachChunk(this->tets_, [&](int64_t chunk, int64_t first, int64_t last) {
      FlowWork work;
      for (int64_t b = first; b < last; ++b) FlowBatch(b, displacements, work);
      chunk_work_[static_cast<size_t>(chunk)] = work;
    });
  }

  FlowWork KeepFlow() override {
    ForEachBatch(this->tets_, [&](int64_t begin, int64_t end) {
      for (auto b = static_cast<size_t>(begin); b < static_cast<size_t>(end); ++b)
        this->shape_.kept()[b] = this->shape_.flowed()[b];
    });
    FlowWork sum;
    for (const FlowWork& of_chunk : chunk_work_) {
      sum.work += of_chunk.work;
      sum.potential += of_chunk.potential;
    }
    const double unit = std::pow(this->tets_.length_unit, 3);
    return {sum.work * unit, sum.potential * unit};
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

  // The elastic energy density, Pa, that fibres give up as a batch flows.
  Double4 FibresRelease(int64_t b, int part, const Matrix3<Double4>& trial,
                        const Matrix3<Double4>& flowed) const {
    if constexpr (Fibres<T>::kPresent) {
      Matrix3<T> before = {}, after = {}, stress = {};
      for (int k = 0; k < 9; ++k) {
        SetPart(before(k / 3, k % 3), part, Int64x4{-1, -1, -1, -1}, trial(k / 3, k % 3));
        SetPart(after(k / 3, k % 3), part, Int64x4{-1, -1, -1, -1}, flowed(k / 3, k % 3));
      }
      const T released =
          this->fibres_.AddStress(b, before, stress) - this->fibres_.AddStress(b, after, stress);
      return this->stress_unit_ * PartOf(released, part);
    } else {
      return Splat(0);
    }
  }

  // F_e - I after a flow by R - I: (I + G) R - I.
  static Matrix3<Double4> AfterFlow(const Matrix3<Double4>& trial, const Matrix3<Double4>& change) {
    Matrix3<Double4> flowed = trial * change;
    for (int k = 0; k < 9; ++k) flowed(k / 3, k % 3) += trial(k / 3, k % 3) + change(k / 3, k % 3);
    return flowed;
  }

  bool BarBatch(int64_t b, const Matrix3<T>& trial) {
    bool barred = false;
    for (int part = 0; part < PlasticShape<T>::kParts; ++part) {
      const Matrix3<Double4> g = PartOf(trial, part);
      if (!Fibres<T>::kPresent && !IsFarFromRest(g, this->shape_.StrainOf(b, part))) continue;
      const auto svd = ComputeSvd(g);
      const auto flow = this->shape_.template FlowOf<Law>(b, part, svd.strain);
      if (!Any(flow.flows)) continue;
      const Matrix3<Double4> change = FlowChange(svd.v, flow.log_flow);
      const Matrix3<Double4> inverse =
          FlowedInverse(PartOf(this->shape_.kept()[static_cast<size_t>(b)].inverse, part), change);
      const Int64x4 stays = IsWithinPlasticRatio(inverse) &
                            (flow.potential + FibresRelease(b, part, g, AfterFlow(g, change)) >= 0);
      for (int lane = 0; lane < 4; ++lane) {
        if (flow.flows[lane] == 0 || stays[lane] != 0) continue;
        this->shape_.Bar(b, 4 * part + lane);
        barred = true;
      }
    }
    return barred;
  }

  // Nearer than this, no flow reaches kLargestPlasticRatio: singular values of F_p lie within
  // exp(sqrt(3) strain) of each other, and a step adds no more than those of F_e.
  static bool IsFarFromRest(const Matrix3<Double4>& trial, Double4 strain) {
    Double4 squares = Splat(0);
    for (int k = 0; k < 9; ++k) squares += trial(k / 3, k % 3) * trial(k / 3, k % 3);
    return Any(~(strain < 1) | ~(squares < 0.25));
  }

  void FlowBatch(int64_t b, const NodalVector& displacements, FlowWork& work) {
    const auto index = static_cast<size_t>(b);
    const PlasticState<T>& kept = this->shape_.kept()[index];
    PlasticState<T>& flowed = this->shape_.flowed()[index];
    flowed = kept;
    const Matrix3<T> trial = this->DeformationOf(b, displacements).g;
    for (int part = 0; part < PlasticShape<T>::kParts; ++part) {
      const Matrix3<Double4> g = PartOf(trial, part);
      const auto svd = ComputeSvd(g);
      const auto flow = this->shape_.template FlowOf<Law>(b, part, svd.strain);
      // Dead tets keep what they have.
      const Double4 volume = PartOf(this->tets_.batches[index].volume, part);
      const Int64x4 flows = flow.flows & (volume > 0);
      if (!Any(flows)) continue;
      const Matrix3<Double4> change = FlowChange(svd.v, flow.log_flow);
      const Matrix3<Double4> inverse = FlowedInverse(PartOf(kept.inverse, part), change);
      for (int k = 0; k < 9; ++k)
        SetPart(flowed.inverse(k / 3, k % 3), part, flows, inverse(k / 3, k % 3));
      SetPart(flowed.strain, part, flows, PartOf(kept.strain, part) + flow.strain);
      const Double4 released = FibresRelease(b, part, g, AfterFlow(g, change));
      work.work += Sum(flows ? volume * (flow.work + released) : Splat(0));
      work.potential += Sum(flows ? volume * (flow.potential + released) : Splat(0));
    }
  }

  std::vector<FlowWork> chunk_work_;  // scratch, a chunk each
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
