#ifndef CLEAVE_CORE_MODEL_FIBRE_FAMILIES_H_
#define CLEAVE_CORE_MODEL_FIBRE_FAMILIES_H_

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/base/lanes.h"
#include "core/base/matrix3.h"
#include "core/material/fibre.h"
#include "core/mesh/incidence.h"
#include "core/model/curvature.h"
#include "core/model/elastic_term.h"
#include "core/scene/limits.h"

namespace cleave {

// A family of fibres in a batch of tets.
template <typename T>
struct FibreBatch {
  T direction[3];  // a
  T stiffness;     // in the term's unit of stress
  T sign;          // the branch of the energy
};

// What fibres add to the blocks of a batch (element_blocks.h).
template <typename T>
struct FibreBlocks {
  struct Family {
    T by_entry[9];   // column by column
    T stretched[4];  // how far a unit displacement of each vertex stretches the fibre
  };
  Family families[limits::kMaxFibreFamilies];
  int count = 0;

  void AddTo(size_t edge, T* block) const {
    for (int family = 0; family < count; ++family) {
      const T* stretched = families[family].stretched;
      const T weight = stretched[kTetEdges[edge][0]] * stretched[kTetEdges[edge][1]];
      for (int k = 0; k < 9; ++k) block[k] += weight * families[family].by_entry[k];
    }
  }
};

struct NoBlocks {
  template <typename T>
  void AddTo(size_t /*edge*/, T* /*block*/) const {}
};

// What an elastic term has where its tets have no fibres.
template <typename T>
struct NoFibres {
  static constexpr bool kPresent = false;
  NoFibres(const std::vector<FibreFamilyPart>&, int64_t /*batch_count*/, double /*stress_unit*/) {}
  int64_t bytes() const { return 0; }
  NoBlocks BlocksOf(int64_t /*b*/, const Matrix3<T>& /*g*/, const Matrix3<T>& /*gradient*/,
                    const T& /*scale*/, Curvature /*curvature*/) const {
    return {};
  }
};

// The families of fibres in the tets of an elastic term. Batches are given by their index and by
// the deformation in them: `g`, F - I, and `gradient`, that of the shape functions.
template <typename T>
class FibreFamilies {
 public:
  static constexpr bool kPresent = true;

  FibreFamilies(const std::vector<FibreFamilyPart>& parts, int64_t batch_count,
                double stress_unit) {
    using Scalar = typename Lanes<T>::Scalar;
    for (const FibreFamilyPart& part : parts) {
      std::vector<FibreBatch<T>>& family = families_.emplace_back(static_cast<size_t>(batch_count));
      for (size_t b = 0; b < family.size(); ++b) {
        for (size_t lane = 0; lane < Lanes<T>::kCount; ++lane) {
          // Lanes past the last tet repeat it.
          const size_t place = std::min(b * Lanes<T>::kCount + lane, part.stiffness.size() - 1);
          for (size_t i = 0; i < 3; ++i)
            family[b].direction[i][lane] = static_cast<Scalar>(part.directions[place][i]);
          family[b].stiffness[lane] = static_cast<Scalar>(part.stiffness[place] / stress_unit);
        }
        family[b].sign = Splat<T>(1);
      }
    }
  }

  int64_t bytes() const {
    int64_t bytes = 0;
    for (const auto& family : families_)
      bytes += static_cast<int64_t>(family.size() * sizeof(FibreBatch<T>));
    return bytes;
  }

  // Whether no fibre of a batch is turned over.
  bool AreUpright(int64_t b) const {
    return std::none_of(families_.begin(), families_.end(), [b](const auto& family) {
      return Any(family[static_cast<size_t>(b)].sign < 0);
    });
  }

  // Whether that changed any sign.
  bool ChooseSigns(int64_t b, const Matrix3<T>& g, BranchChoice choice) {
    Matrix3<T> f = g;
    for (int i = 0; i < 3; ++i) f(i, i) += 1.0;
    const Matrix3<T> cofactor = Cofactor(f);
    const T volume = f(0, 0) * cofactor(0, 0) + f(0, 1) * cofactor(0, 1) + f(0, 2) * cofactor(0, 2);
    const auto inverted = volume < 0;
    const bool any_inverted = Any(inverted);
    bool changed = false;
    for (auto& family : families_) {
      FibreBatch<T>& fibres = family[static_cast<size_t>(b)];
      T sign = Splat<T>(1);
      if (any_inverted) sign = inverted ? FibreSign(ComputeSvd(g), fibres.direction) : sign;
      // A fibre that is turned over never has less energy than an upright one of its length.
      if (choice != BranchChoice::kStart) sign = Max(sign, fibres.sign);
      if (!Any(sign != fibres.sign)) continue;
      fibres.sign = sign;
      changed = true;
    }
    return changed;
  }

  // Adds the first Piola-Kirchhoff stress to `stress`; returns the energy density.
  T AddStress(int64_t b, const Matrix3<T>& g, Matrix3<T>& stress) const {
    T energy = T{};
    for (const auto& family : families_) {
      const FibreBatch<T>& fibres = family[static_cast<size_t>(b)];
      const FibreStretch<T> stretch = StretchOf(fibres, g);
      const T pull = fibres.stiffness * stretch.excess;
      energy += 0.5 * pull * stretch.excess;
      for (int i = 0; i < 3; ++i) {
        const T along = pull * stretch.direction[i];
        for (int j = 0; j < 3; ++j) stress(i, j) += along * fibres.direction[j];
      }
    }
    return energy;
  }

  // `scale` times the second derivative.
  FibreBlocks<T> BlocksOf(int64_t b, const Matrix3<T>& g, const Matrix3<T>& gradient,
                          const T& scale, Curvature curvature) const {
    FibreBlocks<T> blocks;
    for (const auto& family : families_) {
      const FibreBatch<T>& fibres = family[static_cast<size_t>(b)];
      const FibreStretch<T> stretch = StretchOf(fibres, g);
      T across = FibreStiffnessAcross(stretch);
      if (curvature == Curvature::kSemidefinite) across = Max(across, T{});
      const T* d = stretch.direction;
      const T stiffness = -scale * fibres.stiffness;
      auto& of_family = blocks.families[blocks.count++];
      for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
          const T along = (1.0 - across) * d[row] * d[column];
          of_family.by_entry[3 * column + row] =
              stiffness * (row == column ? along + across : along);
        }
      }
      T* stretched = of_family.stretched;
      for (int vertex = 1; vertex < 4; ++vertex) {
        stretched[vertex] = gradient(vertex - 1, 0) * fibres.direction[0] +
                            gradient(vertex - 1, 1) * fibres.direction[1] +
                            gradient(vertex - 1, 2) * fibres.direction[2];
      }
      stretched[0] = -(stretched[1] + stretched[2] + stretched[3]);
    }
    return blocks;
  }

  // As TetTerm::AddRestModuli, for the tet in a lane of a batch.
  void AddRestModuli(int64_t b, int64_t lane, double stress_unit, Matrix6& moduli) const {
    for (const auto& family : families_) {
      const FibreBatch<T>& fibres = family[static_cast<size_t>(b)];
      Eigen::Vector3d direction;
      for (int i = 0; i < 3; ++i) direction[i] = fibres.direction[i][lane];
      const Vector6 along = ToMandel(direction * direction.transpose());
      moduli += stress_unit * double{fibres.stiffness[lane]} * along * along.transpose();
    }
  }

 private:
  static FibreStretch<T> StretchOf(const FibreBatch<T>& fibres, const Matrix3<T>& g) {
    const T* a = fibres.direction;
    T moved[3];  // G a
    for (int i = 0; i < 3; ++i) moved[i] = g(i, 0) * a[0] + g(i, 1) * a[1] + g(i, 2) * a[2];
    FibreStretch<T> stretch = StretchFibre(a, moved, fibres.sign);
    if (Any(IsCollapsed(stretch))) SetCollapsedDirection(ComputeSvd(g), a, stretch);
    return stretch;
  }

  std::vector<std::vector<FibreBatch<T>>> families_;  // [family][batch]
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_FIBRE_FAMILIES_H_
