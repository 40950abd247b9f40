#ifndef CLEAVE_CORE_STREAM_PIECE_LABELS_H_
#define CLEAVE_CORE_STREAM_PIECE_LABELS_H_

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/stream/node_order.h"
#include "core/stream/stencils.h"

namespace cleave {

// A set of broken edges as the piece of each node: FORMAT.md, "Labels". Much shorter than a list
// where a body has come apart. What it does not say are edges that broke inside a piece. Loops run
// on the current TBB arena.
class PieceLabels {
 public:
  // `unbroken` are the stencils of a body of which no edge is broken, in a surface view their near
  // places: also there all places have labels.
  PieceLabels(const NodeOrder& order, const Stencils& unbroken,
              std::span<const std::array<int32_t, 2>> edges);

  // The pieces of places as Pieces numbers them, coded.
  std::string Encode(std::span<const int32_t> labels) const;

  // What Encode coded, as the edges between places of different labels, ascending. Error: DataLoss.
  absl::StatusOr<std::vector<int32_t>> Decode(absl::string_view coded) const;

  // The edges between places of different labels, ascending.
  std::vector<int32_t> Between(std::span<const int32_t> labels) const;

 private:
  struct Ranking {
    std::array<int32_t, kStencilNodes> labels;
    size_t count;
    size_t context;  // in which the label is coded
  };
  // Labels of a place's stencil: the most frequent first, of equals that of the nearer place.
  Ranking Rank(size_t place, std::span<const int32_t> labels) const;

  std::vector<std::array<int32_t, 2>> edges_;  // as places
  std::vector<std::array<int32_t, kStencilNodes>> stencils_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_PIECE_LABELS_H_
