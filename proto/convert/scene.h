#ifndef CLEAVE_PROTO_CONVERT_SCENE_H_
#define CLEAVE_PROTO_CONVERT_SCENE_H_

#include <string>

#include "cleave/v1/scene.pb.h"
#include "core/base/faults.h"
#include "core/scene/scene.h"

namespace cleave {

// The scene that a message describes, absent optional fields at their defaults. Reports in `faults`
// what a message can say and a scene cannot: vectors that are not three numbers, unknown enum
// values. Ranges and references are for ValidateScene, which may be run on the result in any case.
Scene SceneFromMessage(const v1::Scene& message, Faults& faults);

// The same for one material; `field` is its path in faults.
Material MaterialFromMessage(const v1::Material& message, const std::string& field, Faults& faults);

// The message that describes a scene; SceneFromMessage gives the same scene back.
v1::Scene MessageFromScene(const Scene& scene);

v1::Material MessageFromMaterial(const Material& material);

// Puts the numbers of presets in place of their names, so that the message means the same to every
// version of Cleave. Reports names that are no preset. SceneFromMessage does it by itself.
void ResolvePresets(v1::Scene& scene, Faults& faults);
void ResolvePreset(const std::string& field, v1::Material& material, Faults& faults);

}  // namespace cleave

#endif  // CLEAVE_PROTO_CONVERT_SCENE_H_
