#ifndef CLEAVE_CORE_STREAM_INTERPOLATION_PREDICTOR_H_
#define CLEAVE_CORE_STREAM_INTERPOLATION_PREDICTOR_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "core/base/int4.h"
#include "core/base/large_vector.h"
#include "core/base/parallel.h"
#include "core/stream/node_order.h"
#include "core/stream/stencils.h"
#include "core/stream/stream_header.h"
#include "core/stream/stream_mesh.h"
#include "core/stream/stream_state.h"

namespace cleave {

// How a group's details continue, in 1/64: the next is a of the last, b of the one before and c of
// that at rest.
struct Continuation {
  int32_t last = 0;
  int32_t before = 0;
  int32_t rest = 0;
  bool operator==(const Continuation&) const = default;
};
inline constexpr int32_t kContinuationOne = 64;
inline constexpr int32_t kMaxContinuation = 4 * kContinuationOne;
inline constexpr Continuation kFromRest = {0, 0, kContinuationOne};

// Those that a frame names by one byte, their position here: the detail stays, goes on as it went,
// half so, is that at rest.
inline constexpr std::array<Continuation, 4> kNamedContinuations = {
    {{64, 0, 0}, {128, -64, 0}, {96, -32, 0}, kFromRest}};

// Predictor 2 of FORMAT.md: each place from coarser places of the same frame and from how it lay
// among them before. A place's detail is what remains of its position after the blend of its
// stencil's. Holds what follows from rest positions, broken edges and the last two frames, and
// keeps it up to date; encoder and decoder hold the same. Loops run on the current TBB arena.
//
// Coordinates are whole numbers of grid units. Where they are worked with, the lanes of a vector
// are x, y, z and 0; doubles are exact, since no sum comes near 2^53.
class InterpolationPredictor {
 public:
  InterpolationPredictor(const StreamHeader& header, const StreamMesh& mesh);

  const NodeOrder& order() const { return order_; }
  const Pieces& pieces() const { return stencils_.pieces(); }
  const Stencils& stencils() const { return stencils_; }

  // Places that frames carry, ascending; of those, the ones within [first, first + count).
  const std::vector<int32_t>& places() const {
    return stencils_.visible() ? stencils_.visible()->places() : all_places_;
  }
  std::span<const int32_t> PlacesWithin(int64_t first, int64_t count) const;

  // To this tolerance's grid, this set of broken edges and this history (positions of the last
  // frame and of the one before, by place; empty before the first frame). Without `history_is_new`
  // it must be the history of the last call, or what Accept made of it. For a frame that is no key,
  // places that only these edges make visible are given a history.
  void Prepare(bool key, double tolerance, std::span<const int32_t> broken, std::span<int32_t> last,
               std::span<int32_t> before, bool history_is_new);
  // The same for a frame that was coded.
  void Return(double tolerance, std::span<const int32_t> broken, std::span<const int32_t> last,
              std::span<const int32_t> before);

  // Goes through the groups. What stands before one is decoded is what `choose(group)` may Blend,
  // and it gives how the group's details continue. Then for each of its places
  // `correct(place, prediction)` gives the position, which goes to `next`; where `holds(place)` it
  // is that of `last`. Places of a group may be corrected at the same time; its leaders come first.
  // In a key frame, `key`, leaders are predicted from rest.
  template <typename Choose, typename Holds, typename Correct>
  void Run(bool key, std::span<const int32_t> last, std::span<const int32_t> before,
           std::span<int32_t> next, const Choose& choose, const Holds& holds,
           const Correct& correct);

  // Makes the frame of the last Run the last frame. After a key frame the body counts as at rest.
  void Accept(bool key);
  // Makes the last frame also the one before it.
  void Hold();

  // Of a place that does not lead: the blend of its stencil in the frame in work.
  Double4 Blend(int32_t place) const {
    return BlendOf(place, [&](int32_t of) { return positions_[static_cast<size_t>(of)]; });
  }
  // The details of a place: of the last frame, of the one before, at rest.
  const Int32x4& LastDetail(int32_t place) const { return last_[static_cast<size_t>(place)]; }
  const Int32x4& DetailBefore(int32_t place) const { return before_[static_cast<size_t>(place)]; }
  const Int32x4& RestDetail(int32_t place) const { return at_rest_[static_cast<size_t>(place)]; }

 private:
  static Double4 Clamp(Double4 value) {
    return Max(Min(value, Splat(kMaxQuantised)), Splat(-kMaxQuantised));
  }
  template <typename Load>
  Double4 BlendOf(int32_t place, const Load& load) const {
    const Stencil& stencil = stencils_[place];
    const auto term = [&](size_t k) {
      return WideProduct(load(stencil.places[k]), stencil.weights[k]);
    };
    const Int64x4 sum =
        ((term(0) + term(1)) + (term(2) + term(3))) + ((term(4) + term(5)) + (term(6) + term(7)));
    return Clamp(ToDoubles(ShiftRight<kStencilBits>(sum + kStencilOne / 2)));
  }
  Double4 BlendIn(int32_t place, std::span<const int32_t> positions) const;
  Int32x4 DetailIn(int32_t place, std::span<const int32_t> positions) const;
  bool SetGrid(double tolerance);
  void MakeRestDetails(const std::vector<int32_t>& places);
  void MakeDetails(const std::vector<int32_t>& places, std::span<const int32_t> last,
                   std::span<const int32_t> before);
  void MakeHistory(std::span<int32_t> positions) const;
  void MakeHistoryOfLeader(int32_t place, std::span<int32_t> positions) const;

  NodeOrder order_;
  Stencils stencils_;
  std::vector<int32_t> all_places_;  // in the state view
  Vec3 origin_;
  double domain_bound_;
  double tolerance_ = 0;            // m, of rest_
  std::vector<int32_t> rest_;       // on the grid, by place
  LargeVector<Int32x4> positions_;  // of the frame in work
  LargeVector<Int32x4> next_;       // details of the frame in work
  LargeVector<Int32x4> last_;       // details of the last frame
  LargeVector<Int32x4> before_;     // details of the one before
  LargeVector<Int32x4> at_rest_;    // details at rest
};

template <typename Choose, typename Holds, typename Correct>
void InterpolationPredictor::Run(bool key, std::span<const int32_t> last,
                                 std::span<const int32_t> before, std::span<int32_t> next,
                                 const Choose& choose, const Holds& holds, const Correct& correct) {
  const auto put = [&](int32_t place, Int32x4 position) {
    positions_[static_cast<size_t>(place)] = position;
    std::memcpy(next.data() + 3 * static_cast<size_t>(place), &position, 3 * sizeof(int32_t));
  };
  const auto keep = [&](int32_t place) {
    const int32_t* from = last.data() + 3 * static_cast<size_t>(place);
    put(place, Int32x4{from[0], from[1], from[2], 0});
    next_[static_cast<size_t>(place)] = last_[static_cast<size_t>(place)];
  };
  const std::vector<int32_t>& leaders = stencils_.leaders();
  if (stencils_.visible()) std::fill(next.begin(), next.end(), 0);
  auto leader = leaders.begin();
  for (int64_t group = 0; group < order_.groups(); ++group) {
    const int32_t begin = order_.group_begins[static_cast<size_t>(group)];
    const int32_t end = order_.group_begins[static_cast<size_t>(group) + 1];
    for (; leader != leaders.end() && *leader < end; ++leader) {
      const int32_t place = *leader;
      next_[static_cast<size_t>(place)] = Int32x4{};
      if (holds(place)) {
        keep(place);
        continue;
      }
      const auto at = 3 * static_cast<size_t>(place);
      Double4 prediction{};
      for (size_t axis = 0; axis < 3; ++axis) {
        prediction[static_cast<int>(axis)] =
            key ? rest_[at + axis] : PredictLinear(last[at + axis], before[at + axis]);
      }
      put(place, ToInts(correct(place, prediction)));
    }
    const Continuation by = choose(group);
    const Double4 of_last = Splat(by.last);
    const Double4 of_before = Splat(by.before);
    const Double4 of_rest = Splat(by.rest);
    const auto run = [&](int64_t count, const auto& place_at) {
      ParallelFor(count, 2048, [&](int64_t from, int64_t to) {
        for (int64_t at = from; at < to; ++at) {
          const int32_t place = place_at(at);
          if (stencils_[place].leads()) continue;
          if (holds(place)) {
            keep(place);
            continue;
          }
          const Double4 blend = Blend(place);
          const Double4 detail = of_last * Widen(LastDetail(place)) +
                                 of_before * Widen(DetailBefore(place)) +
                                 of_rest * Widen(RestDetail(place));
          const Double4 prediction =
              Clamp(blend + Floor((detail + kContinuationOne / 2) * (1.0 / kContinuationOne)));
          const Double4 position = correct(place, prediction);
          put(place, ToInts(position));
          next_[static_cast<size_t>(place)] = ToInts(position - blend);
        }
      });
    };
    if (stencils_.visible()) {
      const std::span<const int32_t> places = PlacesWithin(begin, end - begin);
      run(static_cast<int64_t>(places.size()),
          [&](int64_t at) { return places[static_cast<size_t>(at)]; });
    } else {
      run(end - begin, [&](int64_t at) { return static_cast<int32_t>(begin + at); });
    }
  }
}

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_INTERPOLATION_PREDICTOR_H_
