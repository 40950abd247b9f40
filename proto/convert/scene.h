#ifndef CLEAVE_PROTO_CONVERT_SCENE_H_
#define CLEAVE_PROTO_CONVERT_SCENE_H_

#include "cleave/v1/scene.pb.h"
#include "core/base/faults.h"
#include "core/scene/scene.h"

namespace cleave {

// The scene that a message describes, absent optional fields at their defaults. Reports in `faults`
// what a message can say and a scene cannot: vectors that are not three numbers, unknown enum
// values. Ranges and references are for ValidateScene, which may be run on the result in any case.
Scene SceneFromMessage(const v1::Scene& message, Faults& faults);

// The message that describes a scene; SceneFromMessage gives the same scene back.
v1::Scene MessageFromScene(const Scene& scene);

}  // namespace cleave

#endif  // CLEAVE_PROTO_CONVERT_SCENE_H_
