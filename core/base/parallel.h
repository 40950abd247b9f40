#ifndef CLEAVE_CORE_BASE_PARALLEL_H_
#define CLEAVE_CORE_BASE_PARALLEL_H_

#include <algorithm>
#include <cstdint>
#include <vector>

#ifdef __SANITIZE_THREAD__
#include <thread>
#else
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#endif

namespace cleave {

// Runs body(begin, end) over disjoint blocks that cover [0, count), on the threads of the current
// TBB arena. The body must write only what its own range owns; then the result is the same for any
// number of threads. `grain` is the fewest items worth a task.
//
// Under the thread sanitizer two plain threads share the blocks: it does not see what orders the
// tasks of Debian's oneTBB, and would report every loop.
template <typename Body>
void ParallelFor(int64_t count, int64_t grain, const Body& body) {
  if (count <= grain) {
    if (count > 0) body(int64_t{0}, count);
    return;
  }
#ifdef __SANITIZE_THREAD__
  std::thread other([&] { body(int64_t{0}, count / 2); });
  body(count / 2, count);
  other.join();
#else
  tbb::parallel_for(
      tbb::blocked_range<int64_t>(0, count, grain),
      [&](const tbb::blocked_range<int64_t>& range) { body(range.begin(), range.end()); });
#endif
}

// Sums block_sum(begin, end) over fixed blocks of [0, count), added in block order: the same bits
// for any number of threads. `partials` is scratch that the caller keeps, so that a hot loop does
// not allocate.
template <typename BlockSum>
double OrderedSum(int64_t count, std::vector<double>& partials, const BlockSum& block_sum) {
  constexpr int64_t kBlock = 4096;
  const int64_t blocks = (count + kBlock - 1) / kBlock;
  if (blocks <= 1) return count > 0 ? block_sum(int64_t{0}, count) : 0.0;
  partials.resize(static_cast<size_t>(blocks));
  ParallelFor(blocks, 1, [&](int64_t begin, int64_t end) {
    for (int64_t block = begin; block < end; ++block) {
      partials[static_cast<size_t>(block)] =
          block_sum(block * kBlock, std::min(count, (block + 1) * kBlock));
    }
  });
  double sum = 0;
  for (const double partial : partials) sum += partial;
  return sum;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_PARALLEL_H_
