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

// Walks start at all ends of the broken edges at once. Walks that meet become one; one that has
// nowhere left to go has walked a whole piece. As soon as a former piece has a single walk left,
// that one is what remains of it and need not go on. In each round every walk takes as many places
// as any other, twice those of the round before: so what is small is walked to its end before much
// of what is large.
bool Pieces::Split(const EdgeGraph& graph, std::span<const int32_t> edges) {
  constexpr int32_t kNone = -1;
  struct Visit {
    int32_t place;
    int32_t next;  // in the list of its walk, or kNone
  };
  struct Walk {
    int32_t joined;  // the walk that this one became part of, or itself
    int32_t piece;   // the former piece that it is in
    int32_t first;   // list of visits that have not had their turn, or kNone
    int32_t last;
    bool finished;
  };
  std::vector<Visit> visits;
  std::vector<Walk> walks;
  std::vector<int32_t> going;                     // walks that may have places to take
  std::vector<int32_t> open(leaders_.size(), 0);  // walks that go on, of each former piece
  for (const int32_t edge : edges) {
    for (const int32_t place : graph.Ends(edge)) {
      int32_t& owner = owners_[static_cast<size_t>(place)];
      if (owner >= 0) continue;
      owner = static_cast<int32_t>(walks.size());
      const int32_t piece = labels_[static_cast<size_t>(place)];
      walks.push_back({owner, piece, owner, owner, false});
      visits.push_back({place, kNone});
      going.push_back(owner);
      ++open[static_cast<size_t>(piece)];
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
  const auto append = [&](Walk& walk, int32_t first, int32_t last) {
    (walk.first == kNone ? walk.first : visits[static_cast<size_t>(walk.last)].next) = first;
    walk.last = last;
  };
  bool split = false;
  const auto take_place = [&](int32_t id, Walk& walk, int32_t& still_open) {
    const Visit visit = visits[static_cast<size_t>(walk.first)];
    walk.first = visit.next;
    for (const int32_t other : graph.Neighbours(visit.place)) {
      if (other < 0) continue;
      int32_t& owner = owners_[static_cast<size_t>(other)];
      if (owner == id) continue;
      if (owner < 0) {
        owner = id;
        const auto at = static_cast<int32_t>(visits.size());
        visits.push_back({other, kNone});
        append(walk, at, at);
        continue;
      }
      const int32_t met = root_of(owner);
      if (met == id) continue;
      Walk& other_walk = walks[static_cast<size_t>(met)];
      other_walk.joined = id;
      if (other_walk.first != kNone) append(walk, other_walk.first, other_walk.last);
      --still_open;
    }
    if (walk.first == kNone && still_open > 1) {
      walk.finished = true;
      --still_open;
      split = true;
    }
  };
  for (int64_t turns = 1; !going.empty(); turns *= 2) {
    size_t kept = 0;
    for (const int32_t id : going) {
      Walk& walk = walks[static_cast<size_t>(id)];
      if (walk.joined != id) continue;
      int32_t& still_open = open[static_cast<size_t>(walk.piece)];
      for (int64_t turn = 0; turn < turns && still_open > 1 && walk.first != kNone; ++turn) {
        take_place(id, walk, still_open);
      }
      if (still_open > 1 && walk.first != kNone) going[kept++] = id;
    }
    going.resize(kept);
  }
  // A finished walk's places take a label that nobody has; Number makes them final.
  const auto fresh = static_cast<int32_t>(leaders_.size());
  for (const auto& [place, next] : visits) {
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
