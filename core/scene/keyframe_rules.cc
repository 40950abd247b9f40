#include "core/scene/keyframe_rules.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "core/scene/checker.h"
#include "core/scene/limits.h"

namespace cleave {

bool CheckKeyframes(const std::string& field, const std::vector<Keyframe>& keyframes,
                    Faults& faults) {
  Checker check(faults);
  if (!check.List(field, keyframes.size(), limits::kMaxKeyframes)) return false;
  bool turns = false;
  for (size_t k = 0; k < keyframes.size(); ++k) {
    const Keyframe& keyframe = keyframes[k];
    const std::string at = At(field, k);
    if (!std::isfinite(keyframe.time)) {
      faults.Error(at + ".time", absl::StrCat(keyframe.time, " is not a finite number"));
    } else if (k > 0 && !(keyframe.time > keyframes[k - 1].time)) {
      faults.Error(at + ".time", absl::StrCat(keyframe.time, " s is not after the previous, ",
                                              keyframes[k - 1].time, " s"));
    }
    check.Coordinates(at + ".translation", keyframe.translation);
    check.Within(at + ".rotation", keyframe.rotation, -limits::kMaxLength, limits::kMaxLength);
    turns = turns || keyframe.rotation != 0;
  }
  return turns;
}

}  // namespace cleave
