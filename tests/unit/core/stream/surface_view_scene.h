#ifndef CLEAVE_TESTS_UNIT_CORE_STREAM_SURFACE_VIEW_SCENE_H_
#define CLEAVE_TESTS_UNIT_CORE_STREAM_SURFACE_VIEW_SCENE_H_

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/stream/frame.h"
#include "core/stream/stream_header.h"
#include "tests/unit/core/stream/stream_fixture.h"

// A body that comes apart, and its stream in the surface view.
namespace cleave::stream_test {

inline constexpr double kTolerance = 1e-4;  // m

inline StreamParameters OfSurface(const Body& body, uint16_t coder = kCoderContextRans) {
  StreamParameters parameters = Parameters(body.edges.size(), kTolerance, 8);
  parameters.tet_count = body.tets.size();
  parameters.predictor_id = kPredictorInterpolation;
  parameters.coder_id = coder;
  parameters.view_id = kViewSurface;
  return parameters;
}

// A wavy crack runs along x through the body, and cells of different size come off behind it, some
// of them a single node; everything tumbles and shakes.
inline bool IsBroken(const Body& body, size_t edge, int64_t number) {
  const auto cell = [&](int32_t node) {
    const Vec3& x = body.rest[static_cast<size_t>(node)];
    const double front = 0.08 * static_cast<double>(number - 2);
    if (x[0] + 0.1 * Random(3, static_cast<uint64_t>(node), 0) > front) return -1;
    if (Random(4, static_cast<uint64_t>(node), 0) > 0.9) return 1000 + node;
    return x[1] + 0.03 * Random(5, static_cast<uint64_t>(node), 1) > 0.25 ? 1 : 0;
  };
  const auto& [a, b] = body.edges[edge];
  const int one = cell(a);
  const int other = cell(b);
  return one != other && one >= 0 && other >= 0;
}

inline Frame TumblingFrame(const Body& body, int64_t number) {
  Frame frame;
  frame.frame = number;
  frame.positions = body.rest;
  const auto t = static_cast<double>(number);
  for (size_t node = 0; node < body.rest.size(); ++node) {
    const Vec3& x = body.rest[node];
    const double angle = 0.05 * t;
    frame.positions[node] = {std::cos(angle) * x[0] - std::sin(angle) * x[1] + 0.1 * t,
                             std::sin(angle) * x[0] + std::cos(angle) * x[1],
                             x[2] * (1 + 0.1 * std::sin(t + 3 * x[0]))};
    for (size_t axis = 0; axis < 3; ++axis) {
      frame.positions[node][axis] += 1e-3 * Random(static_cast<uint64_t>(number), node, axis);
    }
  }
  for (size_t edge = 0; edge < body.edges.size(); ++edge) {
    if (IsBroken(body, edge, number)) frame.broken_edges.push_back(static_cast<int32_t>(edge));
  }
  return frame;
}

}  // namespace cleave::stream_test

#endif  // CLEAVE_TESTS_UNIT_CORE_STREAM_SURFACE_VIEW_SCENE_H_
