#ifndef CLEAVE_CORE_MODEL_TET_TERM_H_
#define CLEAVE_CORE_MODEL_TET_TERM_H_

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "core/base/bytes.h"
#include "core/damage/edge_projection.h"
#include "core/model/curvature.h"
#include "core/model/nodal_vector.h"

namespace cleave {

// Stiffness between the two nodes of every edge, N/m: block e is the 3x3 matrix B = -d2 Psi /
// dx_i dx_j of edge e = (i, j), i < j, stored column by column at 9 * e. The blocks at a node
// follow: energy does not change under translation, so K_ii = sum of the blocks of its edges, and
// (K x)_i = sum_j B_ij (x_i - x_j). That form is exact for translations even in float, which the
// sum of a stored float diagonal would not be. One block more than edges, so that the last may be
// read four floats at a time.
using EdgeBlocks = std::vector<float>;

inline size_t EdgeBlocksSize(int64_t edge_count) { return 9 * static_cast<size_t>(edge_count + 1); }

// When branches of energies that jump are chosen.
enum class BranchChoice {
  kStart,     // of a time step: those of the displacements
  kTrial,     // at a trial of a solve: only ones of less energy than those chosen before
  kAccepted,  // where a solve starts or goes on: those without which it cannot
};

// An elastic energy over some tets or all. Ids are the solver's. Loops run on the caller's
// TBB arena and give the same bits for any number of threads.
class TetTerm {
 public:
  virtual ~TetTerm() = default;
  virtual absl::string_view name() const = 0;
  // Bytes that this term holds.
  virtual int64_t bytes() const = 0;

  // Chooses the branch of an energy that jumps, at these displacements; it holds until the next
  // call. True where that changed any tet's energy.
  virtual bool ChooseBranches(const NodalVector& displacements, BranchChoice choice) {
    (void)displacements;
    (void)choice;
    return false;
  }
  // Adds -dPsi/dx (N) at displacements from rest (m) to `forces`; returns the energy, J.
  virtual double AddForces(const NodalVector& displacements, NodalVector& forces) = 0;
  // Adds every tet's second derivative to `blocks`; for kSemidefinite with negative eigenvalues at
  // 0.
  virtual void AddStiffness(const NodalVector& displacements, Curvature curvature,
                            EdgeBlocks& blocks) = 0;
  // Adds the first Piola-Kirchhoff stress that may break edges, Pa, to that of each tet (a record a
  // tet of the mesh), without the damage factor.
  virtual void AddEffectiveStress(const NodalVector& displacements,
                                  std::span<Eigen::Matrix3d> stresses) const = 0;
  // Leaves tets of pieces that sleep out of every pass until the next call. `asleep` holds a tet of
  // the mesh each, not 0 for those that may be left out, or nothing: then none is. Sets those of
  // the term's tets to 0 that it keeps all the same. Returns the energy at these displacements of
  // those that it leaves out, J. By default it keeps all.
  virtual double LeaveOut(std::span<uint8_t> asleep, const NodalVector& displacements) {
    (void)asleep;
    (void)displacements;
    return 0;
  }
  // Scales energy, force and stiffness of a tet by `factor`, in place of any earlier factor;
  // nothing where the term does not act in it.
  virtual void SetDamageFactor(int64_t tet, double factor) = 0;
  // The energy of one tet, J; 0 where the term does not act in it.
  virtual double TetEnergy(int64_t tet, const NodalVector& displacements) const = 0;
  // Adds the second derivative of a tet's energy density by Green strain at rest, Pa, in Mandel's
  // notation (edge_projection.h), without the damage factor; nothing where the term does not act.
  virtual void AddRestModuli(int64_t tet, Matrix6& moduli) const = 0;

  // What decides later steps besides displacements and damage. Restore refuses (DataLoss) what
  // cannot belong to this term, and then changes nothing.
  virtual void Save(ByteWriter& out) const { (void)out; }
  virtual absl::Status Restore(ByteReader& in) {
    (void)in;
    return absl::OkStatus();
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_TET_TERM_H_
