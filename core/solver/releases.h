#ifndef CLEAVE_CORE_SOLVER_RELEASES_H_
#define CLEAVE_CORE_SOLVER_RELEASES_H_

#include <cstdint>

#include "core/model/model.h"
#include "core/model/release.h"
#include "core/solver/breaking.h"

namespace cleave {

// Finds out when the releases of a model are due. Not thread-safe.
class Releases {
 public:
  // `model` must outlive this object. `breaking` is null where nothing breaks; what is broken in it
  // now was cut before the first step.
  Releases(const Model& model, const Breaking* breaking);

  // Marks in `state` what a step from `time` (s) on goes without.
  void Update(double time, const Breaking* breaking, State& state);

  // To be called when edges may have mended, by restoring: looks at all of them again.
  void Forget() { seen_broken_edges_ = -1; }

 private:
  const Model& model_;
  int64_t cut_edges_ = 0;
  int64_t seen_broken_edges_ = -1;  // those of progress_; -1: none
  FractureProgress progress_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_SOLVER_RELEASES_H_
