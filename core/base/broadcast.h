#ifndef CLEAVE_CORE_BASE_BROADCAST_H_
#define CLEAVE_CORE_BASE_BROADCAST_H_

#include <cstdint>

namespace cleave {

// A read-only array that may be one value for all: a pointer and a stride of 1 or 0, so that
// uniform and per-item data take the same code with no branch. Does not own the data.
template <typename T>
class Broadcast {
 public:
  static Broadcast Uniform(const T& value) { return Broadcast(&value, 0); }
  static Broadcast PerItem(const T* values) { return Broadcast(values, 1); }

  const T& operator[](int64_t index) const { return data_[index * stride_]; }
  bool uniform() const { return stride_ == 0; }

 private:
  Broadcast(const T* data, int64_t stride) : data_(data), stride_(stride) {}
  const T* data_;
  int64_t stride_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_BROADCAST_H_
