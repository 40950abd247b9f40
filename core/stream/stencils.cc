#include "core/stream/stencils.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <utility>

#include "core/base/parallel.h"
#include "core/base/run_both.h"

namespace cleave {
namespace {

constexpr int64_t kAhead = 8;  // how far ahead that is fetched which will be read

// Appends the places whose mark is not 0, ascending.
void ListMarked(std::span<const uint8_t> marks, std::vector<int32_t>& places) {
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

}  // namespace

Stencils::Stencils(const NodeOrder& order, std::span<const Vec3> rest_by_place,
                   std::span<const std::array<int32_t, 2>> edges)
    : rest_(rest_by_place.begin(), rest_by_place.end()), graph_(order, edges) {
  search_ = MakeSearch(order);
  Prepare(order);
}

Stencils::Stencils(const NodeOrder& order, std::span<const Vec3> rest_by_place,
                   const StreamMesh& mesh)
    : rest_(rest_by_place.begin(), rest_by_place.end()), graph_(order, mesh.edges) {
  VisiblePlaces visible(order, mesh.edges, mesh.tets);
  auto near = std::make_shared<const NearPlaces>(order, rest_, visible.marks(), graph_);
  view_ = View{.visible = std::move(visible),
               .near = std::move(near),
               .broken = std::vector<uint64_t>(mesh.edges.size() / 64 + 1, 0),
               .ranks = std::vector<uint16_t>(rest_.size(), 0),
               .kinds = std::vector<Kind>(rest_.size(), kAllByEdges),
               .leaders = {},
               .leader_of = {}};
  Prepare(order);
}

// Everything for a body of which no edge is broken.
void Stencils::Prepare(const NodeOrder& order) {
  stencils_.resize(rest_.size());
  lost_edges_.assign(rest_.size(), 0);
  marks_.assign(rest_.size(), 0);
  pieces_.Find(order, graph_);
  MakeAll(order);
}

void Stencils::MakeAll(const NodeOrder& order) {
  if (view_) {
    FindLeaders();
    std::fill(view_->ranks.begin(), view_->ranks.end(), uint16_t{0});
    touched_ = view_->visible.places();
    ChooseForTouched();
  } else {
    std::fill(search_->reaches.begin(), search_->reaches.end(), kOneEdge);
    touched_.resize(rest_.size());
    std::iota(touched_.begin(), touched_.end(), 0);
    SearchForTouched(order);
  }
}

// Breaks these edges, ascending, and marks what loses one.
void Stencils::Break(std::span<const int32_t> edges) {
  ParallelFor(static_cast<int64_t>(edges.size()), 512, [&](int64_t begin, int64_t end) {
    for (int64_t at = begin; at < end; ++at) {
      if (at + 2 * kAhead < end) graph_.PrefetchSlots(edges[static_cast<size_t>(at + 2 * kAhead)]);
      if (at + kAhead < end) graph_.PrefetchEdge(edges[static_cast<size_t>(at + kAhead)]);
      const int32_t edge = edges[static_cast<size_t>(at)];
      graph_.Break(edge);
      for (const int32_t place : graph_.Ends(edge)) {
        std::atomic_ref<uint8_t>(lost_edges_[static_cast<size_t>(place)])
            .store(1, std::memory_order_relaxed);
      }
    }
  });
  if (!view_) return;
  for (const int32_t edge : edges) {
    view_->broken[static_cast<size_t>(edge) / 64] |= uint64_t{1} << (edge % 64);
  }
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

// Finds the weights of these, four at most.
void Stencils::Weigh(std::span<const int32_t> places) {
  StencilBatch batch;
  for (size_t lane = 0; lane < places.size(); ++lane) {
    const auto index = static_cast<size_t>(places[lane]);
    const Vec3& centre = rest_[index];
    const Stencil& stencil = stencils_[index];
    size_t count = 0;  // places but for those that repeat the first
    while (count < kStencilNodes && (count == 0 || stencil.places[count] != stencil.places[0]) &&
           !stencil.leads()) {
      const Vec3& neighbour = rest_[static_cast<size_t>(stencil.places[count])];
      for (size_t axis = 0; axis < 3; ++axis) {
        batch.offsets[count][axis][static_cast<int>(lane)] = neighbour[axis] - centre[axis];
      }
      ++count;
    }
    batch.counts[static_cast<int>(lane)] = static_cast<int32_t>(count);
  }
  const std::array<Int32x4, kStencilNodes> weights = StencilWeights(batch);
  for (size_t lane = 0; lane < places.size(); ++lane) {
    Stencil& stencil = stencils_[static_cast<size_t>(places[lane])];
    const bool leads = stencil.leads();
    for (size_t k = 0; k < kStencilNodes; ++k) {
      stencil.weights[k] = leads ? 0 : weights[k][static_cast<int>(lane)];
    }
  }
}

const std::vector<int32_t>& Stencils::SetBroken(const NodeOrder& order,
                                                std::span<const int32_t> broken) {
  touched_.clear();
  fresh_.clear();
  if (std::equal(broken.begin(), broken.end(), broken_.begin(), broken_.end())) return touched_;
  std::vector<int32_t> more;
  std::set_difference(broken.begin(), broken.end(), broken_.begin(), broken_.end(),
                      std::back_inserter(more));
  const bool heals = more.size() + broken_.size() != broken.size();
  broken_.assign(broken.begin(), broken.end());
  if (heals) {
    graph_.Heal();
    if (view_) {
      std::fill(view_->broken.begin(), view_->broken.end(), 0);
      view_->visible.Heal();
    }
    Break(broken);
    std::fill(lost_edges_.begin(), lost_edges_.end(), uint8_t{0});
    pieces_.Find(order, graph_);
    if (view_) fresh_ = view_->visible.Break(graph_, broken);
    MakeAll(order);
    return touched_;
  }
  Break(more);
  std::vector<int32_t> ends;
  ListMarked(lost_edges_, ends);
  if (view_) {
    bool splits = false;
    RunBoth([&] { splits = pieces_.Split(graph_, more); },
            [&] { fresh_ = view_->visible.Break(graph_, more); });
    RunBoth([&] { TouchInView(ends, splits); }, [&] { FindLeaders(); });
  } else {
    TouchAround(ends);
    if (pieces_.Split(graph_, more)) TouchInSpace();
  }
  for (const int32_t end : ends) lost_edges_[static_cast<size_t>(end)] = 0;
  ListMarked(marks_, touched_);
  for (const int32_t place : touched_) marks_[static_cast<size_t>(place)] = 0;
  if (view_) {
    ChooseForTouched();
  } else {
    SearchForTouched(order);
  }
  return touched_;
}

}  // namespace cleave
