#include "core/model/elastic_term.h"

#include <utility>

#include "core/material/corotated_linear.h"
#include "core/material/invertible_neo_hookean.h"
#include "core/material/isotropic_stiffness.h"
#include "core/material/st_venant_kirchhoff.h"
#include "core/material/stable_neo_hookean.h"
#include "core/model/batch_scatter.h"
#include "core/model/tet_batches.h"

namespace cleave {
namespace {

// Source: method note, section 5; in the frame of the singular values the second derivative is
// sparse, so the blocks are built there from turned gradients and turned back.
void ElementBlocks(const TetBatch& batch, const SignedSvd& svd, const StiffnessSpectrum& spectrum,
                   BatchBlocks& out) {
  Double4 gradient[4][3];  // of every vertex, in the frame of V
  for (int i = 0; i < 3; ++i) {
    for (int vertex = 1; vertex < 4; ++vertex) {
      const Double4* g = batch.gradient[vertex - 1];
      gradient[vertex][i] = g[0] * svd.v(0, i) + g[1] * svd.v(1, i) + g[2] * svd.v(2, i);
    }
    gradient[0][i] = -(gradient[1][i] + gradient[2][i] + gradient[3][i]);
  }
  // Of a pair of off-diagonal entries: how each follows itself and how it follows the other.
  // The minus sign of the block is taken in here, with the volume.
  Double4 itself[3], other[3], axial[3][3];
  for (int k = 0; k < 3; ++k) {
    itself[k] = -0.5 * batch.volume * (spectrum.symmetric[k] + spectrum.skew[k]);
    other[k] = -0.5 * batch.volume * (spectrum.symmetric[k] - spectrum.skew[k]);
    for (int i = 0; i < 3; ++i) axial[k][i] = -batch.volume * spectrum.axial[k][i];
  }
  for (size_t edge = 0; edge < 6; ++edge) {
    const Double4* a = gradient[kTetEdges[edge][0]];
    const Double4* b = gradient[kTetEdges[edge][1]];
    Matrix3<Double4> turned;
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      turned(i, i) =
          axial[i][i] * a[i] * b[i] + itself[k] * (a[j] * b[j]) + itself[j] * (a[k] * b[k]);
      turned(i, j) = axial[i][j] * (a[i] * b[j]) + other[k] * (a[j] * b[i]);
      turned(j, i) = axial[j][i] * (a[j] * b[i]) + other[k] * (a[i] * b[j]);
    }
    const Matrix3<Double4> half = svd.u * turned;
    for (int column = 0; column < 3; ++column) {
      for (int row = 0; row < 3; ++row) {
        out.block[edge][3 * column + row] = half(row, 0) * svd.u(column, 0) +
                                            half(row, 1) * svd.u(column, 1) +
                                            half(row, 2) * svd.u(column, 2);
      }
    }
  }
}

template <typename Law>
class ElasticTerm final : public TetTerm {
 public:
  ElasticTerm(const TetMesh& mesh, const Incidence& incidence, std::vector<int32_t> tets,
              std::vector<LameConstants<double>> lame)
      : mesh_(mesh), tets_(BuildTetBatches(mesh, incidence, std::move(tets))) {
    const bool uniform = lame.size() == 1;
    lame_stride_ = uniform ? 0 : 1;
    lame_.resize(uniform ? 1 : tets_.batches.size());
    for (size_t b = 0; b < lame_.size(); ++b) {
      for (size_t lane = 0; lane < kLanes; ++lane) {
        const auto& of_tet = lame[std::min(b * kLanes + lane, lame.size() - 1)];
        lame_[b].mu[lane] = of_tet.mu;
        lame_[b].lambda[lane] = of_tet.lambda;
      }
    }
    chunk_energy_.resize((tets_.batches.size() + TetBatches::kChunkBatches - 1) /
                         TetBatches::kChunkBatches);
  }

  absl::string_view name() const override { return "elasticity"; }

  int64_t bytes() const override {
    return static_cast<int64_t>(tets_.batches.size() * sizeof(TetBatch) +
                                tets_.tets.size() * sizeof(int32_t) +
                                lame_.size() * sizeof(LameConstants<Double4>));
  }

  double AddForces(const NodalVector& displacements, NodalVector& forces) override {
    ForEachChunk(tets_, [&](int64_t chunk, int64_t begin, int64_t end) {
      Double4 energy = Splat(0);
      for (int64_t b = begin; b < end; ++b) {
        const TetBatch& batch = tets_.batches[static_cast<size_t>(b)];
        const Matrix3<Double4> g = DisplacementGradient(batch, displacements.data());
        const auto kinematics = Law::KinematicsOf(g);
        energy += batch.volume * Law::Energy(g, kinematics, lame(b));
        const Matrix3<Double4> stress = Law::Stress(g, kinematics, lame(b));
        Double4 force[4][4];  // [vertex][axis], then [vertex][lane]
        for (int axis = 0; axis < 3; ++axis) {
          for (int vertex = 1; vertex < 4; ++vertex) {
            const Double4* gradient = batch.gradient[vertex - 1];
            force[vertex][axis] =
                -batch.volume * (stress(axis, 0) * gradient[0] + stress(axis, 1) * gradient[1] +
                                 stress(axis, 2) * gradient[2]);
          }
          force[0][axis] = -(force[1][axis] + force[2][axis] + force[3][axis]);
        }
        ScatterForces(batch, tets_.lanes(b), force, forces);
      }
      chunk_energy_[static_cast<size_t>(chunk)] = Sum(energy);
    });
    double energy = 0;
    for (const double of_chunk : chunk_energy_) energy += of_chunk;
    return energy;
  }

  void AddStiffness(const NodalVector& displacements, Curvature curvature,
                    EdgeBlocks& blocks) override {
    ForEachChunk(tets_, [&](int64_t, int64_t begin, int64_t end) {
      BatchBlocks element;
      for (int64_t b = begin; b < end; ++b) {
        const TetBatch& batch = tets_.batches[static_cast<size_t>(b)];
        const SignedSvd svd = ComputeSvd(DisplacementGradient(batch, displacements.data()));
        StiffnessSpectrum spectrum = Law::Spectrum(svd, lame(b));
        if (curvature == Curvature::kSemidefinite) ProjectToSemidefinite(spectrum);
        ElementBlocks(batch, svd, spectrum, element);
        ScatterBlocks(batch, tets_.lanes(b), element, blocks.data());
      }
    });
  }

  void AddEffectiveStress(const NodalVector& displacements,
                          std::span<Eigen::Matrix3d> stresses) const override {
    ParallelFor(static_cast<int64_t>(tets_.batches.size()), 512, [&](int64_t begin, int64_t end) {
      for (int64_t b = begin; b < end; ++b) {
        const Matrix3<Double4> g =
            DisplacementGradient(tets_.batches[static_cast<size_t>(b)], displacements.data());
        const Matrix3<Double4> stress = Law::Stress(g, Law::KinematicsOf(g), lame(b));
        const int lanes = tets_.lanes(b);
        for (int lane = 0; lane < lanes; ++lane) {
          Eigen::Matrix3d& target = stresses[static_cast<size_t>(tets_.tet_at(b * kLanes + lane))];
          for (int k = 0; k < 9; ++k) target(k / 3, k % 3) += stress(k / 3, k % 3)[lane];
        }
      }
    });
  }

  void SetDamageFactor(int64_t tet, double factor) override {
    const int64_t place = tets_.place_of(tet);
    if (place < 0) return;
    tets_.batches[static_cast<size_t>(place / kLanes)].volume[place % kLanes] =
        factor * RestVolume(mesh_, tet);
  }

  double TetEnergy(int64_t tet, const NodalVector& displacements) const override {
    const int64_t place = tets_.place_of(tet);
    if (place < 0) return 0;
    const TetBatch& batch = tets_.batches[static_cast<size_t>(place / kLanes)];
    const Matrix3<Double4> g = DisplacementGradient(batch, displacements.data());
    const Double4 density = Law::Energy(g, Law::KinematicsOf(g), lame(place / kLanes));
    return (batch.volume * density)[place % kLanes];
  }

  void AddRestModuli(int64_t tet, Matrix6& moduli) const override {
    const int64_t place = tets_.place_of(tet);
    if (place < 0) return;
    const LameConstants<Double4>& of_batch = lame(place / kLanes);
    moduli.diagonal().array() += 2 * of_batch.mu[place % kLanes];
    moduli.topLeftCorner<3, 3>().array() += of_batch.lambda[place % kLanes];
  }

 private:
  const LameConstants<Double4>& lame(int64_t batch) const {
    return lame_[static_cast<size_t>(batch * lame_stride_)];
  }

  const TetMesh& mesh_;
  TetBatches tets_;
  std::vector<LameConstants<Double4>> lame_;  // a batch each, or one for all
  int64_t lame_stride_ = 0;
  std::vector<double> chunk_energy_;  // J, scratch
};

}  // namespace

std::unique_ptr<TetTerm> MakeElasticTerm(ElasticLaw law, const TetMesh& mesh,
                                         const Incidence& incidence, std::vector<int32_t> tets,
                                         std::vector<LameConstants<double>> lame) {
  switch (law) {
    case ElasticLaw::kInvertibleNeoHookean:
      return std::make_unique<ElasticTerm<InvertibleNeoHookean>>(mesh, incidence, std::move(tets),
                                                                 std::move(lame));
    case ElasticLaw::kCorotatedLinear:
      return std::make_unique<ElasticTerm<CorotatedLinear>>(mesh, incidence, std::move(tets),
                                                            std::move(lame));
    case ElasticLaw::kStVenantKirchhoff:
      return std::make_unique<ElasticTerm<StVenantKirchhoff>>(mesh, incidence, std::move(tets),
                                                              std::move(lame));
    case ElasticLaw::kStableNeoHookean:
      break;
  }
  return std::make_unique<ElasticTerm<StableNeoHookean>>(mesh, incidence, std::move(tets),
                                                         std::move(lame));
}

}  // namespace cleave
