#include "core/model/prescribed_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace cleave {
namespace {

PrescribedMotion QuarterTurn() {
  PrescribedMotion motion;
  motion.axes = Int64x4{-1, -1, -1, 0};
  motion.keyframes = {{1, {0, 0, 0}, 0}, {3, {0, 0, 4}, std::acos(-1.0) / 2}};
  motion.center = Double4{1, 1, 0, 0};
  motion.axis = Double4{0, 0, 1, 0};
  return motion;
}

TEST(PrescribedMotion, InterpolatesBetweenKeyframesAndHoldsOutside) {
  const PrescribedMotion motion = QuarterTurn();
  EXPECT_EQ(PoseAt(motion, 0).translation, (Vec3{0, 0, 0}));
  EXPECT_EQ(PoseAt(motion, 2).translation, (Vec3{0, 0, 2}));
  EXPECT_DOUBLE_EQ(PoseAt(motion, 2).rotation, std::acos(-1.0) / 4);
  EXPECT_EQ(PoseAt(motion, 3).translation, (Vec3{0, 0, 4}));
  EXPECT_EQ(PoseAt(motion, 99).translation, (Vec3{0, 0, 4}));
}

TEST(PrescribedMotion, TurnsAboutItsCenterThenTranslates) {
  const PrescribedMotion motion = QuarterTurn();
  const Double4 moved = DisplacementAt(motion, PoseAt(motion, 3), {2, 1, 5});
  EXPECT_NEAR(moved[0], -1, 1e-15);  // (2, 1) turns to (1, 2)
  EXPECT_NEAR(moved[1], 1, 1e-15);
  EXPECT_NEAR(moved[2], 4, 1e-15);
  EXPECT_EQ(moved[3], 0);
}

TEST(PrescribedMotion, WithoutKeyframesNothingMovesAtAll) {
  PrescribedMotion motion = QuarterTurn();
  motion.keyframes.clear();
  const Double4 moved = DisplacementAt(motion, PoseAt(motion, 7), {1e9, 0.1, -3});
  for (int k = 0; k < 4; ++k) EXPECT_EQ(moved[k], 0);
}

}  // namespace
}  // namespace cleave
