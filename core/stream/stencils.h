#ifndef CLEAVE_CORE_STREAM_STENCILS_H_
#define CLEAVE_CORE_STREAM_STENCILS_H_

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/large_vector.h"
#include "core/base/vec3.h"
#include "core/stream/cube_index.h"
#include "core/stream/edge_graph.h"
#include "core/stream/near_places.h"
#include "core/stream/nearest.h"
#include "core/stream/node_order.h"
#include "core/stream/pieces.h"
#include "core/stream/stencil_weights.h"
#include "core/stream/stream_mesh.h"
#include "core/stream/visible_places.h"

namespace cleave {

// Earlier places from which a place is predicted, all of its own piece. Unused ones repeat the
// first, with weight 0. The leader of a piece has none: all are -1.
struct alignas(64) Stencil {
  std::array<int32_t, kStencilNodes> places{};
  std::array<int32_t, kStencilNodes> weights{};

  bool leads() const { return places[0] < 0; }
};

// The stencils of all places, or of those that a surface view carries: then others are in none, and
// have none. They follow from the mesh and the set of broken edges alone, however that set came
// about. Loops run on the current TBB arena.
class Stencils {
 public:
  Stencils(const NodeOrder& order, std::span<const Vec3> rest_by_place,
           std::span<const std::array<int32_t, 2>> edges);
  // Of a surface view.
  Stencils(const NodeOrder& order, std::span<const Vec3> rest_by_place, const StreamMesh& mesh);

  // Brings everything to this set of broken edges (ascending ids in range). Where edges only broke,
  // the work is in proportion to what they touch. Returns the places whose stencil may have
  // changed, ascending.
  const std::vector<int32_t>& SetBroken(const NodeOrder& order, std::span<const int32_t> broken);

  const Stencil& operator[](int32_t place) const { return stencils_[static_cast<size_t>(place)]; }
  const Pieces& pieces() const { return pieces_; }
  // The first visible place of each piece, ascending.
  const std::vector<int32_t>& leaders() const { return view_ ? view_->leaders : pieces_.leaders(); }
  // That of a piece; -1 if nothing of it is visible.
  int32_t LeaderOf(int32_t piece) const {
    return view_ ? view_->leader_of[static_cast<size_t>(piece)]
                 : pieces_.leaders()[static_cast<size_t>(piece)];
  }
  // Of a surface view; else null.
  const VisiblePlaces* visible() const { return view_ ? &view_->visible : nullptr; }
  const NearPlaces* near() const { return view_ ? view_->near.get() : nullptr; }  // likewise
  // Places that the last SetBroken made visible, ascending. Where edges are whole again, as if all
  // had been, and then had broken.
  const std::vector<int32_t>& fresh() const { return fresh_; }
  // The lowest place that was visible before that SetBroken and shares an edge, whole or broken,
  // with `place`; or -1. Precondition: a surface view.
  int32_t KnownNeighbour(int32_t place) const;
  const LargeVector<Vec3>& rest_positions() const { return rest_; }  // m, by place
  const std::vector<int32_t>& broken() const { return broken_; }

 private:
  // Where a stencil's places were found: over one edge, over two, or in space, there in cubes of
  // the least size, the next, ... What later changes it, and where to search then, depends on that.
  using Reach = uint8_t;
  static constexpr Reach kOneEdge = 0;
  static constexpr Reach kTwoEdges = 1;
  static constexpr Reach kInSpace = 2;
  static constexpr size_t kCubeSizes = 3;

  // What the state view searches with.
  struct Search {
    std::vector<std::array<CubeIndex, kCubeSizes>> cubes;  // of each group: the coarser places
    std::vector<Reach> reaches;                            // by place
  };
  // What a stencil of a surface view has: places that edges led to; some that none led to; only a
  // leader, or nothing.
  using Kind = uint8_t;
  static constexpr Kind kAllByEdges = 0;
  static constexpr Kind kSomeInSpace = 1;
  static constexpr Kind kNoneFound = 2;

  // What a surface view has.
  struct View {
    VisiblePlaces visible;
    std::shared_ptr<const NearPlaces> near;  // which copies share
    std::vector<uint64_t> broken;            // a bit for each edge; one more stays 0
    // By place: which of its near places is the last of its stencil; kMaxNearPlaces where there is
    // room for more, 0 where it is hidden.
    std::vector<uint16_t> ranks;
    std::vector<Kind> kinds;         // by place, of its stencil
    std::vector<int32_t> leaders;    // ascending
    std::vector<int32_t> leader_of;  // of each piece: its first visible place, or -1
  };

  void Prepare(const NodeOrder& order);
  void MakeAll(const NodeOrder& order);
  void Break(std::span<const int32_t> edges);
  void Touch(int32_t place) {  // several threads may do so
    std::atomic_ref(marks_[static_cast<size_t>(place)]).store(1, std::memory_order_relaxed);
  }
  bool IsTouched(int32_t place) {  // as far as is known
    return std::atomic_ref(marks_[static_cast<size_t>(place)]).load(std::memory_order_relaxed) != 0;
  }
  bool LostPlaces(int32_t place) const;
  void Weigh(std::span<const int32_t> places);
  // In stencil_search.cc, for the state view.
  Search MakeSearch(const NodeOrder& order) const;
  void TouchAround(std::span<const int32_t> ends);
  void TouchAround(int32_t near);
  void TouchInSpace();
  void SearchFor(const NodeOrder& order, int32_t place, Nearest& nearest);
  void SearchForTouched(const NodeOrder& order);
  // In stencils_in_view.cc, for a surface view.
  void FindLeaders();
  void TouchInView(std::span<const int32_t> ends, bool splits);
  bool ChooseInView(int32_t place);
  void ChooseForTouched();

  LargeVector<Vec3> rest_;  // m, by place
  EdgeGraph graph_;
  Pieces pieces_;
  LargeVector<Stencil> stencils_;
  std::vector<int32_t> broken_;
  std::vector<uint8_t> lost_edges_;  // by place: 1 in a call that breaks some
  std::vector<uint8_t> marks_;       // by place: 1 if it was touched; all 0 but in SetBroken
  std::vector<int32_t> touched_;
  std::vector<int32_t> fresh_;
  std::optional<Search> search_;  // one of both
  std::optional<View> view_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_STENCILS_H_
