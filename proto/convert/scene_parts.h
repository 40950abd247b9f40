#ifndef CLEAVE_PROTO_CONVERT_SCENE_PARTS_H_
#define CLEAVE_PROTO_CONVERT_SCENE_PARTS_H_

#include <string>

#include "cleave/v1/scene.pb.h"
#include "core/scene/scene.h"
#include "proto/convert/field_reader.h"

namespace cleave {

// Parts of a scene from their messages, for SceneFromMessage; `field` is a part's path in faults.
MeshSource MeshSourceFromMessage(const v1::MeshSource& message, const FieldReader& read);
RenderMeshSource RenderMeshSourceFromMessage(const v1::RenderMeshSource& message);
Selector SelectorFromMessage(const v1::Selector& message, const std::string& field,
                             const FieldReader& read);
Weakening WeakeningFromMessage(const v1::Weakening& message, const std::string& field,
                               const FieldReader& read);
Motion MotionFromMessage(const v1::Motion& message, const std::string& field,
                         const FieldReader& read);
Load LoadFromMessage(const v1::Load& message, const std::string& field, const FieldReader& read);
Collider ColliderFromMessage(const v1::Collider& message, const std::string& field,
                             const FieldReader& read);

}  // namespace cleave

#endif  // CLEAVE_PROTO_CONVERT_SCENE_PARTS_H_
