#ifndef CLEAVE_TESTS_UNIT_CORE_STREAM_GOLDEN_SCENE_H_
#define CLEAVE_TESTS_UNIT_CORE_STREAM_GOLDEN_SCENE_H_

namespace cleave::stream_test {

// What golden/temporal_zstd.* holds: 90 nodes in chunks of 60; frames 0 to 9 of epoch 0, then 7 to
// 9 of epoch 1, the last of them at a finer tolerance. Key frames every 5; frame 3 holds.
inline constexpr char kGoldenDirectory[] = CLEAVE_SOURCE_DIR "/tests/unit/core/stream/golden/";
inline constexpr int kGoldenNodes = 90;
inline constexpr int kGoldenFrames = 13;
inline constexpr double kGoldenTolerance = 1e-3;       // m
inline constexpr double kGoldenFinerTolerance = 1e-4;  // m

}  // namespace cleave::stream_test

#endif  // CLEAVE_TESTS_UNIT_CORE_STREAM_GOLDEN_SCENE_H_
