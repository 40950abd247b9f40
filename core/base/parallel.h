#ifndef CLEAVE_CORE_BASE_PARALLEL_H_
#define CLEAVE_CORE_BASE_PARALLEL_H_

#include <cstdint>
#include <vector>

#include "absl/functional/function_ref.h"

// Loops over blocks. What runs in a block is called, not woven into TBB's templates, which start a
// block in many places: a pass would be compiled as many times over. So blocks are to be long
// against a call.

namespace cleave {

// Runs body(begin, end) over disjoint blocks that cover [0, count), on the threads of the current
// TBB arena. The body must write only what its own range owns; then the result is the same for any
// number of threads. `grain` is the fewest items worth a task.
//
// Under the thread sanitizer two plain threads share the blocks: it does not see what orders the
// tasks of Debian's oneTBB, and would report every loop.
void ParallelFor(int64_t count, int64_t grain, absl::FunctionRef<void(int64_t, int64_t)> body);

// Sums block_sum(begin, end) over fixed blocks of [0, count), added in block order: the same bits
// for any number of threads. `partials` is scratch that the caller keeps, so that a hot loop does
// not allocate.
double OrderedSum(int64_t count, std::vector<double>& partials,
                  absl::FunctionRef<double(int64_t, int64_t)> block_sum);

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_PARALLEL_H_
