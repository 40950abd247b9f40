#include "core/stream/stream_state.h"

#include <cmath>

#include "core/base/state_hash.h"

namespace cleave {

uint64_t HashStreamState(absl::string_view header_bytes, const StreamState& state) {
  StateHash hash;
  const auto put = [&hash](const auto& value) { hash.Update(&value, sizeof(value)); };
  hash.Update(header_bytes.data(), header_bytes.size());
  put(state.frame);
  put(static_cast<uint64_t>(state.epoch));
  put(state.time);
  put(state.tolerance);
  put(state.fragments);
  put(static_cast<uint64_t>(state.broken_edges.size()));
  hash.Update(state.positions.data(), state.positions.size() * sizeof(int32_t));
  hash.Update(state.exact.data(), state.exact.size() * sizeof(int64_t));
  hash.Update(state.broken_edges.data(), state.broken_edges.size() * sizeof(int32_t));
  hash.Update(state.shifts.data(), state.shifts.size());
  return hash.Digest();
}

std::vector<int32_t> QuantiseRest(std::span<const Vec3> rest_positions, const Vec3& origin,
                                  double step) {
  std::vector<int32_t> quantised(rest_positions.size() * 3);
  for (size_t node = 0; node < rest_positions.size(); ++node) {
    for (size_t axis = 0; axis < 3; ++axis) {
      quantised[3 * node + axis] = static_cast<int32_t>(
          std::floor((rest_positions[node][axis] - origin[axis]) / step + 0.5));
    }
  }
  return quantised;
}

}  // namespace cleave
