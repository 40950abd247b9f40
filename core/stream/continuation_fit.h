#ifndef CLEAVE_CORE_STREAM_CONTINUATION_FIT_H_
#define CLEAVE_CORE_STREAM_CONTINUATION_FIT_H_

#include <span>

#include "core/stream/interpolation_predictor.h"

namespace cleave {

// A place that a fit looks at: what its detail must be (grid units) and what it was in the last
// frame, in the one before and at rest. Lanes are x, y, z and 0.
struct DetailSample {
  Double4 wanted;
  Double4 last;
  Double4 before;
  Double4 rest;
};

// The continuation that leaves the smallest residuals, as the format can code it. Robust: a few
// places that jump do not decide.
Continuation FitContinuation(std::span<const DetailSample> samples);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_CONTINUATION_FIT_H_
