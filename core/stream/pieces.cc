#include "core/stream/pieces.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"

namespace cleave {
namespace {

constexpr int32_t kBlock = 64;
constexpr int64_t kGrainBlocks = 16;
constexpr int32_t kAhead = 4;  // how far ahead that is fetched which will be read

}  // namespace

void Pieces::Find(const NodeOrder& order, const EdgeGraph& graph) {
  const auto count = static_cast<size_t>(graph.places());
  places_.resize(count);
  std::iota(places_.begin(), places_.end(), 0);
  std::sort(places_.begin(), places_.end(), [&](int32_t a, int32_t b) {
    const uint64_t code_a = order.codes[static_cast<size_t>(a)];
    const uint64_t code_b = order.codes[static_cast<size_t>(b)];
    return code_a != code_b ? code_a < code_b : a < b;
  });
  ranks_.resize(count);
  for (size_t rank = 0; rank < count; ++rank) {
    ranks_[static_cast<size_t>(places_[rank])] = static_cast<int32_t>(rank);
  }
  for (std::vector<int32_t>* by_rank : {&clumps_, &firsts_, &joined_, &numbers_}) {
    by_rank->assign(count, 0);
  }
  joins_.assign(count, 0);
  blocks_.resize((count + kBlock - 1) / kBlock);
  labels_.assign(count, 0);
  leaders_.clear();
  const auto blocks = static_cast<int64_t>(blocks_.size());
  ParallelFor(blocks, kGrainBlocks, [&](int64_t begin, int64_t end) {
    for (int64_t block = begin; block < end; ++block) {
      FindJoins(graph, static_cast<int32_t>(block));
      FindClumps(static_cast<int32_t>(block));
    }
  });
  ParallelFor(blocks, kGrainBlocks, [&](int64_t begin, int64_t end) {
    for (int64_t block = begin; block < end; ++block) {
      FindLinks(graph, static_cast<int32_t>(block));
    }
  });
  Join();
}

bool Pieces::Split(const EdgeGraph& graph, std::span<const int32_t> edges) {
  constexpr uint8_t kInside = 1;
  constexpr uint8_t kLink = 2;
  std::vector<uint8_t> lost(blocks_.size(), 0);
  const auto lose = [&](size_t block, uint8_t what) {
    const std::atomic_ref<uint8_t> of_block(lost[block]);
    if ((of_block.load(std::memory_order_relaxed) & what) == 0) {
      of_block.fetch_or(what, std::memory_order_relaxed);
    }
  };
  const auto part = [&](int32_t rank, int32_t other) {
    std::atomic_ref<uint64_t>(joins_[static_cast<size_t>(rank)])
        .fetch_and(~(uint64_t{1} << (other % kBlock)), std::memory_order_relaxed);
  };
  ParallelFor(static_cast<int64_t>(edges.size()), 512, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      const auto [a, b] = graph.Ends(edges[static_cast<size_t>(at)]);
      const int32_t rank_a = ranks_[static_cast<size_t>(a)];
      const int32_t rank_b = ranks_[static_cast<size_t>(b)];
      const auto block_a = static_cast<size_t>(rank_a / kBlock);
      const auto block_b = static_cast<size_t>(rank_b / kBlock);
      if (block_a == block_b) {
        part(rank_a, rank_b);
        part(rank_b, rank_a);
        lose(block_a, kInside);
      } else {
        if (HasLink(block_a, rank_a, b)) lose(block_a, kLink);
        if (HasLink(block_b, rank_b, a)) lose(block_b, kLink);
      }
    }
  });
  std::vector<int32_t> touched;
  for (size_t block = 0; block < blocks_.size(); ++block) {
    if (lost[block] != 0) touched.push_back(static_cast<int32_t>(block));
  }
  const auto count = static_cast<int64_t>(touched.size());
  ParallelFor(count, kGrainBlocks, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      const int32_t block = touched[static_cast<size_t>(at)];
      uint8_t& of_block = lost[static_cast<size_t>(block)];
      if ((of_block & kInside) != 0 && FindClumps(block)) of_block |= kLink;
    }
  });
  // A link stands for all edges between two clumps. Where one broke or a clump came apart, the
  // block's links are all found anew, so that no edge is without one.
  ParallelFor(count, kGrainBlocks, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      const int32_t block = touched[static_cast<size_t>(at)];
      if ((lost[static_cast<size_t>(block)] & kLink) != 0) FindLinks(graph, block);
    }
  });
  return Join();
}

bool Pieces::HasLink(size_t block, int32_t rank, int32_t to) const {
  const std::vector<Link>& links = blocks_[block].links;
  auto link = std::lower_bound(links.begin(), links.end(), rank,
                               [](const Link& a, int32_t least) { return a.rank < least; });
  for (; link != links.end() && link->rank == rank; ++link) {
    if (link->to == to) return true;
  }
  return false;
}

void Pieces::FindJoins(const EdgeGraph& graph, int32_t block) {
  const int32_t begin = block * kBlock;
  const int32_t end = std::min(begin + kBlock, graph.places());
  for (int32_t rank = begin; rank < end; ++rank) {
    uint64_t bits = 0;
    for (const int32_t other : graph.Neighbours(places_[static_cast<size_t>(rank)])) {
      // Without branches, which nobody could predict.
      const auto place = static_cast<size_t>(std::max(other, ~other));
      const auto offset = static_cast<uint32_t>(ranks_[place] - begin);
      bits |= uint64_t{offset < kBlock && other >= 0} << (offset % kBlock);
    }
    joins_[static_cast<size_t>(rank)] = bits;
  }
}

// True if a clump came apart.
bool Pieces::FindClumps(int32_t block) {
  const int32_t begin = block * kBlock;
  const int32_t size = std::min(kBlock, static_cast<int32_t>(joins_.size()) - begin);
  std::vector<int32_t>& clumps = blocks_[static_cast<size_t>(block)].clumps;
  const size_t before = clumps.size();
  clumps.clear();
  uint64_t left = size == kBlock ? ~uint64_t{0} : (uint64_t{1} << size) - 1;
  while (left != 0) {
    const int32_t clump = begin + std::countr_zero(left);
    clumps.push_back(clump);
    int32_t first = static_cast<int32_t>(joins_.size());
    for (uint64_t open = left & -left; open != 0;) {
      const int at = std::countr_zero(open);
      const auto rank = static_cast<size_t>(begin + at);
      left &= ~(uint64_t{1} << at);
      open = (open | joins_[rank]) & left;
      clumps_[static_cast<size_t>(places_[rank])] = clump;
      first = std::min(first, places_[rank]);
    }
    firsts_[static_cast<size_t>(clump)] = first;
  }
  return clumps.size() != before;
}

void Pieces::FindLinks(const EdgeGraph& graph, int32_t block) {
  const int32_t begin = block * kBlock;
  const int32_t end = std::min(begin + kBlock, graph.places());
  std::vector<Link>& links = blocks_[static_cast<size_t>(block)].links;
  links.clear();
  // Most edges join clumps that one just joined; a few that slip through are harmless.
  std::array<std::pair<int32_t, int32_t>, 64> recent;
  recent.fill({-1, -1});
  std::array<std::pair<int32_t, int32_t>, 256> outside;  // clump and place that an edge leads to
  for (int32_t rank = begin; rank < end; ++rank) {
    const int32_t place = places_[static_cast<size_t>(rank)];
    if (rank + kAhead < end) graph.Prefetch(places_[static_cast<size_t>(rank + kAhead)]);
    const int32_t from = clumps_[static_cast<size_t>(place)];
    std::span<const int32_t> others = graph.Neighbours(place);
    while (!others.empty()) {
      size_t count = 0;
      const std::span<const int32_t> some = others.first(std::min(others.size(), outside.size()));
      for (const int32_t other : some) {
        // A clump is all in one block. Without branches, which nobody could predict.
        const int32_t to = clumps_[static_cast<size_t>(std::max(other, ~other))];
        outside[count] = {to, other};
        count += static_cast<size_t>(((to < begin) | (to >= end)) & (other >= 0));
      }
      others = others.subspan(some.size());
      for (const auto& [to, other] : std::span(outside).first(count)) {
        std::pair<int32_t, int32_t>& same =
            recent[static_cast<size_t>(to / kBlock + to) % recent.size()];
        if (same == std::pair(from, to)) continue;
        same = {from, to};
        links.push_back({rank, place, other});
      }
    }
  }
}

int32_t Pieces::Root(int32_t clump) {
  while (joined_[static_cast<size_t>(clump)] != clump) {
    int32_t& joined = joined_[static_cast<size_t>(clump)];
    joined = joined_[static_cast<size_t>(joined)];
    clump = joined;
  }
  return clump;
}

// Joins clumps to pieces and numbers these. True if they are more than before.
bool Pieces::Join() {
  int32_t pieces = 0;
  for (const Block& block : blocks_) {
    for (const int32_t clump : block.clumps) joined_[static_cast<size_t>(clump)] = clump;
    pieces += static_cast<int32_t>(block.clumps.size());
  }
  for (const Block& block : blocks_) {
    for (const Link& link : block.links) {
      int32_t from = clumps_[static_cast<size_t>(link.from)];
      int32_t to = clumps_[static_cast<size_t>(link.to)];
      // Most are joined already.
      if (joined_[static_cast<size_t>(from)] == joined_[static_cast<size_t>(to)]) continue;
      from = Root(from);
      to = Root(to);
      if (from == to) continue;
      joined_[static_cast<size_t>(std::max(from, to))] = std::min(from, to);
      --pieces;
    }
  }
  if (pieces == count()) return false;
  // The first place of each piece is the least of its clumps'.
  for (const Block& block : blocks_) {
    for (const int32_t clump : block.clumps) {
      int32_t& first = numbers_[static_cast<size_t>(Root(clump))];
      if (Root(clump) == clump) first = firsts_[static_cast<size_t>(clump)];
      first = std::min(first, firsts_[static_cast<size_t>(clump)]);
    }
  }
  std::vector<std::pair<int32_t, int32_t>> roots;  // by first place
  roots.reserve(static_cast<size_t>(pieces));
  for (const Block& block : blocks_) {
    for (const int32_t clump : block.clumps) {
      if (Root(clump) == clump) roots.push_back({numbers_[static_cast<size_t>(clump)], clump});
    }
  }
  std::sort(roots.begin(), roots.end());
  // Of a former piece that has several parts, all are new.
  std::vector<int32_t> parts(leaders_.size(), 0);
  if (!leaders_.empty()) {
    for (const auto& [first, root] : roots) {
      ++parts[static_cast<size_t>(labels_[static_cast<size_t>(first)])];
    }
  }
  is_new_.clear();
  for (const auto& [first, root] : roots) {
    is_new_.push_back(leaders_.empty() ||
                              parts[static_cast<size_t>(labels_[static_cast<size_t>(first)])] > 1
                          ? 1
                          : 0);
  }
  leaders_.clear();
  for (const auto& [first, root] : roots) {
    numbers_[static_cast<size_t>(root)] = static_cast<int32_t>(leaders_.size());
    leaders_.push_back(first);
  }
  for (const Block& block : blocks_) {
    for (const int32_t clump : block.clumps) {
      numbers_[static_cast<size_t>(clump)] = numbers_[static_cast<size_t>(Root(clump))];
    }
  }
  ParallelFor(static_cast<int64_t>(labels_.size()), 8192, [&](int64_t begin, int64_t end) {
    for (auto place = static_cast<size_t>(begin); place < static_cast<size_t>(end); ++place) {
      labels_[place] = numbers_[static_cast<size_t>(clumps_[place])];
    }
  });
  return true;
}

}  // namespace cleave
