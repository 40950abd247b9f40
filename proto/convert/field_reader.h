#ifndef CLEAVE_PROTO_CONVERT_FIELD_READER_H_
#define CLEAVE_PROTO_CONVERT_FIELD_READER_H_

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/base/faults.h"
#include "core/base/vec3.h"
#include "google/protobuf/repeated_field.h"

namespace cleave {

using Numbers = google::protobuf::RepeatedField<double>;

// What messages hold as numbers, as what scenes hold; says of each field what was wrong.
class FieldReader {
 public:
  explicit FieldReader(Faults& faults) : faults_(faults) {}

  Faults& faults() const { return faults_; }

  Vec3 Vector(const std::string& field, const Numbers& numbers, const Vec3& if_empty) const {
    if (numbers.empty()) return if_empty;
    if (numbers.size() != 3) {
      faults_.Error(field, absl::StrCat("has ", numbers.size(), " numbers; three are required"));
      return if_empty;
    }
    return {numbers[0], numbers[1], numbers[2]};
  }

  Vec3 RequiredVector(const std::string& field, const Numbers& numbers,
                      const Vec3& stand_in) const {
    if (numbers.empty()) {
      faults_.Error(field, "is missing; three numbers are required");
    }
    return Vector(field, numbers, stand_in);
  }

  // Groups of kSize numbers.
  template <size_t kSize, typename Number>
  std::vector<std::array<Number, kSize>> Groups(
      const std::string& field, const google::protobuf::RepeatedField<Number>& numbers) const {
    if (static_cast<size_t>(numbers.size()) % kSize != 0) {
      faults_.Error(field, absl::StrCat("has ", numbers.size(), " numbers; a multiple of ", kSize,
                                        " is required"));
    }
    std::vector<std::array<Number, kSize>> groups(static_cast<size_t>(numbers.size()) / kSize);
    for (size_t k = 0; k < groups.size() * kSize; ++k)
      groups[k / kSize][k % kSize] = numbers[static_cast<int>(k)];
    return groups;
  }

  // The enum after "unspecified", which stands for its first value, where the enum has the
  // order of its message.
  template <typename Enum>
  Enum AfterUnspecified(absl::string_view field, int value, int count) const {
    if (value < 0 || value > count) {
      faults_.Error(field, absl::StrCat(value, " is outside [0, ", count, "]"));
      return Enum{};
    }
    return static_cast<Enum>(std::max(value, 1) - 1);
  }

 private:
  Faults& faults_;
};

}  // namespace cleave

#endif  // CLEAVE_PROTO_CONVERT_FIELD_READER_H_
