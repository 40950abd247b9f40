#ifndef CLEAVE_CORE_STREAM_NEAR_PLACES_H_
#define CLEAVE_CORE_STREAM_NEAR_PLACES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/large_vector.h"
#include "core/base/vec3.h"
#include "core/stream/edge_graph.h"
#include "core/stream/node_order.h"

namespace cleave {

inline constexpr size_t kMaxNearPlaces = 784;  // of a place

// Of each place the coarser places from which a surface view may predict it, and over which edges
// they are joined: FORMAT.md, "Near places". They follow from the mesh alone; what is broken or
// hidden is for the reader to leave out.
class NearPlaces {
 public:
  struct Near {
    int32_t place = 0;
    // The edges that lead there, twice the same if it is one; or no_edge() where more would.
    std::array<int32_t, 2> edges{};
  };
  // Who has a place among their near ones.
  struct Reader {
    int32_t place = 0;
    int32_t rank = 0;  // there
  };

  // `outer`: by place, not 0 if it is visible before any edge breaks. Precondition: no edge of
  // `graph` is broken. Loops run on the current TBB arena.
  NearPlaces(const NodeOrder& order, std::span<const Vec3> rest_by_place,
             std::span<const uint8_t> outer, const EdgeGraph& graph);

  // Nearest first, kMaxNearPlaces at most.
  std::span<const Near> Of(int32_t place) const {
    const auto row = static_cast<size_t>(place);
    return {near_.data() + begins_[row], counts_[row]};
  }
  // By place.
  std::span<const Reader> ReadersOf(int32_t place) const {
    const size_t begin = reader_begins_[static_cast<size_t>(place)];
    const size_t end = reader_begins_[static_cast<size_t>(place) + 1];
    return {readers_.data() + begin, end - begin};
  }
  int32_t no_edge() const { return no_edge_; }

 private:
  void FindNear(const NodeOrder& order, std::span<const Vec3> rest_by_place,
                std::span<const uint8_t> outer);
  void FindEdges(const EdgeGraph& graph);
  void FindReaders();

  int32_t no_edge_;
  // Of each place from begins_ on as many as counts_ says; there may be room behind.
  LargeVector<Near> near_;
  std::vector<size_t> begins_;
  std::vector<uint16_t> counts_;
  LargeVector<Reader> readers_;
  std::vector<size_t> reader_begins_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_NEAR_PLACES_H_
