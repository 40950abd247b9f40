#ifndef CLEAVE_CORE_STREAM_STENCILS_H_
#define CLEAVE_CORE_STREAM_STENCILS_H_

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/large_vector.h"
#include "core/base/vec3.h"
#include "core/stream/cube_index.h"
#include "core/stream/edge_graph.h"
#include "core/stream/nearest.h"
#include "core/stream/node_order.h"
#include "core/stream/pieces.h"
#include "core/stream/stencil_weights.h"
#include "core/stream/stream_mesh.h"
#include "core/stream/visible_places.h"

namespace cleave {

inline constexpr size_t kCubeSizes = 3;  // sizes of cube that are searched around a place

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
  // the work is in proportion to what they touch. Returns the places whose stencil was made anew,
  // ascending.
  const std::vector<int32_t>& SetBroken(const NodeOrder& order, std::span<const int32_t> broken);

  const Stencil& operator[](int32_t place) const { return stencils_[static_cast<size_t>(place)]; }
  const Pieces& pieces() const { return pieces_; }
  // The first visible place of each piece, ascending.
  const std::vector<int32_t>& leaders() const { return visible_ ? leaders_ : pieces_.leaders(); }
  // That of a piece; -1 if nothing of it is visible.
  int32_t LeaderOf(int32_t piece) const {
    return visible_ ? leader_of_[static_cast<size_t>(piece)]
                    : pieces_.leaders()[static_cast<size_t>(piece)];
  }
  // Set in a surface view.
  const std::optional<VisiblePlaces>& visible() const { return visible_; }
  // Places that the last SetBroken made visible, ascending. Where edges are whole again, as if all
  // had been, and then had broken.
  const std::vector<int32_t>& fresh() const { return fresh_; }
  // The lowest place that was visible before that SetBroken and shares an edge, whole or broken,
  // with `place`; or -1.
  int32_t KnownNeighbour(int32_t place) const;
  const LargeVector<Vec3>& rest_positions() const { return rest_; }  // m, by place
  const std::vector<int32_t>& broken() const { return broken_; }

 private:
  Stencils(const NodeOrder& order, std::span<const Vec3> rest_by_place,
           std::span<const std::array<int32_t, 2>> edges, std::optional<VisiblePlaces> visible);

  // Where a stencil's places were found: over one edge, over two, or in space, there in cubes of
  // the least size, the next, ... What later changes it, and where to search then, depends on that.
  using Reach = uint8_t;
  static constexpr Reach kOneEdge = 0;
  static constexpr Reach kTwoEdges = 1;
  static constexpr Reach kInSpace = 2;

  // What must be done about a stencil: the greatest of what is found to be.
  using Change = uint8_t;
  static constexpr Change kNone = 0;
  static constexpr Change kSearch = 1;         // from its reach on
  static constexpr Change kSearchInSpace = 2;  // that is its reach; from the least cubes on
  static constexpr Change kSearchAnew = 3;

  // In stencil_search.cc.
  template <typename IsVisible>
  void Search(const NodeOrder& order, int32_t place, Nearest& nearest, IsVisible is_visible);
  template <typename IsVisible>
  void Rebuild(const NodeOrder& order, std::span<const int32_t> places,
               const IsVisible& is_visible);
  void Rebuild(const NodeOrder& order, std::span<const int32_t> places);
  // In stencils_in_view.cc.
  void FindLeaders();
  void ShowInCubes(const NodeOrder& order, std::span<const int32_t> places);
  void TouchRoundFresh(const NodeOrder& order);
  void TouchInSpaceInView(const NodeOrder& order, bool splits);
  void TouchRing(int32_t between);

  void TouchAll();
  void Touch(int32_t place, Change change);
  Change ChangeOf(int32_t place) {  // as far as is known
    return std::atomic_ref(changes_[static_cast<size_t>(place)]).load(std::memory_order_relaxed);
  }
  bool LostPlaces(int32_t place) const;
  void TouchAround(int32_t near);
  void TouchInSpace();
  void TakeTouched();
  static void ListMarked(std::span<const uint8_t> marks, std::vector<int32_t>& places);

  LargeVector<Vec3> rest_;  // m, by place
  EdgeGraph graph_;
  // Of each group: the coarser places, in a surface view those that are visible.
  std::vector<std::array<CubeIndex, kCubeSizes>> cubes_;
  Pieces pieces_;
  LargeVector<Stencil> stencils_;
  std::vector<Reach> reaches_;
  std::vector<int32_t> broken_;
  std::vector<uint8_t> lost_edges_;  // by place: 1 in a call that breaks some
  std::vector<Change> changes_;      // by place; all kNone but in SetBroken
  std::vector<int32_t> touched_;
  // In a surface view.
  std::optional<VisiblePlaces> visible_;
  std::vector<int32_t> fresh_;
  std::vector<uint8_t> marks_;  // by place; all 0 but in SetBroken
  // Of each place's stencil: how far its last place is, squared (m^2), or infinity if it has room.
  std::vector<double> far_squares_;
  // Of each group: the cubes that touch one that coarser fresh places are in.
  std::vector<std::array<CubeSet, kCubeSizes>> near_fresh_;
  std::vector<int32_t> leaders_;    // ascending
  std::vector<int32_t> leader_of_;  // of each piece: its first visible place, or -1
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_STENCILS_H_
