#include "core/base/parallel.h"

#include <algorithm>

#ifdef __SANITIZE_THREAD__
#include <thread>
#else
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#endif

namespace cleave {

void ParallelFor(int64_t count, int64_t grain, absl::FunctionRef<void(int64_t, int64_t)> body) {
  if (count <= grain) {
    if (count > 0) body(0, count);
    return;
  }
#ifdef __SANITIZE_THREAD__
  std::thread other([&] { body(0, count / 2); });
  body(count / 2, count);
  other.join();
#else
  tbb::parallel_for(
      tbb::blocked_range<int64_t>(0, count, grain),
      [&](const tbb::blocked_range<int64_t>& range) { body(range.begin(), range.end()); });
#endif
}

double OrderedSum(int64_t count, std::vector<double>& partials,
                  absl::FunctionRef<double(int64_t, int64_t)> block_sum) {
  constexpr int64_t kBlock = 4096;
  const int64_t blocks = (count + kBlock - 1) / kBlock;
  if (blocks <= 1) return count > 0 ? block_sum(0, count) : 0.0;
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
