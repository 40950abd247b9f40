#ifndef CLEAVE_CORE_SCENE_COLLIDER_RULES_H_
#define CLEAVE_CORE_SCENE_COLLIDER_RULES_H_

#include "core/base/faults.h"
#include "core/scene/scene.h"

namespace cleave {

// Holds scene.contact to the rules.
void CheckContact(const Scene& scene, Faults& faults);

// Holds scene.sleep to the rules.
void CheckSleep(const Scene& scene, Faults& faults);

// Holds scene.colliders to the rules. Surfaces have to be closed and to face outwards: every edge
// of a triangle is that of exactly one other, which runs along it the other way.
void CheckColliders(const Scene& scene, Faults& faults);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_COLLIDER_RULES_H_
