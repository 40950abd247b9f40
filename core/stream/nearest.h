#ifndef CLEAVE_CORE_STREAM_NEAREST_H_
#define CLEAVE_CORE_STREAM_NEAREST_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/vec3.h"
#include "core/stream/stencil_weights.h"

namespace cleave {

// The kStencilNodes nearest of the places that it is offered, each once, by distance and then by
// place.
class Nearest {
 public:
  explicit Nearest(const Vec3& centre) : centre_(centre) {}

  // One more place, if it is `wanted`; without a branch, which nobody could predict.
  void Offer(int32_t place, const Vec3& position, bool wanted) {
    const double dx = position[0] - centre_[0];
    const double dy = position[1] - centre_[1];
    const double dz = position[2] - centre_[2];
    squares_[count_] = dx * dx + dy * dy + dz * dz;
    places_[count_] = place;
    count_ += static_cast<size_t>(wanted);
    if (count_ == places_.size()) Settle();
  }
  // Chooses among all that were offered; before that, what is below says nothing.
  void Settle();
  void Clear() { count_ = 0; }

  size_t count() const { return count_; }
  int32_t operator[](size_t at) const { return places_[at]; }

 private:
  static constexpr size_t kRoom = 256;
  static constexpr size_t kFew = 16;
  // Settles kFew at most. False, with nothing changed, if two are as far.
  bool SortFew();
  void SortAny();

  Vec3 centre_;
  size_t count_ = 0;
  std::array<double, kRoom> squares_;  // those settled first, then those offered
  std::array<int32_t, kRoom> places_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_STREAM_NEAREST_H_
