#ifndef CLEAVE_CORE_STREAM_FRAME_H_
#define CLEAVE_CORE_STREAM_FRAME_H_

#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// One frame: what an encoder is given and a decoder gives back. Node and edge ids are the client's
// mesh's (core/mesh/incidence.h). With the mesh it determines fragments and crack surfaces
// (core/surface).
struct Frame {
  int64_t frame = 0;
  double time = 0;                    // s
  int64_t fragments = 0;              // pieces, for displays that have no mesh
  std::vector<Vec3> positions;        // m, every node
  std::vector<int32_t> broken_edges;  // every edge broken so far, ascending
  // Of each node, in a frame of a surface view: 1 if its position is known. Others, of which
  // surfaces need nothing, are given that of a node of their piece. Empty: all are known.
  std::vector<uint8_t> visible;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_FRAME_H_
