#ifndef CLEAVE_CORE_STREAM_PIECES_H_
#define CLEAVE_CORE_STREAM_PIECES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/stream/edge_graph.h"

namespace cleave {

// The pieces into which a body is broken: places that unbroken edges connect. Pieces are numbered
// by their first place, which is their leader; so numbers follow from the broken edges alone.
class Pieces {
 public:
  // Finds all pieces anew.
  void Find(const EdgeGraph& graph);

  // After these edges broke in the graph: finds what came off. The work grows with the smaller
  // parts and with how far one walks around the breaks, not with the body. True if a piece split.
  bool Split(const EdgeGraph& graph, std::span<const int32_t> edges);

  int32_t count() const { return static_cast<int32_t>(leaders_.size()); }
  int32_t operator[](int32_t place) const { return labels_[static_cast<size_t>(place)]; }
  const std::vector<int32_t>& labels() const { return labels_; }
  const std::vector<int32_t>& leaders() const { return leaders_; }  // ascending

 private:
  void Number();

  std::vector<int32_t> labels_;   // piece of each place
  std::vector<int32_t> leaders_;  // first place of each piece
  std::vector<int32_t> owners_;   // walk that reached a place, while splitting; else -1
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_PIECES_H_
