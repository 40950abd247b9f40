#ifndef CLEAVE_CORE_DAMAGE_FRACTURE_H_
#define CLEAVE_CORE_DAMAGE_FRACTURE_H_

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "core/base/broadcast.h"
#include "core/base/bytes.h"
#include "core/base/vec3.h"
#include "core/damage/edge_mask.h"
#include "core/damage/edge_stress.h"
#include "core/damage/plastic_tet.h"
#include "core/damage/strands.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// A tet whose damage factor falls below this carries nothing worth solving for: it is dead.
inline constexpr double kDeadFactor = 1e-3;

inline constexpr double kUnbreakable = std::numeric_limits<double>::infinity();  // Pa
inline constexpr double kFullStrength = 1;

// What edges withstand: thresholds times kappa times residual. A record an edge or one for all
// each.
struct EdgeStrengths {
  // The tensile thresholds alone are strengths.
  EdgeStrengths(Broadcast<double> tensile_thresholds)  // NOLINT(google-explicit-constructor)
      : tensile(tensile_thresholds) {}

  Broadcast<double> tensile;  // Pa; infinite never breaks, 0 is cut at once; not negative or NaN
  // Pa, of compressive stress, > 0; infinite never breaks.
  Broadcast<double> compressive = Broadcast<double>::Uniform(kUnbreakable);
  Broadcast<double> kappa = Broadcast<double>::Uniform(kFullStrength);  // > 0, of impurities
  // What fatigue has left of both strengths, [0, 1]; at 0 an edge breaks under any load or none.
  Broadcast<double> residual = Broadcast<double>::Uniform(kFullStrength);
};

struct FractureSettings {
  double simultaneity = 0.9;  // edges at this share of their component's worst ratio break with it
  StressAggregation aggregation = StressAggregation::kMean;
  // Edge-projected, a damaged tet keeps factor 1 for as long as it hangs together: others weaken
  // it.
  Reformulation reformulation = Reformulation::kUniform;
};

// A tet whose damage factor fell, or that lost edges where it is edge-projected or a strand.
struct ChangedTet {
  int32_t tet;
  double previous_factor;
};

// What one break pass did. The spans stay valid until the next call on the same EdgeFracture.
struct PassResult {
  // Largest failure ratio over live edges, all edges unbroken so far. Below 1 nothing broke, and it
  // is then that of the edges whose strength the stress of a tet of theirs reached, 0 where there
  // is none; an upper bound where no tet's stress reached the smallest strength.
  double max_ratio = 0;
  int32_t max_edge = -1;  // an edge of that ratio, the lowest id; -1 when only the bound is known
  std::span<const int32_t> broken_edges;     // newly broken, ascending, orphans included
  std::span<const ChangedTet> changed_tets;  // ascending
};

// The fracture state of a mesh: which edges are broken, and what that leaves of every tet. Source:
// method note, sections 2, 3 and 7; the departures from the paper are listed there.
//
// An edge's stress is d^T P N / |d| (Pa per rest area), d its current and N its unit rest vector, P
// the undamaged first Piola-Kirchhoff stress of a tet, taken over the edge's live tets; a tet with
// J <= 0 counts as stress 0 because it would read compression as tension. An edge fails when that
// reaches its tensile threshold, or minus its compressive one. A tet that loses edges keeps the
// share of its stress that the unbroken ones carry, frozen from then on; it dies once its vertices
// are separated.
//
// In tets that have flowed plastically P is dPsi/dF_e and N turns with F_p. There an edge fails too
// when its plastic strain over that at failure, taken over its tets as stress is, reaches kappa;
// not where its threshold is infinite.
//
// Damage factors never rise and broken edges never mend. A live edge is an unbroken one: the orphan
// rule breaks an edge when its last live tet dies.
//
// Strands, where tets have a law for them: what separation or a hinge would kill becomes a strand
// instead, and no other damage takes a tet below its residual factor. A strand is live, so that its
// unbroken edges are no orphans, but it is no part of the solid. Its stress says nothing, for the
// tet is torn open: its edges count as free of stress, and break with the last strand that has
// them. It joins no clusters at a node nor dies by them: strands may hang by a node. It dies for
// good once an unbroken edge of it is longer than its limit times rest length. Whoever gives it
// energy should give it that of its unbroken edges alone, so that no force crosses a cut: then
// pieces still are what unbroken edges join. Edges cut before the first step leave no strands.
//
// Not thread-safe; loops run on the caller's TBB arena. Results are the same bits for any number of
// threads. No call but the constructor and Restore allocates once its scratch has grown.
class EdgeFracture {
 public:
  // `mesh`, `incidence` and what `strengths` point to must outlive this object. Rest volumes are
  // positive. A tensile threshold of 0 is cut here and now. Strengths change later only as
  // LowerThresholds and UpdateThresholds say. simultaneity is in (0, 1].
  EdgeFracture(const TetMesh& mesh, const Incidence& incidence, const EdgeStrengths& strengths,
               const FractureSettings& settings, const StrandLaws& strands = {});

  // One break pass: kills strands beyond their limits; finds failure ratios; in each connected
  // component of the live mesh breaks every edge whose ratio is at least max(1, simultaneity * the
  // component's worst ratio); weakens tets; then applies separation, orphans and hinges until
  // nothing changes. Call it after each solve of a step until no edge breaks. `positions` (m) has a
  // node each, `effective_stress` (Pa, without the damage factor) a tet each; stresses of dead tets
  // are not read. NaN breaks nothing. `plastic` names the ductile tets, where there are any.
  PassResult BreakPass(std::span<const Vec3> positions,
                       std::span<const Eigen::Matrix3d> effective_stress,
                       const PlasticTets* plastic = nullptr);

  // To be called when the strengths of these edges have fallen; they count from the next pass on.
  void LowerThresholds(std::span<const int32_t> edges);
  // The same when any strengths have changed.
  void UpdateThresholds();

  // The aggregated stress of every edge, Pa, negative in compression; where the largest counts,
  // that of tension or of compression, whichever is the larger share of its strength. 0 for broken
  // edges and those of strands. `stresses` has an edge each.
  void EdgeStresses(std::span<const Vec3> positions,
                    std::span<const Eigen::Matrix3d> effective_stress, const PlasticTets* plastic,
                    std::span<double> stresses);

  // Share of its stiffness that each tet has left: 1 intact, 0 dead. Scales energy, force, Hessian.
  // Edge-projected tets have 1 until they die.
  std::span<const double> damage_factors() const { return factors_; }
  std::span<const EdgeMask> tet_masks() const { return masks_; }
  bool IsStrand(int32_t tet) const {
    const auto t = static_cast<size_t>(tet);
    return loads_[t] == kOut && factors_[t] > 0;
  }
  // Nonzero for a broken edge; an edge each.
  std::span<const uint8_t> edge_broken() const { return broken_; }
  std::vector<int32_t> BrokenEdges() const;  // ascending
  int64_t broken_edge_count() const { return broken_count_; }
  // Broken edges and dead tets: grows with any damage, so that in one run equal counts are the same
  // damage.
  int64_t damage_count() const { return broken_count_ + dead_count_; }
  // Components of the nodes through unbroken edges (components.h); counted anew after a change.
  int32_t ComponentCount();

  // Everything that BreakPass depends on besides the constructor's arguments. Restore refuses
  // (DataLoss) what cannot belong to this mesh, and then changes nothing.
  void Save(ByteWriter& out) const;
  absl::Status Restore(ByteReader& in);

 private:
  using Stress = std::span<const Eigen::Matrix3d>;

  // The aggregated stress of an edge as tension and as compression, Pa. They are of opposite sign
  // but where the largest stress of its tets counts.
  struct EdgeLoad {
    double tension, compression;
    double exhaustion = 0;  // of ductility
  };
  // What a tet's stress counts for.
  enum TetLoad : uint8_t {
    kOut,      // dead, or a strand: for good
    kNone,     // J <= 0
    kUpright,  // solid
    kHot,      // solid, and its stress or strain reaches the smallest threshold: edges may fail
  };

  // The smallest strength of an edge, Pa.
  double Weakest(int32_t edge) const;
  // Lowers the bounds of strengths to those of an edge.
  void LowerBounds(int32_t edge);
  // Sets `loads_` and `squared_bounds_`; returns the largest Frobenius norm of an upright tet's
  // stress.
  double WeighTets(std::span<const Vec3> positions, Stress effective_stress);
  // Makes ductile tets hot that may fail by strain; returns the largest exhaustion of a live one.
  double WeighStrains();
  // kPlastic: whether there are ductile tets.
  template <bool kPlastic>
  double Project(const EdgeDirections& directions, size_t tet, Stress effective_stress) const;
  template <bool kPlastic>
  EdgeLoad LoadOf(int32_t edge, std::span<const Vec3> positions, Stress effective_stress) const;
  // The failure ratio of an edge.
  template <bool kPlastic>
  double RatioOf(int32_t edge, std::span<const Vec3> positions, Stress effective_stress) const;
  template <bool kPlastic>
  void SetRatios(std::span<const Vec3> positions, Stress effective_stress);
  // Fills `pending_` with the edges that fail, and the ratio and edge of `result`.
  void FindFailing(std::span<const Vec3> positions, Stress effective_stress, PassResult& result);
  void CollectFailing();
  // Fills `torn_` with the strands that are longer than their limit.
  void FindTorn(std::span<const Vec3> positions);
  // Breaks the edges in `pending_` and the strands in `torn_`, weakens tets and applies the rules
  // to a fixed point.
  void BreakPending(std::span<const Vec3> positions, Stress effective_stress);
  void MarkBroken(int32_t edge);
  void Weaken(int32_t tet, double factor);
  // A rule takes a tet out of the solid: it dies, or is a strand from now on.
  void LeaveSolid(int32_t tet);
  double UnbrokenShare(int32_t tet, std::span<const Vec3> positions, Stress effective_stress) const;
  void BreakOrphans(int32_t tet);
  void KillHinges(int32_t node);
  void UpdateComponents();

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const EdgeStrengths strengths_;
  const FractureSettings settings_;
  double min_threshold_ = 0;          // Pa, at most the smallest threshold
  double min_kappa_ = kFullStrength;  // at most the smallest of an edge that may break
  std::vector<double> rest_volumes_;  // m^3, a tet each
  std::vector<uint8_t> broken_;       // an edge each
  std::vector<EdgeMask> masks_;       // a tet each
  std::vector<double> factors_;       // a tet each
  int64_t broken_count_ = 0;
  int64_t dead_count_ = 0;  // tets
  StrandLaws strands_;
  std::vector<int32_t> components_;  // a node each; of an older state unless components_fresh_
  int32_t component_count_ = 0;
  bool components_fresh_ = false;

  // Scratch of a pass.
  const PlasticTets* plastic_ = nullptr;
  std::vector<TetLoad> loads_;  // a tet each; kOut stays
  // Pa^2, a tet each, of upright ones: no edge's stress in it has a larger square.
  std::vector<double> squared_bounds_;
  std::vector<double> ratios_;  // an edge each
  struct BlockMax {
    double value;
    int32_t item;
  };
  std::vector<BlockMax> block_max_;
  std::vector<double> component_max_;
  std::vector<int32_t> pending_;  // edges about to break
  std::vector<int32_t> torn_;     // strands about to die
  std::vector<int32_t> new_broken_;
  std::vector<ChangedTet> changed_;
  std::vector<int32_t> newly_out_;  // of the solid, and strands that died
  std::vector<int32_t> touched_tets_;
  std::vector<int32_t> touched_nodes_;
  std::vector<int32_t> cluster_of_;  // of the live tets of one node
  std::vector<double> cluster_volume_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_FRACTURE_H_
