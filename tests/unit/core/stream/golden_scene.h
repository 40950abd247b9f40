#ifndef CLEAVE_TESTS_UNIT_CORE_STREAM_GOLDEN_SCENE_H_
#define CLEAVE_TESTS_UNIT_CORE_STREAM_GOLDEN_SCENE_H_

#include <cstddef>
#include <cstdint>

namespace cleave::stream_test {

// The streams in golden/, one for every combination of ids that the format has had. Each has frames
// 0 to 9 of epoch 0, then 7 to 9 of epoch 1, the last of them at a finer tolerance where positions
// are not exact. Key frames every 5; frame 3 holds.
struct GoldenStream {
  const char* name;
  uint16_t predictor_id;
  uint16_t coder_id;
  int nodes;
  size_t broken_edges;   // after the last frame
  bool crumbles;         // into cells from frame 5 on, which key frames tell by labels
  bool regions = false;  // from frame 4 on
  bool surface = false;

  bool interpolates() const { return predictor_id == 2; }
  bool exact() const { return predictor_id == 3; }
};
inline constexpr GoldenStream kGoldenStreams[] = {
    {"temporal_zstd", 1, 1, 90, 150, false},
    {"interpolation_zstd", 2, 1, 200, 1015, false},
    {"interpolation_rans", 2, 2, 200, 1015, false},
    {"interpolation_labels", 2, 2, 200, 1015, true},
    {"interpolation_region", 2, 2, 200, 1015, false, true},
    {"interpolation_surface", 2, 2, 200, 1015, true, false, true},
    {"exact_zstd", 3, 1, 90, 150, false},
};

inline constexpr char kGoldenDirectory[] = CLEAVE_SOURCE_DIR "/tests/unit/core/stream/golden/";
inline constexpr int kGoldenFrames = 13;
inline constexpr double kGoldenTolerance = 1e-3;         // m
inline constexpr double kGoldenOutsideTolerance = 2e-2;  // m
inline constexpr double kGoldenFinerTolerance = 1e-4;    // m

}  // namespace cleave::stream_test

#endif  // CLEAVE_TESTS_UNIT_CORE_STREAM_GOLDEN_SCENE_H_
