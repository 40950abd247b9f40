#ifndef CLEAVE_CORE_STREAM_INTERPOLATION_PREDICTOR_H_
#define CLEAVE_CORE_STREAM_INTERPOLATION_PREDICTOR_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/stream/node_order.h"
#include "core/stream/stencils.h"
#include "core/stream/stream_header.h"
#include "core/stream/stream_mesh.h"
#include "core/stream/stream_state.h"

namespace cleave {

// Coordinates x, y, z of a place, in grid units.
using Grid3 = std::array<int32_t, 3>;

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
class InterpolationPredictor {
 public:
  InterpolationPredictor(const StreamHeader& header, const StreamMesh& mesh);

  const NodeOrder& order() const { return order_; }
  const Pieces& pieces() const { return stencils_.pieces(); }
  const Stencils& stencils() const { return stencils_; }

  // To this tolerance's grid, this set of broken edges and this history (positions of the last
  // frame and of the one before, by place; empty before the first frame). Without `history_is_new`
  // it must be the history of the last call, or what Accept made of it.
  void Prepare(double tolerance, std::span<const int32_t> broken, std::span<const int32_t> last,
               std::span<const int32_t> before, bool history_is_new);

  // What stands before a group is decoded is given to `continuation(group, next)`, which chooses.
  // Then for each of its places `correct(place, prediction)` gives the position, which goes to
  // `next`. Places of a group may be corrected at the same time; its leaders come first. In a key
  // frame, `key`, leaders are predicted from rest.
  template <typename Choose, typename Correct>
  void Run(bool key, std::span<const int32_t> last, std::span<const int32_t> before,
           std::span<int32_t> next, const Choose& choose, const Correct& correct);

  // Makes the frame of the last Run the last frame. After a key frame the body counts as at rest.
  void Accept(bool key);
  // Makes the last frame also the one before it.
  void Hold();

  // Of a place that does not lead: the blend of its stencil in `positions`.
  Grid3 Blend(int32_t place, std::span<const int32_t> positions) const {
    const Stencil& stencil = stencils_[place];
    std::array<int64_t, 3> sum{};
    for (size_t k = 0; k < kStencilNodes; ++k) {
      const int32_t* from = positions.data() + 3 * static_cast<size_t>(stencil.places[k]);
      const int64_t weight = stencil.weights[k];
      sum[0] += weight * from[0];
      sum[1] += weight * from[1];
      sum[2] += weight * from[2];
    }
    return {Clamp((sum[0] + kStencilOne / 2) >> 15), Clamp((sum[1] + kStencilOne / 2) >> 15),
            Clamp((sum[2] + kStencilOne / 2) >> 15)};
  }

  // Details of a place: of the last frame, of the one before, at rest.
  struct Details {
    Grid3 last{};
    Grid3 before{};
    Grid3 rest{};
  };
  const Details& details(int32_t place) const { return details_[static_cast<size_t>(place)]; }

  static Grid3 Predict(const Grid3& blend, const Details& details, const Continuation& by) {
    Grid3 prediction;
    for (size_t axis = 0; axis < 3; ++axis) {
      const int64_t sum = int64_t{by.last} * details.last[axis] +
                          int64_t{by.before} * details.before[axis] +
                          int64_t{by.rest} * details.rest[axis];
      prediction[axis] = Clamp(blend[axis] + ((sum + kContinuationOne / 2) >> 6));
    }
    return prediction;
  }

 private:
  static int32_t Clamp(int64_t value) {
    return static_cast<int32_t>(
        std::clamp<int64_t>(value, -int64_t{kMaxQuantised}, int64_t{kMaxQuantised}));
  }
  Grid3 DetailIn(int32_t place, std::span<const int32_t> positions) const;
  void MakeDetails(int32_t place, std::span<const int32_t> last, std::span<const int32_t> before);

  NodeOrder order_;
  Stencils stencils_;
  Vec3 origin_;
  double domain_bound_;
  double tolerance_ = 0;       // m, of rest_
  std::vector<int32_t> rest_;  // on the grid, by place
  std::vector<Details> details_;
  std::vector<Grid3> next_details_;  // those of the frame in work
};

template <typename Choose, typename Correct>
void InterpolationPredictor::Run(bool key, std::span<const int32_t> last,
                                 std::span<const int32_t> before, std::span<int32_t> next,
                                 const Choose& choose, const Correct& correct) {
  const std::vector<int32_t>& leaders = pieces().leaders();
  const auto put = [&](int32_t place, const Grid3& position) {
    std::copy(position.begin(), position.end(), next.begin() + 3 * place);
  };
  auto leader = leaders.begin();
  for (int64_t group = 0; group < order_.groups(); ++group) {
    const int32_t begin = order_.group_begins[static_cast<size_t>(group)];
    const int32_t end = order_.group_begins[static_cast<size_t>(group) + 1];
    for (; leader != leaders.end() && *leader < end; ++leader) {
      const auto at = 3 * static_cast<size_t>(*leader);
      Grid3 prediction;
      for (size_t axis = 0; axis < 3; ++axis) {
        prediction[axis] =
            key ? rest_[at + axis] : PredictLinear(last[at + axis], before[at + axis]);
      }
      put(*leader, correct(*leader, prediction));
      next_details_[static_cast<size_t>(*leader)] = {};
    }
    const Continuation by = choose(group, std::span<const int32_t>(next));
    ParallelFor(end - begin, 2048, [&](int64_t from, int64_t to) {
      for (auto place = static_cast<int32_t>(begin + from); place < begin + to; ++place) {
        if (stencils_[place].leads()) continue;
        const Grid3 blend = Blend(place, next);
        const Grid3 position = correct(place, Predict(blend, details(place), by));
        put(place, position);
        for (size_t axis = 0; axis < 3; ++axis) {
          next_details_[static_cast<size_t>(place)][axis] = position[axis] - blend[axis];
        }
      }
    });
  }
}

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_INTERPOLATION_PREDICTOR_H_
