#ifndef CLEAVE_CORE_MODEL_EDGE_PROJECTED_TERM_H_
#define CLEAVE_CORE_MODEL_EDGE_PROJECTED_TERM_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "core/damage/edge_mask.h"
#include "core/damage/edge_projection.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/model/tet_term.h"

namespace cleave {

// The energy of tets that have lost edges but still hang together, where the scene asks for
// edge-projected damage, and of strands (fracture.h), which need not: psi = beta / 2 e^T A' e over
// the Green strains e of the unbroken edges, with the broken ones condensed out and beta <= 1 such
// that energy never rises at a break. Forces lie along unbroken edges, so none crosses a full cut.
// Such tets are here and not in other terms, whose damage factor for them is 0. Source: method
// note, section 3.
class EdgeProjectedTerm final : public TetTerm {
 public:
  // Holds no tet at first. `mesh` and `incidence` must outlive the term.
  EdgeProjectedTerm(const TetMesh& mesh, const Incidence& incidence)
      : mesh_(mesh), incidence_(incidence) {}

  // Takes over a tet, or what more broken edges leave of one that it has. `moduli` as AddRestModuli
  // of the terms add them up. beta is `factor`, the tet's damage factor, at most. `energy` (J) is
  // what the tet had at these displacements until now: it has no more from now on.
  void Weaken(int64_t tet, EdgeMask broken, const Matrix6& moduli, double factor, double energy,
              const NodalVector& displacements);
  // Takes over a tet with a beta in [0, 1] from an earlier betas().
  void Put(int64_t tet, EdgeMask broken, const Matrix6& moduli, double beta);
  void Clear() { tets_.clear(); }
  // Of all tets that it has, by tet.
  std::vector<double> betas() const;

  absl::string_view name() const override { return "edge-projected tets"; }
  int64_t bytes() const override;
  double AddForces(const NodalVector& displacements, NodalVector& forces) override;
  void AddStiffness(const NodalVector& displacements, Curvature curvature,
                    EdgeBlocks& blocks) override;
  // The terms that had the tets before still tell their stress.
  void AddEffectiveStress(const NodalVector&, std::span<Eigen::Matrix3d>) const override {}
  // 0 takes a tet away; other factors change nothing, because beta is all the damage there is.
  void SetDamageFactor(int64_t tet, double factor) override;
  double TetEnergy(int64_t tet, const NodalVector& displacements) const override;
  void AddRestModuli(int64_t, Matrix6&) const override {}

  // Bytes of a tet.
  static int64_t TetBytes();

 private:
  struct Tet {
    int32_t tet;
    double beta;
    Matrix6 moduli;  // J/m^4, by q as in EdgeModuli, condensed, times rest volume and beta
    // Scratch of a pass.
    double energy;       // J
    Double4 force[4];    // N
    float block[6][12];  // N/m, column by column, for the smaller node first
  };
  struct Edges;  // current edges of a tet

  std::vector<std::unique_ptr<Tet>>::iterator Find(int64_t tet);
  const Tet* Get(int64_t tet) const;

  const TetMesh& mesh_;
  const Incidence& incidence_;
  std::vector<std::unique_ptr<Tet>> tets_;  // by tet
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_EDGE_PROJECTED_TERM_H_
