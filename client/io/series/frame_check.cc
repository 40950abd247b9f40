#include "client/io/series/frame_check.h"

#include <cmath>
#include <cstddef>

#include "absl/strings/str_cat.h"
#include "core/base/faults.h"

namespace cleave {

absl::Status CheckFrame(const Frame& frame, const TetMesh& mesh, int64_t edge_count,
                        double previous_time) {
  Faults faults;
  if (frame.positions.size() != mesh.rest_positions.size()) {
    faults.Error("positions", absl::StrCat("frame ", frame.frame, " has ", frame.positions.size(),
                                           " nodes, the mesh ", mesh.rest_positions.size()));
  }
  for (size_t i = 0; i < frame.positions.size(); ++i) {
    const Vec3& p = frame.positions[i];
    if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) continue;
    faults.Error(absl::StrCat("positions[", i, "]"),
                 absl::StrCat("is not finite in frame ", frame.frame));
    break;
  }
  if (!std::isfinite(frame.time) || frame.time < previous_time) {
    faults.Error("time", absl::StrCat(frame.time, " s in frame ", frame.frame, " is before ",
                                      previous_time, " s or not finite"));
  }
  int64_t last = -1;
  for (size_t i = 0; i < frame.broken_edges.size(); ++i) {
    const int32_t edge = frame.broken_edges[i];
    if (edge <= last || edge >= edge_count) {
      faults.Error(absl::StrCat("broken_edges[", i, "]"),
                   absl::StrCat(edge, " is not ascending or not below the mesh's ", edge_count,
                                " edges in frame ", frame.frame));
      break;
    }
    last = edge;
  }
  return faults.ToStatus();
}

}  // namespace cleave
