#ifndef CLEAVE_CORE_STREAM_PIECES_H_
#define CLEAVE_CORE_STREAM_PIECES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/stream/edge_graph.h"
#include "core/stream/node_order.h"

namespace cleave {

// The pieces into which a body is broken: places that unbroken edges connect. Pieces are numbered
// by their first place, which is their leader; so numbers follow from the broken edges alone.
//
// Runs of 64 nodes along the Morton curve are blocks. What hangs together within a block is a
// clump, and a piece is what links join of clumps. A break changes the clumps and links of the
// blocks it is in; that, and to join a few clumps a block, is the work. Loops run on the current
// TBB arena.
class Pieces {
 public:
  // Finds all pieces anew.
  void Find(const NodeOrder& order, const EdgeGraph& graph);

  // After these edges broke in the graph: finds what came off. True if a piece split.
  bool Split(const EdgeGraph& graph, std::span<const int32_t> edges);

  int32_t count() const { return static_cast<int32_t>(leaders_.size()); }
  int32_t operator[](int32_t place) const { return labels_[static_cast<size_t>(place)]; }
  const std::vector<int32_t>& labels() const { return labels_; }
  const std::vector<int32_t>& leaders() const { return leaders_; }  // ascending
  // True of a piece that came about in the last Split that was true.
  bool IsNew(int32_t piece) const { return is_new_[static_cast<size_t>(piece)] != 0; }

 private:
  // An unbroken edge to another block.
  struct Link {
    int32_t rank;  // of `from`
    int32_t from;  // places
    int32_t to;
  };
  struct Block {
    std::vector<int32_t> clumps;  // the first rank of each
    std::vector<Link> links;      // one at least between clumps that edges join; by rank of `from`
  };

  void FindJoins(const EdgeGraph& graph, int32_t block);
  bool FindClumps(int32_t block);
  void FindLinks(const EdgeGraph& graph, int32_t block);
  bool HasLink(size_t block, int32_t rank, int32_t to) const;
  bool Join();
  int32_t Root(int32_t clump);

  // A rank is a place's position along the curve.
  std::vector<int32_t> places_;  // by rank
  std::vector<int32_t> ranks_;   // by place
  std::vector<uint64_t> joins_;  // by rank: a bit for each place of its block that an edge joins
  std::vector<int32_t> clumps_;  // by place: the first rank of its clump
  std::vector<int32_t> firsts_;  // by the first rank of a clump: its first place
  std::vector<Block> blocks_;
  std::vector<int32_t> joined_;   // by the first rank of a clump: an earlier one, or itself
  std::vector<int32_t> numbers_;  // by the first rank of a clump: its piece

  std::vector<int32_t> labels_;   // piece of each place
  std::vector<int32_t> leaders_;  // first place of each piece
  std::vector<uint8_t> is_new_;   // by piece
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_PIECES_H_
