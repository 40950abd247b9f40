#ifndef CLEAVE_CORE_STREAM_CONTINUATION_FIT_H_
#define CLEAVE_CORE_STREAM_CONTINUATION_FIT_H_

#include <span>

#include "core/stream/interpolation_predictor.h"

namespace cleave {

// A place that a fit looks at: what its detail must be (grid units) and what it was.
struct DetailSample {
  std::array<double, 3> wanted{};
  InterpolationPredictor::Details details;
};

// The continuation that leaves the smallest residuals, as the format can code it. Robust: a few
// places that jump do not decide.
Continuation FitContinuation(std::span<const DetailSample> samples);

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_CONTINUATION_FIT_H_
