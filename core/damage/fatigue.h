#ifndef CLEAVE_CORE_DAMAGE_FATIGUE_H_
#define CLEAVE_CORE_DAMAGE_FATIGUE_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "core/base/broadcast.h"
#include "core/base/bytes.h"
#include "core/damage/load_cycles.h"

namespace cleave {

// How an edge tires, by stresses relative to its strength.
struct FatigueLaw {
  double coefficient = 1;  // fatigue strength coefficient sigma_f', > 0
  double power = 10;       // -1/b > 0 of the fatigue strength exponent b
  double endurance = 0;    // up to this amplitude cycles do nothing
  double degradation = 1;  // nu > 0

  // The share of an edge's life that half a cycle between two relative stresses takes: Basquin's
  // 1 / (2 N_f) = (sigma_ar / sigma_f')^(-1/b) with the amplitude sigma_ar = sqrt(sigma_max
  // sigma_a) of Smith, Watson and Topper, so that cycles below 0 do nothing.
  double HalfCycle(double low, double high) const;
  // The share of strength left after a share `damage` of life, with cycles up to a relative stress
  // `peak`: 1 - (1 - peak) damage^nu, which leaves just the peak at the end of a life; 0 from then
  // on. After Broutman and Sahu (nu = 1) and Schaff and Davidson.
  double ResidualStrength(double damage, double peak) const;
};

// Strength that edges lose to load cycles. Beyond the paper, which names fatigue as future work.
// Stress relative to strength is what counts, in compression that to the compressive strength, by
// the same law: in concrete both lie on one line. A half cycle takes the share of its worse end;
// where compression never breaks, it takes nothing.
//
// Cycles of every edge's aggregated stress are counted as they come (load_cycles.h), their shares
// of life add up (Palmgren and Miner), and strength falls with the sum; an edge breaks when its
// stress reaches what is left, and when the sum reaches 1 at the latest. Strength lost does not
// come back.
//
// Sources: Basquin, The exponential law of endurance tests (1910); Miner, Cumulative damage in
// fatigue (1945); Smith, Watson and Topper, A stress-strain function for the fatigue of metals
// (1970); Broutman and Sahu (1972); Tepfers, Tensile fatigue strength of plain concrete (1979);
// Schaff and Davidson, Life prediction methodology for composite structures (1997); ASTM E1049-85.
//
// Not thread-safe; loops run on the caller's TBB arena. The same bits for any number of threads.
class FatigueDamage {
 public:
  // `edge_laws` names a law for every edge, -1 for one that does not tire; empty: the first for
  // all. What the spans refer to must outlive this object.
  FatigueDamage(int64_t edge_count, std::span<const FatigueLaw> laws,
                std::span<const int16_t> edge_laws);

  // Share of strength left, [0, 1], an edge each; stays where it is in memory.
  std::span<const double> residual_strengths() const { return residual_strengths_; }
  // Miner's sum of an edge.
  double damage(int64_t edge) const { return edges_[static_cast<size_t>(edge)].damage; }

  // Takes the stresses that edges have at the end of a step, Pa, negative in compression; their
  // strengths without fatigue are tensile * kappa and compressive * kappa, Pa, > 0 where not
  // infinite. Returns whether any strength fell.
  bool Follow(std::span<const double> stresses, Broadcast<double> tensile,
              Broadcast<double> compressive, Broadcast<double> kappa);

  // Restore refuses (DataLoss) what cannot belong to this many edges, and then changes nothing.
  void Save(ByteWriter& out) const;
  absl::Status Restore(ByteReader& in);

  int64_t bytes() const { return BytesOf(static_cast<int64_t>(edges_.size())); }
  static int64_t BytesOf(int64_t edge_count);

 private:
  struct Edge {
    LoadCycles cycles;
    double damage = 0;  // Miner's sum
    double peak = 0;    // largest relative stress, of either sign, of a cycle that did damage
  };

  const std::span<const FatigueLaw> laws_;
  const std::span<const int16_t> edge_laws_;
  std::vector<Edge> edges_;
  std::vector<double> residual_strengths_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_FATIGUE_H_
