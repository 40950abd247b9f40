#include "core/simulation/frame_events.h"

#include <algorithm>
#include <map>
#include <utility>

#include "core/mesh/incidence.h"

namespace cleave {
namespace {

// The mean of places, as they are added.
class PlaceSum {
 public:
  void Add(const BreakPlace& place) {
    sum_.time = count_ == 0 ? place.time : std::max(sum_.time, place.time);
    sum_.energy += place.energy;
    for (size_t axis = 0; axis < 3; ++axis) {
      sum_.rest[axis] += place.rest[axis];
      sum_.position[axis] += place.position[axis];
    }
    ++count_;
  }
  BreakPlace Mean() const {
    BreakPlace mean = sum_;
    for (size_t axis = 0; count_ > 0 && axis < 3; ++axis) {
      mean.rest[axis] /= count_;
      mean.position[axis] /= count_;
    }
    return mean;
  }

 private:
  BreakPlace sum_;
  int count_ = 0;
};

}  // namespace

FrameEvents MakeFrameEvents(std::vector<EdgeBreakEvent> edge_breaks,
                            std::span<const PieceSplit> splits, const NamedPieces& pieces,
                            std::span<const int32_t> to_node) {
  FrameEvents events;
  std::map<int32_t, PlaceSum> of_part;
  std::map<int32_t, PlaceSum> of_split;  // by the piece that split
  std::map<int32_t, int32_t> split_of_part;
  for (const PieceSplit& split : splits) {
    for (const PiecePart& part : split.parts) split_of_part[part.piece] = split.piece;
  }
  for (EdgeBreakEvent& broken : edge_breaks) {
    for (size_t i = 0; i < 2; ++i)
      broken.pieces[i] = pieces.piece_of(to_node[static_cast<size_t>(broken.nodes[i])]);
    if (broken.pieces[0] == broken.pieces[1]) continue;
    for (const int32_t piece : broken.pieces) of_part[piece].Add(broken.place);
    of_split[split_of_part[broken.pieces[0]]].Add(broken.place);
  }
  events.edge_breaks = std::move(edge_breaks);
  for (const PieceSplit& split : splits) {
    SplitEvent event;
    event.kept = split.parts.front();
    event.place = of_split[split.piece].Mean();
    for (size_t i = 1; i < split.parts.size(); ++i)
      event.separated.push_back({split.parts[i], of_part[split.parts[i].piece].Mean()});
    events.splits.push_back(std::move(event));
  }
  return events;
}

std::vector<PiecePart> WholePieces(const TetMesh& mesh) {
  const Incidence incidence = BuildIncidence(mesh);
  const NamedPieces pieces(mesh, incidence);
  std::vector<PiecePart> parts(static_cast<size_t>(pieces.count()));
  const std::vector<int32_t> first_nodes = pieces.FirstNodes();
  for (int32_t piece = 0; piece < pieces.count(); ++piece) {
    parts[static_cast<size_t>(piece)] = {.piece = piece,
                                         .first_node = first_nodes[static_cast<size_t>(piece)],
                                         .node_count = 0,
                                         .volume = pieces.volume(piece)};
  }
  for (int32_t node = 0; node < mesh.node_count(); ++node) {
    const int32_t piece = pieces.piece_of(node);
    if (piece >= 0) ++parts[static_cast<size_t>(piece)].node_count;
  }
  return parts;
}

}  // namespace cleave
