#ifndef CLEAVE_CORE_SCENE_KEYFRAME_RULES_H_
#define CLEAVE_CORE_SCENE_KEYFRAME_RULES_H_

#include <string>
#include <vector>

#include "core/base/faults.h"
#include "core/scene/scene.h"

namespace cleave {

// Holds the keyframes in the list called `field` to the rules. Returns whether any of them turns.
bool CheckKeyframes(const std::string& field, const std::vector<Keyframe>& keyframes,
                    Faults& faults);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_KEYFRAME_RULES_H_
