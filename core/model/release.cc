#include "core/model/release.h"

namespace cleave {
namespace {

bool AreSeparated(const std::vector<std::vector<int32_t>>& sets,
                  const std::vector<int32_t>& node_pieces) {
  std::vector<int32_t> set_of(node_pieces.size(), -1);  // by piece
  for (size_t set = 0; set < sets.size(); ++set) {
    for (const int32_t node : sets[set]) {
      const int32_t piece = node_pieces[static_cast<size_t>(node)];
      if (piece < 0) continue;
      int32_t& holder = set_of[static_cast<size_t>(piece)];
      if (holder >= 0 && holder != static_cast<int32_t>(set)) return false;
      holder = static_cast<int32_t>(set);
    }
  }
  return true;
}

}  // namespace

bool IsDue(const ReleaseRule& rule, double time, const FractureProgress& progress) {
  const Release& when = rule.when;
  if (when.time && time >= *when.time) return true;
  if (when.first_fracture && progress.broken_share > 0) return true;
  if (when.broken_share && progress.broken_share >= *when.broken_share) return true;
  if (when.pieces && progress.pieces >= *when.pieces) return true;
  return !rule.separated.empty() && AreSeparated(rule.separated, progress.node_pieces);
}

}  // namespace cleave
