#include "core/stream/near_places.h"

#include <algorithm>
#include <bit>
#include <vector>

#include "core/base/parallel.h"
#include "core/stream/cube_index.h"

namespace cleave {
namespace {

constexpr int kCubeSizes = 4;      // sizes of cube that are searched around a place
constexpr size_t kOuterNear = 16;  // of an outer place: how many that are outer as well
constexpr int64_t kGrain = 256;    // places

// How many near places those of a group have, by how many of all places are coarser: more where few
// are. What comes into view is as thin as the finest, so the coarser they are the fewer of them are
// in view.
size_t NearOf(size_t coarser, size_t all) {
  const auto rarity = static_cast<size_t>(std::bit_width(all / coarser)) - 1;  // log2
  return size_t{24} << std::min<size_t>((rarity + 1) / 3, 5);
}
static_assert((24 << 5) + kOuterNear == kMaxNearPlaces);

struct Candidate {
  double square;  // of its distance (m^2)
  int32_t place;
  bool operator<(const Candidate& other) const {
    return square != other.square ? square < other.square : place < other.place;
  }
  bool operator==(const Candidate&) const = default;
};

// Cubes of several sizes that coarser places are in.
class CubeSizes {
 public:
  CubeSizes(std::span<const NodeOrder::Coarse> places, int least_bits) {
    for (int bits = least_bits; bits < least_bits + kCubeSizes && bits <= kMortonBits; ++bits) {
      cubes_.emplace_back(places, bits);
    }
  }
  const std::vector<CubeIndex>& cubes() const { return cubes_; }

 private:
  std::vector<CubeIndex> cubes_;
};

// The nearest of what cubes round a place hold.
class Candidates {
 public:
  // The `count` nearest in the first size of which the cubes hold twice as many.
  void Find(const CubeSizes& sizes, uint64_t code, std::span<const Vec3> rest, const Vec3& centre,
            size_t count) {
    for (const CubeIndex& of_size : sizes.cubes()) {
      found_.clear();
      const CubesAround around(code, of_size.bits());
      for (const CubesAround::Some& some : around.blocks()) {
        of_size.ForCubes(some, [&](std::span<const int32_t> in_cube) {
          for (const int32_t other : in_cube) {
            const Vec3& x = rest[static_cast<size_t>(other)];
            const double dx = x[0] - centre[0];
            const double dy = x[1] - centre[1];
            const double dz = x[2] - centre[2];
            found_.push_back({dx * dx + dy * dy + dz * dz, other});
          }
        });
      }
      if (found_.size() >= 2 * count) break;
    }
    Keep(count);
  }
  void Join(const Candidates& others) {
    found_.insert(found_.end(), others.found_.begin(), others.found_.end());
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
  }
  const std::vector<Candidate>& found() const { return found_; }  // nearest first

 private:
  void Keep(size_t count) {
    const auto end = found_.begin() + static_cast<std::ptrdiff_t>(std::min(count, found_.size()));
    std::partial_sort(found_.begin(), end, found_.end());
    found_.erase(end, found_.end());
  }

  std::vector<Candidate> found_;
};

// A place's near ones by place: a hash table of their ranks.
class Ranks {
 public:
  void Set(std::span<const NearPlaces::Near> near) {
    near_ = near;
    slots_.assign(std::bit_ceil(4 * near.size() + 1), -1);
    for (size_t rank = 0; rank < near.size(); ++rank) {
      slots_[Find(near[rank].place)] = static_cast<int16_t>(rank);
    }
  }
  // -1 if it is none of them.
  int Of(int32_t place) const { return slots_[Find(place)]; }

 private:
  size_t Find(int32_t place) const {
    size_t at = static_cast<uint32_t>(place) * 0x9E3779B1u >> 16 & (slots_.size() - 1);
    while (slots_[at] >= 0 && near_[static_cast<size_t>(slots_[at])].place != place) {
      at = (at + 1) % slots_.size();
    }
    return at;
  }

  std::span<const NearPlaces::Near> near_;
  std::vector<int16_t> slots_;  // a power of two
};

}  // namespace

NearPlaces::NearPlaces(const NodeOrder& order, std::span<const Vec3> rest_by_place,
                       std::span<const uint8_t> outer, const EdgeGraph& graph)
    : no_edge_(graph.edges()), begins_(rest_by_place.size(), 0), counts_(rest_by_place.size(), 0) {
  FindNear(order, rest_by_place, outer);
  FindEdges(graph);
  FindReaders();
}

void NearPlaces::FindNear(const NodeOrder& order, std::span<const Vec3> rest_by_place,
                          std::span<const uint8_t> outer) {
  const auto groups = static_cast<size_t>(order.groups());
  const size_t count = rest_by_place.size();
  size_t room = 0;
  for (size_t group = 1; group < groups; ++group) {
    const auto first = static_cast<size_t>(order.group_begins[group]);
    const size_t most = NearOf(first, count);
    for (size_t place = first; place < static_cast<size_t>(order.group_begins[group + 1]);
         ++place) {
      begins_[place] = room;
      room += std::min(first, most + (outer[place] != 0 ? kOuterNear : 0));
    }
  }
  near_.resize(room);
  std::vector<NodeOrder::Coarse> coarser_outer;
  for (size_t group = 1; group < groups; ++group) {
    const int32_t first = order.group_begins[group];
    const size_t most = NearOf(static_cast<size_t>(first), count);
    const CubeSizes of_all(order.coarser[group], order.cube_bits[group]);
    coarser_outer.clear();
    for (const NodeOrder::Coarse& coarse : order.coarser[group]) {
      if (outer[static_cast<size_t>(coarse.place)] != 0) coarser_outer.push_back(coarse);
    }
    const CubeSizes of_outer(coarser_outer, order.cube_bits[group]);
    ParallelFor(order.group_begins[group + 1] - first, kGrain, [&](int64_t begin, int64_t end) {
      Candidates near, near_outer;
      for (int64_t at = begin; at < end; ++at) {
        const auto place = static_cast<size_t>(first + at);
        near.Find(of_all, order.codes[place], rest_by_place, rest_by_place[place], most);
        if (outer[place] != 0) {
          near_outer.Find(of_outer, order.codes[place], rest_by_place, rest_by_place[place],
                          kOuterNear);
          near.Join(near_outer);
        }
        for (size_t rank = 0; rank < near.found().size(); ++rank) {
          near_[begins_[place] + rank] = {near.found()[rank].place, {no_edge_, no_edge_}};
        }
        counts_[place] = static_cast<uint16_t>(near.found().size());
      }
    });
  }
}

void NearPlaces::FindEdges(const EdgeGraph& graph) {
  const LargeVector<int32_t> edges = graph.EdgesOfSlots();
  ParallelFor(graph.places(), kGrain, [&](int64_t begin, int64_t end) {
    Ranks ranks;
    for (auto place = static_cast<int32_t>(begin); place < end; ++place) {
      ranks.Set(Of(place));
      const auto near_of = [&](int rank) -> Near& {
        return near_[begins_[static_cast<size_t>(place)] + static_cast<size_t>(rank)];
      };
      const std::span<const int32_t> ring = graph.Neighbours(place);
      const size_t slot = graph.SlotOf(place);
      for (size_t k = 0; k < ring.size(); ++k) {
        const int rank = ranks.Of(ring[k]);
        if (rank >= 0) near_of(rank).edges = {edges[slot + k], edges[slot + k]};
      }
      // Over the lowest place that is next to both.
      for (size_t k = 0; k < ring.size(); ++k) {
        const std::span<const int32_t> beyond = graph.Neighbours(ring[k]);
        const size_t slot_beyond = graph.SlotOf(ring[k]);
        for (size_t j = 0; j < beyond.size(); ++j) {
          const int rank = ranks.Of(beyond[j]);
          if (rank < 0 || near_of(rank).edges[0] != no_edge_) continue;
          near_of(rank).edges = {edges[slot + k], edges[slot_beyond + j]};
        }
      }
    }
  });
}

void NearPlaces::FindReaders() {
  const size_t count = counts_.size();
  reader_begins_.assign(count + 1, 0);
  const auto for_all = [&](const auto& visit) {
    for (size_t place = 0; place < count; ++place) {
      int32_t rank = 0;
      for (const Near& near : Of(static_cast<int32_t>(place))) {
        visit(static_cast<size_t>(near.place), Reader{static_cast<int32_t>(place), rank++});
      }
    }
  };
  for_all([&](size_t of, const Reader&) { ++reader_begins_[of + 1]; });
  for (size_t place = 0; place < count; ++place) reader_begins_[place + 1] += reader_begins_[place];
  readers_.resize(reader_begins_[count]);
  std::vector<size_t> next(reader_begins_.begin(), reader_begins_.end() - 1);
  for_all([&](size_t of, const Reader& reader) { readers_[next[of]++] = reader; });
}

}  // namespace cleave
