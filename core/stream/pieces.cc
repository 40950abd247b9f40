#include "core/stream/pieces.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace cleave {

void Pieces::Find(const EdgeGraph& graph) {
  const int32_t places = graph.places();
  labels_.assign(static_cast<size_t>(places), -1);
  owners_.assign(static_cast<size_t>(places), -1);
  leaders_.clear();
  std::vector<int32_t> queue;
  for (int32_t leader = 0; leader < places; ++leader) {
    if (labels_[static_cast<size_t>(leader)] >= 0) continue;
    const auto piece = static_cast<int32_t>(leaders_.size());
    leaders_.push_back(leader);
    labels_[static_cast<size_t>(leader)] = piece;
    queue.assign(1, leader);
    while (!queue.empty()) {
      const int32_t place = queue.back();
      queue.pop_back();
      for (const int32_t other : graph.Neighbours(place)) {
        if (other < 0 || labels_[static_cast<size_t>(other)] >= 0) continue;
        labels_[static_cast<size_t>(other)] = piece;
        queue.push_back(other);
      }
    }
  }
}

// Walks start at all ends of the broken edges at once and take turns. Walks that meet become one;
// one that has nowhere left to go has walked a whole piece. As soon as a former piece has a single
// walk left, that one is what remains of it and need not go on.
bool Pieces::Split(const EdgeGraph& graph, std::span<const int32_t> edges) {
  struct Walk {
    int32_t joined;   // the walk that this one became part of, or itself
    int32_t waiting;  // its places in the queue that have not had their turn
    bool finished;
  };
  std::vector<Walk> walks;
  std::vector<int32_t> queue;
  std::vector<int32_t> open(leaders_.size(), 0);  // walks that go on, of each former piece
  for (const int32_t edge : edges) {
    for (const int32_t place : graph.Ends(edge)) {
      int32_t& owner = owners_[static_cast<size_t>(place)];
      if (owner >= 0) continue;
      owner = static_cast<int32_t>(walks.size());
      walks.push_back({owner, 1, false});
      queue.push_back(place);
      ++open[static_cast<size_t>(labels_[static_cast<size_t>(place)])];
    }
  }
  const auto root_of = [&](int32_t walk) {
    while (walks[static_cast<size_t>(walk)].joined != walk) {
      int32_t& joined = walks[static_cast<size_t>(walk)].joined;
      joined = walks[static_cast<size_t>(joined)].joined;
      walk = joined;
    }
    return walk;
  };
  bool split = false;
  for (size_t at = 0; at < queue.size(); ++at) {
    const int32_t place = queue[at];
    int32_t& still_open = open[static_cast<size_t>(labels_[static_cast<size_t>(place)])];
    if (still_open <= 1) continue;
    int32_t root = root_of(owners_[static_cast<size_t>(place)]);
    --walks[static_cast<size_t>(root)].waiting;
    for (const int32_t other : graph.Neighbours(place)) {
      if (other < 0) continue;
      int32_t& owner = owners_[static_cast<size_t>(other)];
      if (owner < 0) {
        owner = root;
        ++walks[static_cast<size_t>(root)].waiting;
        queue.push_back(other);
        continue;
      }
      int32_t met = root_of(owner);
      if (met == root) continue;
      if (met < root) std::swap(met, root);
      walks[static_cast<size_t>(met)].joined = root;
      walks[static_cast<size_t>(root)].waiting += walks[static_cast<size_t>(met)].waiting;
      --still_open;
    }
    if (walks[static_cast<size_t>(root)].waiting == 0 && still_open > 1) {
      walks[static_cast<size_t>(root)].finished = true;
      --still_open;
      split = true;
    }
  }
  // A finished walk's places take a label that nobody has; Number makes them final.
  const auto fresh = static_cast<int32_t>(leaders_.size());
  for (const int32_t place : queue) {
    int32_t& owner = owners_[static_cast<size_t>(place)];
    const int32_t root = root_of(owner);
    if (walks[static_cast<size_t>(root)].finished) {
      labels_[static_cast<size_t>(place)] = fresh + root;
    }
    owner = -1;
  }
  if (split) {
    leaders_.resize(static_cast<size_t>(fresh) + walks.size());  // as many labels as may occur
    Number();
  }
  return split;
}

void Pieces::Number() {
  std::vector<int32_t> numbers(leaders_.size(), -1);
  leaders_.clear();
  for (size_t place = 0; place < labels_.size(); ++place) {
    int32_t& number = numbers[static_cast<size_t>(labels_[place])];
    if (number < 0) {
      number = static_cast<int32_t>(leaders_.size());
      leaders_.push_back(static_cast<int32_t>(place));
    }
    labels_[place] = number;
  }
}

}  // namespace cleave
