#ifndef CLEAVE_CORE_STREAM_CLASS_CHOICE_H_
#define CLEAVE_CORE_STREAM_CLASS_CHOICE_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/int4.h"
#include "core/stream/frame_motion.h"
#include "core/stream/interpolation_predictor.h"
#include "core/stream/residual_coder.h"
#include "core/stream/residual_model.h"

namespace cleave {

// Where the residuals of a frame are, group by group, other than those before would suggest: an
// encoder's choice of FrameMotion::classes.
class ClassChoice {
 public:
  ClassChoice();

  // For each group the class with which its places begin, or kGoesOn if going on from `activities`
  // is about as short; in a key frame, `key`, a class for all. Empty if all go on. A choice by
  // what coder's frequencies make of a few hundred places a group, in a key frame of all.
  std::vector<uint8_t> Choose(bool key, const InterpolationPredictor& predictor,
                              const FrameMotion& motion, std::span<const Int32x4> residuals,
                              std::span<const uint16_t> activities, const ResidualCoder& coder);

 private:
  std::vector<float> bits_of_frequency_;
  std::array<std::array<float, kMasks + kTokens>, kClasses> bits_;  // of masks, then of tokens
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_CLASS_CHOICE_H_
