#ifndef CLEAVE_CLIENT_IO_SERIES_FRAME_CHECK_H_
#define CLEAVE_CLIENT_IO_SERIES_FRAME_CHECK_H_

#include <cstdint>
#include <limits>

#include "absl/status/status.h"
#include "core/mesh/tet_mesh.h"
#include "core/stream/frame.h"

namespace cleave {

// Whether `frame` can be one of a mesh with `edge_count` edges: a finite position a node, ascending
// edges in range, and a finite time not before `previous_time` (s). Errors: InvalidArgument that
// names everything that is wrong, by field and frame.
absl::Status CheckFrame(const Frame& frame, const TetMesh& mesh, int64_t edge_count,
                        double previous_time = -std::numeric_limits<double>::infinity());

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SERIES_FRAME_CHECK_H_
