#include "server/worker/event_message.h"

namespace cleave {
namespace {

void Put(const BreakPlace& place, v1::BreakPlace& message) {
  message.set_time(place.time);
  for (const double coordinate : place.rest) message.add_rest(coordinate);
  for (const double coordinate : place.position) message.add_position(coordinate);
  message.set_energy(place.energy);
}

void Put(const PiecePart& part, v1::Piece& message) {
  message.set_piece(part.piece);
  message.set_first_node(part.first_node);
  message.set_node_count(part.node_count);
  message.set_volume(part.volume);
}

}  // namespace

v1::FrameEvents WholePiecesMessage(const TetMesh& mesh) {
  v1::FrameEvents message;
  for (const PiecePart& part : WholePieces(mesh)) Put(part, *message.add_pieces());
  return message;
}

v1::FrameEvents EventMessage(const FrameReport& report) {
  v1::FrameEvents message;
  message.set_frame(report.frame);
  for (const EdgeBreakEvent& event : report.events.edge_breaks) {
    v1::EdgeBreak& broken = *message.add_edge_breaks();
    broken.set_edge(event.edge);
    for (const int32_t node : event.nodes) broken.add_nodes(node);
    for (const int32_t piece : event.pieces) broken.add_pieces(piece);
    Put(event.place, *broken.mutable_place());
  }
  for (const SplitEvent& event : report.events.splits) {
    v1::PieceSplit& split = *message.add_splits();
    Put(event.kept, *split.mutable_kept());
    for (const SeparationEvent& separation : event.separated) {
      v1::Separation& separated = *split.add_separations();
      Put(separation.part, *separated.mutable_part());
      Put(separation.place, *separated.mutable_place());
    }
    Put(event.place, *split.mutable_place());
  }
  return message;
}

}  // namespace cleave
