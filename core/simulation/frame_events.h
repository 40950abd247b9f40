#ifndef CLEAVE_CORE_SIMULATION_FRAME_EVENTS_H_
#define CLEAVE_CORE_SIMULATION_FRAME_EVENTS_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/damage/named_pieces.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// What broke in a frame. Ids are the client's; piece ids are those of NamedPieces, told of the
// frame's edges at once, so that whoever follows the frames has the same.

// Where and when something gave way.
struct BreakPlace {
  double time = 0;         // s, at the end of the step in which its last edge broke
  Vec3 rest{0, 0, 0};      // m, mean of the edges' middles, at rest
  Vec3 position{0, 0, 0};  // m, the same where they were when they broke
  double energy = 0;       // J, elastic, that the edges took (edge_break.h)
};

struct EdgeBreakEvent {
  int32_t edge = 0;
  std::array<int32_t, 2> nodes{};   // smaller first
  std::array<int32_t, 2> pieces{};  // of the nodes, at the end of the frame
  BreakPlace place;
};

// A part that came off.
struct SeparationEvent {
  PiecePart part;
  BreakPlace place;  // of those of the frame's edges that joined it to other pieces
};

struct SplitEvent {
  PiecePart kept;                          // what goes on under the id of the piece that split
  std::vector<SeparationEvent> separated;  // by ascending id
  BreakPlace place;                        // of the frame's edges between its parts
};

struct FrameEvents {
  std::vector<EdgeBreakEvent> edge_breaks;  // as they broke: by step, pass and solver's edge
  std::vector<SplitEvent> splits;           // by ascending id of the piece
  bool empty() const { return edge_breaks.empty() && splits.empty(); }
};

// Adds what `splits` and `pieces` say to edges that broke, whose `pieces` are yet to be filled in.
// `to_node` gives the node of `pieces` for a client's node.
FrameEvents MakeFrameEvents(std::vector<EdgeBreakEvent> edge_breaks,
                            std::span<const PieceSplit> splits, const NamedPieces& pieces,
                            std::span<const int32_t> to_node);

// The pieces that a mesh is made of while no edge is broken, by ascending id: what the first splits
// are of.
std::vector<PiecePart> WholePieces(const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_SIMULATION_FRAME_EVENTS_H_
