#ifndef CLEAVE_CORE_DAMAGE_RANDOM_GRAPH_H_
#define CLEAVE_CORE_DAMAGE_RANDOM_GRAPH_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/incidence.h"
#include "core/scene/scene.h"

namespace cleave {

// How potencies and lost bonds become strength.
struct RandomGraphSettings {
  ImpurityEffect effect = ImpurityEffect::kDegradation;
  double steepness = 5;      // k > 0
  double pure_offset = 0.2;  // a0 > 0
  double degree_weight = 1;  // omega, in [0, 1]
  // False: the degrees of the whole mesh for ever.
  bool follows_degrees = true;
};

// The probability 1 - p that a bond between two nodes holds, over that between pure nodes with all
// their bonds: what counts an edge's threshold. Source: method note, section 4, in place of the
// printed Eqs. 7 to 9, which saturate.
class BondStrength {
 public:
  explicit BondStrength(const RandomGraphSettings& settings);

  // kappa > 0, from the potencies of both nodes and the shares of their bonds that are left,
  // (0, 1]. Falls with |potency| and lost bonds in degradation, rises with |potency| in
  // upgradation.
  double operator()(double potency_i, double potency_j, double share_i, double share_j) const;
  // At infinite potency and all bonds.
  double extreme() const { return extreme_; }

 private:
  double Weight(double potency, double share) const;
  const RandomGraphSettings settings_;
  double pure_ = 1;  // 1 - p between pure nodes
  double extreme_ = 1;
};

// What the thresholds of edges count in a body with impurities: a graph whose bonds hold with a
// probability that follows from the potency of their nodes and from how many bonds those have left.
// Potencies and degrees are all the state there is (a Markov random field on the nodes), so a
// node's potency touches the strengths of its own edges only. Not thread-safe.
class RandomGraph {
 public:
  // `potencies` has a node each. `draws` is empty, then strengths are the expected ones; or has a
  // number in (0, 1) for every edge, then each edge has one of two strengths by its draw, for good
  // unless its nodes lose bonds. `deal` is empty, or names for every edge the one whose nodes count
  // for it; degrees then must not count. What the spans and `incidence` refer to must outlive this
  // object.
  RandomGraph(const Incidence& incidence, const RandomGraphSettings& settings,
              std::span<const double> potencies, std::span<const double> draws,
              std::span<const int32_t> deal);

  // kappa: how many times the pure body's threshold every edge has, > 0, an edge each; stays where
  // it is in memory.
  std::span<const double> factors() const { return factors_; }

  // Takes away bonds; returns the edges whose factors fell, valid until the next call.
  std::span<const int32_t> Break(std::span<const int32_t> edges);
  // Starts over from a set of broken edges: nonzero for a broken one, an edge each.
  void Reset(std::span<const uint8_t> broken);

  int64_t bytes() const;

 private:
  double FactorOf(int32_t edge) const;

  const Incidence& incidence_;
  const BondStrength strength_;
  const bool upgrades_;
  const bool follows_degrees_;
  const std::span<const double> potencies_;
  const std::span<const double> draws_;
  const std::span<const int32_t> deal_;
  std::vector<int32_t> degrees_;  // bonds left, a node each; empty unless they count
  std::vector<double> factors_;
  std::vector<int32_t> changed_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_RANDOM_GRAPH_H_
