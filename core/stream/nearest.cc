#include "core/stream/nearest.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>
#include <limits>

#include "core/base/lanes.h"

namespace cleave {
namespace {

constexpr int32_t kNone = std::numeric_limits<int32_t>::max();

// The eight least of what it is given, ascending.
class EightLeast {
 public:
  void Add(int32_t key) {
    const Int32x8 keys = Int32x8{} + key;
    const Int32x8 one_on = __builtin_shufflevector(keys, least_, 0, 8, 9, 10, 11, 12, 13, 14);
    const Int32x8 at_least = one_on > keys ? one_on : keys;
    least_ = least_ < at_least ? least_ : at_least;
  }
  // The eighth of all that two of them were given.
  static int32_t Eighth(const EightLeast& a, const EightLeast& b) {
    const Int32x8 turned = __builtin_shufflevector(b.least_, b.least_, 7, 6, 5, 4, 3, 2, 1, 0);
    const Int32x8 least = a.least_ < turned ? a.least_ : turned;
    int32_t eighth = least[0];
    for (int lane = 1; lane < 8; ++lane) eighth = std::max(eighth, least[lane]);
    return eighth;
  }

 private:
  Int32x8 least_ = Int32x8{} + kNone;
};

}  // namespace

void Nearest::Settle() {
  static_assert(kStencilNodes == 8);
  if (count_ <= kFew) {
    if (SortFew()) return;
  } else {
    // Bits of floats that are not negative have the order of the floats, and rounding to floats
    // keeps the order of doubles. So no place above the eighth key is among the nearest.
    std::array<int32_t, kRoom + 1> keys;
    for (size_t at = 0; at < count_; ++at) {
      keys[at] = std::bit_cast<int32_t>(static_cast<float>(squares_[at]));
    }
    keys[count_] = kNone;
    EightLeast even, odd;
    for (size_t at = 0; at < count_; at += 2) {
      even.Add(keys[at]);
      odd.Add(keys[at + 1]);
    }
    const int32_t eighth = EightLeast::Eighth(even, odd);
    std::array<uint8_t, kRoom> near;
    size_t count = 0;
    for (size_t at = 0; at < count_; ++at) {
      near[count] = static_cast<uint8_t>(at);
      count += static_cast<size_t>(keys[at] <= eighth);
    }
    // The rest stays where it is, in case that some were offered twice and the key is too low.
    if (count <= kFew) {
      Nearest few(centre_);
      few.count_ = count;
      for (size_t at = 0; at < count; ++at) {
        few.squares_[at] = squares_[near[at]];
        few.places_[at] = places_[near[at]];
      }
      if (few.SortFew()) {
        count_ = few.count_;
        std::copy_n(few.squares_.begin(), count_, squares_.begin());
        std::copy_n(few.places_.begin(), count_, places_.begin());
        return;
      }
    }
  }
  SortAny();
}

bool Nearest::SortFew() {
  constexpr int kVectors = static_cast<int>(kFew) / 4;
  for (size_t at = count_; at < kFew; ++at) squares_[at] = std::numeric_limits<double>::infinity();
  // How many are before each.
  std::array<Double4, kVectors> squares;
  std::memcpy(&squares, squares_.data(), sizeof(squares));
  std::array<Int64x4, kVectors> before{};
  std::array<Int64x4, kVectors> equal{};
  for (size_t at = 0; at < count_; ++at) {
    const Double4 other = Splat(squares_[at]);
    for (size_t v = 0; v < kVectors; ++v) {
      before[v] -= other < squares[v];
      equal[v] -= other == squares[v];
    }
  }
  std::array<int64_t, kFew> ranks;
  std::memcpy(ranks.data(), &before, sizeof(ranks));
  Int64x4 some_equal{};
  for (const Int64x4 of_vector : equal) some_equal |= of_vector > 1;
  if (Any(some_equal)) return false;
  std::array<double, kFew> sorted_squares{};
  std::array<int32_t, kFew> sorted_places{};
  for (size_t at = 0; at < count_; ++at) {
    const auto rank = static_cast<size_t>(ranks[at]);
    sorted_squares[rank] = squares_[at];
    sorted_places[rank] = places_[at];
  }
  count_ = std::min(count_, kStencilNodes);
  std::copy_n(sorted_squares.begin(), kStencilNodes, squares_.begin());
  std::copy_n(sorted_places.begin(), kStencilNodes, places_.begin());
  return true;
}

void Nearest::SortAny() {
  size_t kept = 0;
  for (size_t from = 0; from < count_; ++from) {
    const double square = squares_[from];
    const int32_t place = places_[from];
    size_t at = kept;
    while (at > 0 &&
           (square < squares_[at - 1] || (square == squares_[at - 1] && place < places_[at - 1]))) {
      --at;
    }
    if (at == kStencilNodes || (at > 0 && places_[at - 1] == place)) continue;
    if (kept < kStencilNodes) ++kept;
    for (size_t to = kept - 1; to > at; --to) {
      squares_[to] = squares_[to - 1];
      places_[to] = places_[to - 1];
    }
    squares_[at] = square;
    places_[at] = place;
  }
  count_ = kept;
}

}  // namespace cleave
