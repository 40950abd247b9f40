#include "core/model/fibre_term.h"

#include <atomic>

#include "core/material/fibre.h"
#include "core/model/batch_scatter.h"
#include "core/model/tet_batches.h"

namespace cleave {
namespace {

// The fibres of a batch of tets.
struct FibreBatch {
  Double4 direction[3];  // a
  Double4 stiffness;     // Pa
  Double4 sign;
};

// How far a unit displacement of each vertex stretches the fibre: gradient . a, 1/m.
struct FibreGradient {
  Double4 of_vertex[4];

  FibreGradient(const TetBatch& batch, const FibreBatch& fibres) {
    for (int vertex = 1; vertex < 4; ++vertex) {
      const Double4* g = batch.gradient[vertex - 1];
      of_vertex[vertex] =
          g[0] * fibres.direction[0] + g[1] * fibres.direction[1] + g[2] * fibres.direction[2];
    }
    of_vertex[0] = -(of_vertex[1] + of_vertex[2] + of_vertex[3]);
  }
};

FibreStretch StretchOf(const TetBatch& batch, const FibreBatch& fibres,
                       const FibreGradient& gradient, const Double4* displacements) {
  Double4 moved[3] = {Splat(0), Splat(0), Splat(0)};  // G a
  Double4 base[4];
  for (size_t vertex = 0; vertex < 4; ++vertex) {
    Double4 at[4];  // [lane], then [axis]
    for (size_t lane = 0; lane < kLanes; ++lane)
      at[lane] = displacements[batch.nodes[vertex][lane]];
    Transpose(at[0], at[1], at[2], at[3]);
    for (int i = 0; i < 3; ++i) {
      if (vertex == 0) {
        base[i] = at[i];
      } else {
        moved[i] += gradient.of_vertex[vertex] * (at[i] - base[i]);
      }
    }
  }
  FibreStretch stretch = StretchFibre(fibres.direction, moved, fibres.sign);
  if (Any(IsCollapsed(stretch))) {
    SetCollapsedDirection(ComputeSvd(DisplacementGradient(batch, displacements)), fibres.direction,
                          stretch);
  }
  return stretch;
}

class FibreTerm final : public TetTerm {
 public:
  FibreTerm(const TetMesh& mesh, const Incidence& incidence, const FibreFamilyPart& family,
            FractureStress stress)
      : mesh_(mesh),
        tets_(BuildTetBatches(mesh, incidence, family.tets)),
        stress_(stress),
        fibres_(tets_.batches.size()) {
    for (size_t b = 0; b < fibres_.size(); ++b) {
      for (size_t lane = 0; lane < kLanes; ++lane) {
        // Lanes past the last tet repeat it.
        const size_t place = std::min(b * kLanes + lane, family.tets.size() - 1);
        for (size_t i = 0; i < 3; ++i) fibres_[b].direction[i][lane] = family.directions[place][i];
        fibres_[b].stiffness[lane] = family.stiffness[place];
      }
      fibres_[b].sign = Splat(1);
    }
    chunk_energy_.resize((tets_.batches.size() + TetBatches::kChunkBatches - 1) /
                         TetBatches::kChunkBatches);
  }

  absl::string_view name() const override { return "fibres"; }

  int64_t bytes() const override { return FibreTermBytes(tets_.tet_count); }

  bool ChooseBranches(const NodalVector& displacements) override {
    std::atomic<bool> changed = false;
    ParallelFor(static_cast<int64_t>(fibres_.size()), 512, [&](int64_t begin, int64_t end) {
      for (int64_t b = begin; b < end; ++b) {
        FibreBatch& fibres = fibres_[static_cast<size_t>(b)];
        Matrix3<Double4> g =
            DisplacementGradient(tets_.batches[static_cast<size_t>(b)], displacements.data());
        Matrix3<Double4> f = g;
        for (int i = 0; i < 3; ++i) f(i, i) += 1.0;
        const Matrix3<Double4> cofactor = Cofactor(f);
        const Double4 volume =
            f(0, 0) * cofactor(0, 0) + f(0, 1) * cofactor(0, 1) + f(0, 2) * cofactor(0, 2);
        const Int64x4 inverted = volume < 0;
        Double4 sign = Splat(1);
        if (Any(inverted)) sign = inverted ? FibreSign(ComputeSvd(g), fibres.direction) : Splat(1);
        if (!Any(sign != fibres.sign)) continue;
        fibres.sign = sign;
        changed = true;
      }
    });
    return changed;
  }

  double AddForces(const NodalVector& displacements, NodalVector& forces) override {
    ForEachChunk(tets_, [&](int64_t chunk, int64_t begin, int64_t end) {
      Double4 energy = Splat(0);
      for (int64_t b = begin; b < end; ++b) {
        const TetBatch& batch = tets_.batches[static_cast<size_t>(b)];
        const FibreBatch& fibres = fibres_[static_cast<size_t>(b)];
        const FibreGradient gradient(batch, fibres);
        const FibreStretch stretch = StretchOf(batch, fibres, gradient, displacements.data());
        const Double4 pull = batch.volume * fibres.stiffness * stretch.excess;
        energy += 0.5 * pull * stretch.excess;
        Double4 force[4][4];
        for (int vertex = 0; vertex < 4; ++vertex) {
          for (int axis = 0; axis < 3; ++axis)
            force[vertex][axis] = -pull * gradient.of_vertex[vertex] * stretch.direction[axis];
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
        const FibreBatch& fibres = fibres_[static_cast<size_t>(b)];
        const FibreGradient gradient(batch, fibres);
        const FibreStretch stretch = StretchOf(batch, fibres, gradient, displacements.data());
        Double4 across = FibreStiffnessAcross(stretch);
        if (curvature == Curvature::kSemidefinite) across = Max(across, Splat(0));
        const Double4* d = stretch.direction;
        Double4 stiffness[9];
        for (int column = 0; column < 3; ++column) {
          for (int row = 0; row < 3; ++row) {
            const Double4 along = (1.0 - across) * d[row] * d[column];
            stiffness[3 * column + row] = row == column ? along + across : along;
          }
        }
        const Double4 scale = batch.volume * fibres.stiffness;
        for (size_t edge = 0; edge < 6; ++edge) {
          const Double4 weight = -scale * gradient.of_vertex[kTetEdges[edge][0]] *
                                 gradient.of_vertex[kTetEdges[edge][1]];
          for (int k = 0; k < 9; ++k) element.block[edge][k] = weight * stiffness[k];
        }
        ScatterBlocks(batch, tets_.lanes(b), element, blocks.data());
      }
    });
  }

  void AddEffectiveStress(const NodalVector& displacements,
                          std::span<Eigen::Matrix3d> stresses) const override {
    if (stress_ == FractureStress::kMatrix) return;
    ParallelFor(static_cast<int64_t>(fibres_.size()), 512, [&](int64_t begin, int64_t end) {
      for (int64_t b = begin; b < end; ++b) {
        const TetBatch& batch = tets_.batches[static_cast<size_t>(b)];
        const FibreBatch& fibres = fibres_[static_cast<size_t>(b)];
        const FibreStretch stretch =
            StretchOf(batch, fibres, FibreGradient(batch, fibres), displacements.data());
        const Double4 pull = fibres.stiffness * stretch.excess;
        for (int lane = 0; lane < tets_.lanes(b); ++lane) {
          Eigen::Matrix3d& target = stresses[static_cast<size_t>(tets_.tet_at(b * kLanes + lane))];
          for (int i = 0; i < 3; ++i) {
            for (int j = 0; j < 3; ++j)
              target(i, j) += pull[lane] * stretch.direction[i][lane] * fibres.direction[j][lane];
          }
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
    const FibreBatch& fibres = fibres_[static_cast<size_t>(place / kLanes)];
    const FibreStretch stretch =
        StretchOf(batch, fibres, FibreGradient(batch, fibres), displacements.data());
    return (0.5 * batch.volume * fibres.stiffness * stretch.excess *
            stretch.excess)[place % kLanes];
  }

  void AddRestModuli(int64_t tet, Matrix6& moduli) const override {
    const int64_t place = tets_.place_of(tet);
    if (place < 0) return;
    const FibreBatch& fibres = fibres_[static_cast<size_t>(place / kLanes)];
    Eigen::Vector3d direction;
    for (int i = 0; i < 3; ++i) direction[i] = fibres.direction[i][place % kLanes];
    const Vector6 along = ToMandel(direction * direction.transpose());
    moduli += fibres.stiffness[place % kLanes] * along * along.transpose();
  }

 private:
  const TetMesh& mesh_;
  TetBatches tets_;
  const FractureStress stress_;
  std::vector<FibreBatch> fibres_;
  std::vector<double> chunk_energy_;  // J, scratch
};

}  // namespace

std::unique_ptr<TetTerm> MakeFibreTerm(const TetMesh& mesh, const Incidence& incidence,
                                       const FibreFamilyPart& family, FractureStress stress) {
  return std::make_unique<FibreTerm>(mesh, incidence, family, stress);
}

int64_t FibreTermBytes(int64_t tet_count) {
  const int64_t batches = (tet_count + kLanes - 1) / kLanes;
  return batches * static_cast<int64_t>(sizeof(TetBatch) + sizeof(FibreBatch)) +
         tet_count * static_cast<int64_t>(sizeof(int32_t));
}

}  // namespace cleave
