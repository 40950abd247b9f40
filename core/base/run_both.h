#ifndef CLEAVE_CORE_BASE_RUN_BOTH_H_
#define CLEAVE_CORE_BASE_RUN_BOTH_H_

#include <cstdint>

#include "absl/functional/function_ref.h"
#include "core/base/parallel.h"

namespace cleave {

// Runs both, at the same time where the current TBB arena has threads to spare: for work that is
// one step after the other for long. Neither may read what the other writes.
inline void RunBoth(absl::FunctionRef<void()> one, absl::FunctionRef<void()> other) {
  ParallelFor(2, 1, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) at == 0 ? one() : other();
  });
}

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_RUN_BOTH_H_
