#ifndef CLEAVE_CORE_MODEL_ELASTIC_PASSES_H_
#define CLEAVE_CORE_MODEL_ELASTIC_PASSES_H_

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/lanes.h"
#include "core/material/corotated_linear.h"
#include "core/material/invertible_neo_hookean.h"
#include "core/material/isotropic_stiffness.h"
#include "core/material/st_venant_kirchhoff.h"
#include "core/material/stable_neo_hookean.h"
#include "core/model/batch_scatter.h"
#include "core/model/elastic_term.h"
#include "core/model/element_blocks.h"
#include "core/model/fibre_families.h"
#include "core/model/tet_batches.h"

namespace cleave {

// What elastic energies see of a batch.
template <typename T>
struct Deformation {
  Matrix3<T> gradient;  // 1/length_unit, of the shape functions of vertices 1 to 3
  Matrix3<T> g;         // F - I
};

// From what shape elastic strain is measured, in terms whose tets only ever strain elastically:
// from the rest shape.
template <typename T>
struct RestShape {
  using Term = TetTerm;  // what a term with this shape is
  static constexpr bool kFlows = false;

  Deformation<T> DeformationOf(int64_t /*b*/, const Matrix3<T>& rest_gradient,
                               const Matrix3<T>& moves) const {
    return {rest_gradient, DisplacementGradient(moves, rest_gradient)};
  }
  int64_t bytes() const { return 0; }
};

// Passes over the tets of an elastic part. T is the batch, Double4 or Float8; Law the solid's;
// Fibres is NoFibres or FibreFamilies; Shape is what elastic strain is measured from. One pass
// gathers, evaluates all of these and scatters once.
template <typename T, typename Law, template <typename> typename Fibres,
          template <typename> typename Shape>
class ElasticTerm : public Shape<T>::Term {
 public:
  ElasticTerm(const TetMesh& mesh, const Incidence& incidence, ElasticPart part,
              FractureStress stress, Shape<T> shape)
      : mesh_(mesh),
        tets_(BuildTetBatches<T>(mesh, incidence, std::move(part.tets))),
        stress_unit_(StressUnit(part)),
        fibres_(part.fibres, tets_.batch_count(), stress_unit_),
        shape_(std::move(shape)),
        fibres_break_(stress == FractureStress::kTotal),
        chunk_energy_(static_cast<size_t>(tets_.chunk_count())) {
    using Scalar = typename Lanes<T>::Scalar;
    const std::vector<LameConstants<double>>& lame = part.lame;
    const bool uniform = lame.size() == 1;
    lame_stride_ = uniform ? 0 : 1;
    lame_.resize(uniform ? 1 : tets_.batches.size());
    for (size_t b = 0; b < lame_.size(); ++b) {
      for (size_t lane = 0; lane < Lanes<T>::kCount; ++lane) {
        const auto& of_tet = lame[std::min(b * Lanes<T>::kCount + lane, lame.size() - 1)];
        lame_[b].mu[lane] = static_cast<Scalar>(of_tet.mu / stress_unit_);
        lame_[b].lambda[lane] = static_cast<Scalar>(of_tet.lambda / stress_unit_);
      }
    }
  }

  absl::string_view name() const override { return "elasticity"; }

  int64_t bytes() const override {
    return static_cast<int64_t>(tets_.batches.size() * sizeof(TetBatch<T>) +
                                tets_.tets.size() * sizeof(int32_t) +
                                lame_.size() * sizeof(LameConstants<T>)) +
           fibres_.bytes() + shape_.bytes();
  }

  bool ChooseBranches(const NodalVector& displacements, BranchChoice choice) override {
    if constexpr (Fibres<T>::kPresent) {
      if (choice == BranchChoice::kAccepted) return false;  // the trial was here
      const bool start = choice == BranchChoice::kStart;
      // No trial turns a fibre over.
      if (!start && fibres_are_upright_) return false;
      std::atomic<bool> changed = false, turned_over = false;
      ForEachBatch(tets_, [&](int64_t begin, int64_t end) {
        for (int64_t b = begin; b < end; ++b) {
          if (!start && fibres_.AreUpright(b)) continue;
          if (fibres_.ChooseSigns(b, DeformationOf(b, displacements).g, choice)) changed = true;
          if (!fibres_.AreUpright(b)) turned_over = true;
        }
      });
      fibres_are_upright_ = !turned_over;
      return changed;
    }
    return false;
  }

  double LeaveOut(std::span<uint8_t> asleep, const NodalVector& displacements) override {
    tets_.kept.reset();
    ElasticTerm::ChooseBranches(displacements, BranchChoice::kStart);
    KeepAwake(tets_, asleep);
    chunk_energy_.assign(static_cast<size_t>(tets_.pass_chunk_count()), 0.0);
    double energy = 0;
    for (int64_t b = 0; !asleep.empty() && b < tets_.batch_count(); ++b) {
      if (asleep[static_cast<size_t>(tets_.tet_at(b * TetBatches<T>::kLanes))] == 0) continue;
      energy += Sum(Fold(tets_.batches[static_cast<size_t>(b)].volume *
                         EnergyDensity(b, DeformationOf(b, displacements).g)));
    }
    return energy * stress_unit_ * std::pow(tets_.length_unit, 3);
  }

  double AddForces(const NodalVector& displacements, NodalVector& forces) override {
    const double force_unit = stress_unit_ * tets_.length_unit * tets_.length_unit;
    ForEachChunk(tets_, [&](int64_t chunk, int64_t begin, int64_t end) {
      Double4 energy = Splat(0);
      for (int64_t b = begin; b < end; ++b) {
        const Deformation<T> deformation = DeformationOf(b, displacements);
        const Matrix3<T>& g = deformation.g;
        const auto kinematics = Law::KinematicsOf(g);
        T density = Law::Energy(g, kinematics, lame(b));
        Matrix3<T> stress = Law::Stress(g, kinematics, lame(b));
        if constexpr (Shape<T>::kFlows)
          shape_.template Relax<Law>(b, g, stress_unit_, density, stress);
        if constexpr (Fibres<T>::kPresent) density += fibres_.AddStress(b, g, stress);
        const TetBatch<T>& batch = tets_.batches[static_cast<size_t>(b)];
        energy += Fold(batch.volume * density);
        Matrix3<T> force;
        for (int vertex = 0; vertex < 3; ++vertex) {
          const T* gradient = deformation.gradient.m[vertex];
          for (int axis = 0; axis < 3; ++axis) {
            force(vertex, axis) =
                -batch.volume * (stress(axis, 0) * gradient[0] + stress(axis, 1) * gradient[1] +
                                 stress(axis, 2) * gradient[2]);
          }
        }
        ScatterForces(batch, tets_.lanes(b), force, force_unit, forces);
      }
      chunk_energy_[static_cast<size_t>(chunk)] = Sum(energy);
    });
    double energy = 0;
    for (const double of_chunk : chunk_energy_) energy += of_chunk;
    return energy * force_unit * tets_.length_unit;
  }

  void AddStiffness(const NodalVector& displacements, Curvature curvature,
                    EdgeBlocks& blocks) override {
    const T block_unit = Splat<T>(stress_unit_ * tets_.length_unit);
    ForEachChunk(tets_, [&](int64_t, int64_t begin, int64_t end) {
      BatchBlocks<T> element;
      for (int64_t b = begin; b < end; ++b) {
        const TetBatch<T>& batch = tets_.batches[static_cast<size_t>(b)];
        const Deformation<T> deformation = DeformationOf(b, displacements);
        const T scale = block_unit * batch.volume;
        // Before the singular values: roots and quotients of both then overlap.
        const auto of_fibres =
            fibres_.BlocksOf(b, deformation.g, deformation.gradient, scale, curvature);
        const SignedSvd<T> svd = ComputeSvd(deformation.g);
        StiffnessSpectrum<T> spectrum = Law::Spectrum(svd, lame(b));
        if constexpr (Shape<T>::kFlows) shape_.template Relax<Law>(b, svd, stress_unit_, spectrum);
        if (curvature == Curvature::kSemidefinite) ProjectToSemidefinite(spectrum);
        SetElementBlocks(deformation.gradient, scale, svd, spectrum, of_fibres, element);
        ScatterBlocks(batch, tets_.lanes(b), element, blocks.data());
      }
    });
  }

  void AddEffectiveStress(const NodalVector& displacements,
                          std::span<Eigen::Matrix3d> stresses) const override {
    AddStressAt([&](int64_t b) { return DeformationOf(b, displacements).g; }, stresses);
  }

  void SetDamageFactor(int64_t tet, double factor) override {
    const int64_t place = tets_.place_of(tet);
    if (place < 0) return;
    tets_.batches[static_cast<size_t>(place / TetBatches<T>::kLanes)]
        .volume[place % TetBatches<T>::kLanes] = static_cast<typename Lanes<T>::Scalar>(
        factor * (RestVolume(mesh_, tet) / std::pow(tets_.length_unit, 3)));
  }

  double TetEnergy(int64_t tet, const NodalVector& displacements) const override {
    const int64_t place = tets_.place_of(tet);
    if (place < 0) return 0;
    const int64_t b = place / TetBatches<T>::kLanes;
    const Matrix3<T> g = DeformationOf(b, displacements).g;
    T density = EnergyDensity(b, g);
    if constexpr (Shape<T>::kFlows) {
      // What the passes count: of what flows the incremental potential instead of the law's energy.
      const auto kinematics = Law::KinematicsOf(g);
      const T elastic = Law::Energy(g, kinematics, lame(b));
      T relaxed = elastic;
      Matrix3<T> stress = Law::Stress(g, kinematics, lame(b));
      shape_.template Relax<Law>(b, g, stress_unit_, relaxed, stress);
      density += relaxed - elastic;
    }
    const T energy = tets_.batches[static_cast<size_t>(b)].volume * density;
    return double{energy[place % TetBatches<T>::kLanes]} * stress_unit_ *
           std::pow(tets_.length_unit, 3);
  }

  void AddRestModuli(int64_t tet, Matrix6& moduli) const override {
    const int64_t place = tets_.place_of(tet);
    if (place < 0) return;
    const int64_t b = place / TetBatches<T>::kLanes, lane = place % TetBatches<T>::kLanes;
    moduli.diagonal().array() += 2 * stress_unit_ * double{lame(b).mu[lane]};
    moduli.topLeftCorner<3, 3>().array() += stress_unit_ * double{lame(b).lambda[lane]};
    if constexpr (Fibres<T>::kPresent) fibres_.AddRestModuli(b, lane, stress_unit_, moduli);
  }

 protected:
  // Adds dPsi/dF, Pa, where F - I of a batch is g_of(batch); of fibres only if it breaks edges.
  template <typename GradientOf>
  void AddStressAt(const GradientOf& g_of, std::span<Eigen::Matrix3d> stresses) const {
    ForEachBatch(tets_, [&](int64_t begin, int64_t end) {
      for (int64_t b = begin; b < end; ++b) {
        const Matrix3<T> g = g_of(b);
        Matrix3<T> stress = Law::Stress(g, Law::KinematicsOf(g), lame(b));
        if constexpr (Fibres<T>::kPresent) {
          if (fibres_break_) fibres_.AddStress(b, g, stress);
        }
        const int lanes = tets_.lanes(b);
        for (int lane = 0; lane < lanes; ++lane) {
          Eigen::Matrix3d& target =
              stresses[static_cast<size_t>(tets_.tet_at(b * TetBatches<T>::kLanes + lane))];
          for (int k = 0; k < 9; ++k)
            target(k / 3, k % 3) += stress_unit_ * double{stress(k / 3, k % 3)[lane]};
        }
      }
    });
  }

  // In units of stress.
  T EnergyDensity(int64_t b, const Matrix3<T>& g) const {
    T density = Law::Energy(g, Law::KinematicsOf(g), lame(b));
    if constexpr (Fibres<T>::kPresent) {
      Matrix3<T> stress = {};
      density += fibres_.AddStress(b, g, stress);
    }
    return density;
  }

  // Pa, a power of two: in float near the largest modulus, so that no product leaves the range.
  static double StressUnit(const ElasticPart& part) {
    if constexpr (std::is_same_v<T, Double4>) return 1;
    double largest = 0;
    for (const auto& lame : part.lame) largest = std::max(largest, lame.mu);
    for (const FibreFamilyPart& family : part.fibres) {
      for (const double stiffness : family.stiffness) largest = std::max(largest, stiffness);
    }
    return std::exp2(std::ilogb(largest));
  }

  Deformation<T> DeformationOf(int64_t b, const NodalVector& displacements) const {
    const TetBatch<T>& batch = tets_.batches[static_cast<size_t>(b)];
    return shape_.DeformationOf(b, batch.gradient,
                                VertexMoves(batch, displacements.data(), tets_.length_unit));
  }

  const LameConstants<T>& lame(int64_t batch) const {
    return lame_[static_cast<size_t>(batch * lame_stride_)];
  }

  const TetMesh& mesh_;
  TetBatches<T> tets_;
  const double stress_unit_;            // Pa, of all stresses and moduli in float; in double 1
  std::vector<LameConstants<T>> lame_;  // a batch each, or one for all
  int64_t lame_stride_ = 0;
  [[no_unique_address]] Fibres<T> fibres_;
  [[no_unique_address]] Shape<T> shape_;
  const bool fibres_break_;
  bool fibres_are_upright_ = true;    // in all batches that passes keep to
  std::vector<double> chunk_energy_;  // scratch
};

template <typename T, typename Law>
std::unique_ptr<TetTerm> MakeTermOfLaw(const TetMesh& mesh, const Incidence& incidence,
                                       ElasticPart part, FractureStress stress) {
  if (part.fibres.empty()) {
    return std::make_unique<ElasticTerm<T, Law, NoFibres, RestShape>>(
        mesh, incidence, std::move(part), stress, RestShape<T>());
  }
  return std::make_unique<ElasticTerm<T, Law, FibreFamilies, RestShape>>(
      mesh, incidence, std::move(part), stress, RestShape<T>());
}

template <typename T>
std::unique_ptr<TetTerm> MakeTermOf(const TetMesh& mesh, const Incidence& incidence,
                                    ElasticPart part, FractureStress stress) {
  switch (part.law) {
    case ElasticLaw::kInvertibleNeoHookean:
      return MakeTermOfLaw<T, InvertibleNeoHookean>(mesh, incidence, std::move(part), stress);
    case ElasticLaw::kCorotatedLinear:
      return MakeTermOfLaw<T, CorotatedLinear>(mesh, incidence, std::move(part), stress);
    case ElasticLaw::kStVenantKirchhoff:
      return MakeTermOfLaw<T, StVenantKirchhoff>(mesh, incidence, std::move(part), stress);
    case ElasticLaw::kStableNeoHookean:
      break;
  }
  return MakeTermOfLaw<T, StableNeoHookean>(mesh, incidence, std::move(part), stress);
}

// In a file each: every one of them is eight terms.
extern template std::unique_ptr<TetTerm> MakeTermOf<Double4>(const TetMesh&, const Incidence&,
                                                             ElasticPart, FractureStress);
extern template std::unique_ptr<TetTerm> MakeTermOf<Float8>(const TetMesh&, const Incidence&,
                                                            ElasticPart, FractureStress);

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_ELASTIC_PASSES_H_
