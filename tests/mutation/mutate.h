#ifndef CLEAVE_TESTS_MUTATION_MUTATE_H_
#define CLEAVE_TESTS_MUTATION_MUTATE_H_

#include <google/protobuf/message.h>

#include <cstdint>
#include <string>

#include "absl/strings/string_view.h"
#include "core/base/counter_rng.h"

namespace cleave {

// Draws for mutations; the same seed gives the same sequence on every machine, so a failure is
// repeated by its number.
class Dice {
 public:
  explicit Dice(uint64_t seed) : seed_(seed) {}
  // In [0, sides); 0 when sides is 0.
  uint64_t Roll(uint64_t sides);
  bool OneIn(uint64_t chances) { return Roll(chances) == 0; }

 private:
  uint64_t seed_;
  uint64_t drawn_ = 0;
};

// Damages bytes as a careless or hostile writer would: flipped bits, noise, cuts, repeats,
// insertions and numbers at the edge of their range.
std::string MutateBytes(absl::string_view bytes, Dice& dice);

// Changes a few fields of a message, anywhere in its tree, to values that its type allows and its
// meaning may not: NaN, infinities, extremes, empty and long strings, unknown enum values, lists
// that are cut, doubled or shuffled, absent and duplicated messages. The result always serialises.
void MutateMessage(google::protobuf::Message& message, Dice& dice);

}  // namespace cleave

#endif  // CLEAVE_TESTS_MUTATION_MUTATE_H_
