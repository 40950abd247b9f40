#ifndef CLEAVE_CORE_SOLVER_RESTING_H_
#define CLEAVE_CORE_SOLVER_RESTING_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "core/base/bytes.h"
#include "core/model/model.h"
#include "core/model/node_term.h"
#include "core/solver/newton.h"

namespace cleave {

// Which pieces of a body, and which moving colliders, sleep. Pieces are what connects through
// unbroken edges.
//
// A piece is quiet in a step in which no tet flows, at whose end none of its nodes is faster than
// the limit, in which nothing outside that acts on it changed and no edge of it broke, and in which
// the forces on it from outside - weight, loads, contact, motions - balanced: their sum and their
// moment about its centre of mass stay below a twentieth of the sums of their sizes. So nothing
// sleeps at the top of its flight, however slow it is there. Pieces near each other form a group; a
// group falls asleep when all in it have been quiet for the set time, and wakes as a whole when one
// in it wakes or one that is awake comes near. What sleeps has velocity 0 and stays where it is to
// the bit.
//
// Not thread-safe.
class Resting {
 public:
  // `model.sleep` must be set; `model` must outlive this object.
  explicit Resting(const Model& model);

  // Which edges are broken now, where that has changed.
  void SetBroken(std::span<const uint8_t> broken);
  // These edges broke in the step that runs.
  void EdgesBroke(std::span<const int32_t> edges);
  // Wakes all, as when something lets go.
  void WakeAll();

  // Makes the next Update tell of a change, whatever sleeps.
  void TellAgain();

  // Before a step: wakes what `influences` reach. Returns whether other unknowns sleep than at the
  // last call.
  bool Update(std::span<const Influence> influences);

  // After a step of `dt` (s) that was solved: lets fall asleep what has been quiet for long enough,
  // with velocity 0; nothing where the body `flows`. Returns the kinetic energy that this takes
  // out, J.
  double EndStep(double dt, bool flows, const NewtonSolver& solver, State& state);

  // As of the last Update: not 0 for an unknown that sleeps.
  const std::vector<uint8_t>& asleep() const { return asleep_; }
  bool all_asleep() const { return all_asleep_; }
  // The nodes, besides those of given coordinates, that are held.
  void AddFixedNodes(std::vector<FixedNode>& fixed_nodes) const;
  // Of unknowns that are awake, and of nodes without mass.
  std::vector<std::array<int64_t, 2>> AwakeRuns() const;

  // Pieces that sleep now; moving colliders are not counted.
  int64_t SleepingPieces() const;
  // Puts the forces (N) that held sleeping nodes when they fell asleep in place of theirs.
  void PutHeldForces(NodalVector& forces) const;

  void Save(ByteWriter& out) const;
  absl::Status Restore(ByteReader& in);

  int64_t bytes() const;

 private:
  struct Sums {
    double mass = 0;            // kg
    Double4 center = Splat(0);  // kg m, then m
    double speed_squared = 0;   // m^2/s^2, of the fastest node
    double quiet_seconds = 0;   // of the node that has the least
    Double4 force = Splat(0);   // N
    double force_size = 0;      // N, sum over forces
    Double4 moment = Splat(0);  // N m
    double moment_size = 0;     // N m
  };

  int32_t FindGroup(int32_t piece);
  Double4 PositionOf(size_t unknown, const State& state) const;
  // Adds a force (N) on an unknown.
  void AddForce(size_t unknown, Double4 force, const State& state);
  void AddAllForces(const NewtonSolver& solver, const State& state);

  const Model& model_;
  std::vector<int32_t> pieces_;  // an unknown each, -1 for a node of no tet
  int32_t piece_count_ = 0;      // moving colliders counted
  int32_t body_piece_count_ = 0;

  // What lasts.
  std::vector<double> quiet_seconds_;  // an unknown each; infinite for one that sleeps
  NodalVector held_forces_;            // N, of those; empty without motions

  // Of the step.
  std::vector<uint8_t> asleep_;
  bool all_asleep_ = false;
  std::vector<int32_t> groups_;   // a piece each, by union-find
  std::vector<uint8_t> stirred_;  // a piece each
  std::vector<Sums> sums_;        // a piece each
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_RESTING_H_
