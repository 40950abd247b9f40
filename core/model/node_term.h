#ifndef CLEAVE_CORE_MODEL_NODE_TERM_H_
#define CLEAVE_CORE_MODEL_NODE_TERM_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "core/base/bytes.h"
#include "core/model/curvature.h"
#include "core/model/nodal_vector.h"
#include "core/model/node_couplings.h"

namespace cleave {

struct State;

// What a node term did in a step, for the budget of its energy.
struct NodeTermWork {
  double external_work = 0;  // J, that it brought into the body from outside
  double stored_energy = 0;  // J, that it holds at the end of the step
  double dissipation = 0;    // J, that it took out for good, as friction does
  double integration = 0;    // J, that backward Euler took out of what it stores
};

// What may push a node in a step: another unknown, or -1, something outside that changes.
struct Influence {
  int32_t node;
  int32_t other;
};

// Forces on nodes from outside the tets: loads, contact. Ids are the solver's. Loops run on the
// caller's TBB arena and give the same bits for any number of threads.
class NodeTerm {
 public:
  virtual ~NodeTerm() = default;
  virtual absl::string_view name() const = 0;
  // Bytes that this term holds.
  virtual int64_t bytes() const = 0;

  // Tells the damage factors, a tet each, 0 for dead tets. Called before BeginStep where they may
  // have changed since the last call.
  virtual void SetDamage(std::span<const double> factors) { (void)factors; }

  // These edges are broken before the first step.
  virtual void StartBroken(std::span<const int32_t> edges) { (void)edges; }
  // These edges broke in the step that began, at these displacements. BeginStep takes that back.
  virtual void EdgesBroke(std::span<const int32_t> edges, const NodalVector& displacements) {
    (void)edges;
    (void)displacements;
  }
  // The longest part (s) of a step from `start` to `end` that this term can follow, with the body's
  // state at the start; a longer step is cut into equal parts.
  virtual double LongestPart(double start, double end, const State& state) const {
    (void)state;
    return end - start;
  }
  // Called before each attempt at a step from `start` to `end` (s), whose state at the start is
  // given: fixes what the step takes over from there, such as a load's value or the normal force
  // that friction goes by. A step that fails is attempted again in halves, so this replaces what
  // the last call fixed and changes nothing that EndStep keeps.
  virtual void BeginStep(double start, double end, const State& state) = 0;
  // After BeginStep: adds what this term knows to be near its nodes in the step, whether it pushes
  // yet or not, and what changes. Nothing for what rests.
  virtual void AddInfluences(std::vector<Influence>& influences) const { (void)influences; }
  // Adds -dE/dx (N) at displacements from rest (m) to `forces`; returns the energy E, J.
  virtual double AddForces(const NodalVector& displacements, NodalVector& forces) = 0;
  // Adds the second derivative of E or a positive semidefinite stand-in for it; for kSemidefinite
  // one that holds far from here too. Nothing where forces do not depend on displacements.
  virtual void AddStiffness(const NodalVector& displacements, Curvature curvature,
                            NodeCouplings& couplings) {
    (void)displacements;
    (void)curvature;
    (void)couplings;
  }
  // N, norm of what rounding of positions may add to forces at these displacements, a few units in
  // the last place of each: a solve can do no better.
  virtual double RoundingForce(const NodalVector& displacements) const {
    (void)displacements;
    return 0;
  }
  // The step that began has succeeded with this state at its end.
  virtual NodeTermWork EndStep(const State& state) = 0;
  // After EndStep: rewrites the unknowns that the term itself brought in, where they are measured
  // anew in every step.
  virtual void Renew(State& state) { (void)state; }

  // What decides later steps besides the state of the nodes. Restore refuses (DataLoss) what cannot
  // belong to this term, and then changes nothing.
  virtual void Save(ByteWriter& out) const { (void)out; }
  virtual absl::Status Restore(ByteReader& in) {
    (void)in;
    return absl::OkStatus();
  }
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_NODE_TERM_H_
