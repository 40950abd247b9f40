#include "core/stream/stencils.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/base/lanes.h"
#include "core/base/parallel.h"
#include "core/base/run_both.h"

namespace cleave {
namespace {

constexpr int64_t kAhead = 8;  // how far ahead that is fetched which will be read

bool ContainsAny(const Stencil& stencil, std::span<const int32_t> places) {
  Int32x8 of_stencil;
  std::memcpy(&of_stencil, stencil.places.data(), sizeof(of_stencil));
  Int32x8 found{};
  for (const int32_t place : places) found |= of_stencil == place;
  return Any(found);
}

}  // namespace

Stencils::Stencils(const NodeOrder& order, std::span<const Vec3> rest_by_place,
                   std::span<const std::array<int32_t, 2>> edges,
                   std::optional<VisiblePlaces> visible)
    : rest_(rest_by_place.begin(), rest_by_place.end()),
      graph_(order, edges),
      visible_(std::move(visible)) {
  stencils_.resize(rest_.size());
  reaches_.resize(rest_.size());
  lost_edges_.assign(rest_.size(), 0);
  changes_.assign(rest_.size(), kNone);
  pieces_.Find(order, graph_);
  cubes_.resize(static_cast<size_t>(order.groups()));
  for (size_t group = 1; group < cubes_.size(); ++group) {
    for (size_t size = 0; size < kCubeSizes; ++size) {
      const int bits = order.cube_bits[group] + static_cast<int>(size);
      if (bits > kMortonBits) continue;
      CubeIndex& cubes = cubes_[group][size];
      cubes = CubeIndex(order.coarser[group], bits);
      if (visible_) cubes.Clear();
    }
  }
  if (visible_) {
    near_fresh_.resize(cubes_.size());
    marks_.assign(rest_.size(), 0);
    far_squares_.resize(rest_.size());
    ShowInCubes(order, visible_->places());
  }
  TouchAll();
  Rebuild(order, touched_);
}

Stencils::Stencils(const NodeOrder& order, std::span<const Vec3> rest_by_place,
                   std::span<const std::array<int32_t, 2>> edges)
    : Stencils(order, rest_by_place, edges, std::nullopt) {}

Stencils::Stencils(const NodeOrder& order, std::span<const Vec3> rest_by_place,
                   const StreamMesh& mesh)
    : Stencils(order, rest_by_place, mesh.edges, VisiblePlaces(order, mesh.edges, mesh.tets)) {}

void Stencils::Touch(int32_t place, Change change) {
  // Several threads may say so of one place.
  const std::atomic_ref<Change> greatest(changes_[static_cast<size_t>(place)]);
  Change was = greatest.load(std::memory_order_relaxed);
  while (was < change && !greatest.compare_exchange_weak(was, change, std::memory_order_relaxed)) {
  }
}

// Breaks only take places out of a search's reach. So a stencil stays as it is while all of its
// places remain in reach, and only those that may have lost one are made anew: here those that were
// found over an edge that `near` lost, or over one of its edges and then that.
void Stencils::TouchAround(int32_t near) {
  const auto touch = [&](std::span<const int32_t> lost) {
    const Reach reach = reaches_[static_cast<size_t>(near)];
    if (reach == kTwoEdges ||
        (reach == kOneEdge && ContainsAny(stencils_[static_cast<size_t>(near)], lost))) {
      Touch(near, kSearch);
    }
    const int32_t first = *std::min_element(lost.begin(), lost.end());
    const std::span<const int32_t> ring = graph_.Neighbours(near);
    std::array<int32_t, 64> others;
    for (size_t begin = 0; begin < ring.size(); begin += others.size()) {
      size_t found = 0;
      for (const int32_t place :
           ring.subspan(begin, std::min(others.size(), ring.size() - begin))) {
        const auto index = static_cast<size_t>(std::max(place, 0));
        __builtin_prefetch(stencils_.data() + index);
        others[found] = place;
        // Stencils have earlier places only. Without branches, which nobody could predict.
        found += static_cast<size_t>((place >= first) & (reaches_[index] == kTwoEdges) &
                                     (ChangeOf(std::max(place, 0)) == kNone));
      }
      for (const int32_t other : std::span(others).first(found)) {
        if (ContainsAny(stencils_[static_cast<size_t>(other)], lost)) Touch(other, kSearch);
      }
    }
  };
  std::array<int32_t, 64> lost;
  size_t count = 0;
  for (const int32_t other : graph_.Neighbours(near)) {
    // Edges between such places that were broken before make no difference.
    if (other >= 0 || lost_edges_[static_cast<size_t>(~other)] == 0) continue;
    lost[count++] = ~other;
    if (count < lost.size()) continue;
    touch(lost);
    count = 0;
  }
  if (count > 0) touch(std::span(lost.data(), count));
}

// Of stencils that were found in space, those with places that are now of another piece.
void Stencils::TouchInSpace() {
  ParallelFor(graph_.places(), 8192, [&](int64_t begin, int64_t end) {
    for (auto place = static_cast<int32_t>(begin); place < end; ++place) {
      if (reaches_[static_cast<size_t>(place)] >= kInSpace && LostPlaces(place)) {
        Touch(place, kSearch);
      }
    }
  });
}

// Of a stencil that was found in space: whether some of its places are now of another piece.
bool Stencils::LostPlaces(int32_t place) const {
  const int32_t piece = pieces_[place];
  const Stencil& stencil = stencils_[static_cast<size_t>(place)];
  if (!pieces_.IsNew(piece) || stencil.leads()) return false;
  bool lost = false;
  for (const int32_t other : stencil.places) lost |= pieces_[other] != piece;
  return lost;
}

void Stencils::TouchAll() {
  if (visible_) {
    FindLeaders();
    touched_ = visible_->places();
  } else {
    touched_.resize(rest_.size());
    std::iota(touched_.begin(), touched_.end(), 0);
  }
}

// Appends the places whose mark is not 0, ascending.
void Stencils::ListMarked(std::span<const uint8_t> marks, std::vector<int32_t>& places) {
  std::array<int32_t, 256> some;
  for (size_t begin = 0; begin < marks.size(); begin += some.size()) {
    const size_t end = std::min(marks.size(), begin + some.size());
    size_t count = 0;
    for (size_t place = begin; place < end; ++place) {  // without a branch, as nobody could predict
      some[count] = static_cast<int32_t>(place);
      count += static_cast<size_t>(marks[place] != 0);
    }
    places.insert(places.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
  }
}

// Lists what was touched, and says where to search for it.
void Stencils::TakeTouched() {
  ListMarked(changes_, touched_);
  size_t count = 0;
  for (const int32_t place : touched_) {
    const auto index = static_cast<size_t>(place);
    const Change change = changes_[index];
    if (change == kSearchInSpace) reaches_[index] = kInSpace;
    if (change == kSearchAnew) reaches_[index] = kOneEdge;
    touched_[count] = place;
    count += static_cast<size_t>(!visible_ || visible_->Has(place));
  }
  touched_.resize(count);
  std::fill(changes_.begin(), changes_.end(), kNone);
}

const std::vector<int32_t>& Stencils::SetBroken(const NodeOrder& order,
                                                std::span<const int32_t> broken) {
  touched_.clear();
  fresh_.clear();
  if (std::equal(broken.begin(), broken.end(), broken_.begin(), broken_.end())) return touched_;
  std::vector<int32_t> fresh;
  std::set_difference(broken.begin(), broken.end(), broken_.begin(), broken_.end(),
                      std::back_inserter(fresh));
  if (fresh.size() + broken_.size() != broken.size()) {  // some are whole again
    graph_.Heal();
    std::fill(reaches_.begin(), reaches_.end(), kOneEdge);
    for (const int32_t edge : broken) graph_.Break(edge);
    pieces_.Find(order, graph_);
    if (visible_) {
      visible_->Heal();
      fresh_ = visible_->Break(graph_, broken);
      for (auto& sizes : cubes_) {
        for (CubeIndex& cubes : sizes) cubes.Clear();
      }
      ShowInCubes(order, visible_->places());
    }
    TouchAll();
  } else {
    ParallelFor(static_cast<int64_t>(fresh.size()), 512, [&](int64_t begin, int64_t end) {
      for (int64_t at = begin; at < end; ++at) {
        if (at + 2 * kAhead < end) {
          graph_.PrefetchSlots(fresh[static_cast<size_t>(at + 2 * kAhead)]);
        }
        if (at + kAhead < end) graph_.PrefetchEdge(fresh[static_cast<size_t>(at + kAhead)]);
        const int32_t edge = fresh[static_cast<size_t>(at)];
        graph_.Break(edge);
        for (const int32_t place : graph_.Ends(edge)) {
          std::atomic_ref<uint8_t>(lost_edges_[static_cast<size_t>(place)])
              .store(1, std::memory_order_relaxed);
        }
      }
    });
    std::vector<int32_t> ends;
    ListMarked(lost_edges_, ends);
    ParallelFor(static_cast<int64_t>(ends.size()), 64, [&](int64_t begin, int64_t end) {
      for (int64_t at = begin; at < end; ++at) {
        if (at + kAhead < end) graph_.Prefetch(ends[static_cast<size_t>(at + kAhead)]);
        TouchAround(ends[static_cast<size_t>(at)]);
      }
    });
    for (const int32_t end : ends) lost_edges_[static_cast<size_t>(end)] = 0;
    bool splits = false;
    const auto split = [&] { splits = pieces_.Split(graph_, fresh); };
    const auto show = [&] {
      fresh_ = visible_->Break(graph_, fresh);
      ShowInCubes(order, fresh_);
      TouchRoundFresh(order);
    };
    if (visible_) {
      RunBoth(split, show);
      RunBoth([&] { TouchInSpaceInView(order, splits); }, [&] { FindLeaders(); });
    } else {
      split();
      if (splits) TouchInSpace();
    }
    TakeTouched();
  }
  broken_.assign(broken.begin(), broken.end());
  Rebuild(order, touched_);
  return touched_;
}

}  // namespace cleave
