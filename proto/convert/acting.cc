#include <array>
#include <string>
#include <variant>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/scene/checker.h"
#include "core/scene/limits.h"
#include "proto/convert/scene_parts.h"

namespace cleave {
namespace {

std::array<bool, 3> Axes(const std::string& field, const google::protobuf::RepeatedField<int>& axes,
                         const FieldReader& read) {
  if (axes.empty()) return {true, true, true};
  std::array<bool, 3> prescribed{false, false, false};
  for (int i = 0; i < axes.size(); ++i) {
    if (axes[i] < v1::AXIS_X || axes[i] > v1::AXIS_Z) {
      read.faults().Error(absl::StrCat(field, "[", i, "]"),
                          absl::StrCat(axes[i], " is not one of AXIS_X, AXIS_Y, AXIS_Z"));
      continue;
    }
    prescribed[static_cast<size_t>(axes[i] - v1::AXIS_X)] = true;
  }
  return prescribed;
}

std::vector<Keyframe> Keyframes(const FieldReader& read, const std::string& field,
                                const google::protobuf::RepeatedPtrField<v1::Keyframe>& from) {
  std::vector<Keyframe> keyframes;
  for (int i = 0; i < from.size(); ++i) {
    keyframes.push_back({from[i].time(),
                         read.Vector(absl::StrCat(field, ".keyframes[", i, "].translation"),
                                     from[i].translation(), {0, 0, 0}),
                         from[i].rotation()});
  }
  return keyframes;
}

Release OneRelease(const v1::Release& message) {
  Release release;
  if (message.has_time()) release.time = message.time();
  release.first_fracture = message.first_fracture();
  if (message.has_broken_share()) release.broken_share = message.broken_share();
  if (message.has_pieces()) release.pieces = message.pieces();
  release.separated_node_sets.assign(message.separated_node_sets().begin(),
                                     message.separated_node_sets().end());
  return release;
}

Shape OneShape(const std::string& field, const v1::Collider& message, const FieldReader& read) {
  switch (message.shape_case()) {
    case v1::Collider::kPlane:
      return PlaneShape{read.Vector(field + ".plane.point", message.plane().point(), {0, 0, 0}),
                        read.Vector(field + ".plane.normal", message.plane().normal(), {0, 0, 1})};
    case v1::Collider::kSphere:
      return SphereShape{
          read.Vector(field + ".sphere.center", message.sphere().center(), {0, 0, 0}),
          message.sphere().radius()};
    case v1::Collider::kBox: {
      BoxShape box;
      box.center = read.Vector(field + ".box.center", message.box().center(), box.center);
      box.size = read.RequiredVector(field + ".box.size", message.box().size(), {1, 1, 1});
      box.rotation_axis = read.Vector(field + ".box.rotation_axis", message.box().rotation_axis(),
                                      box.rotation_axis);
      box.rotation = message.box().rotation();
      return box;
    }
    case v1::Collider::kSurface: {
      const v1::SurfaceShape& from = message.surface();
      SurfaceShape surface;
      surface.vertices = read.Groups<3>(field + ".surface.vertices", from.vertices());
      surface.file = from.file();
      const double unit_scale = from.has_unit_scale() ? from.unit_scale() : 1;
      Checker(read.faults())
          .Above(field + ".surface.unit_scale", unit_scale, 0, limits::kMaxUnitScale);
      for (Vec3& vertex : surface.vertices) {
        for (double& coordinate : vertex) coordinate *= unit_scale;
      }
      surface.triangles = read.Groups<3>(field + ".surface.triangles", from.triangles());
      return surface;
    }
    case v1::Collider::SHAPE_NOT_SET:
      break;
  }
  return std::monostate{};
}

}  // namespace

Motion MotionFromMessage(const v1::Motion& message, const std::string& field,
                         const FieldReader& read) {
  Motion motion;
  motion.node_set = message.node_set();
  motion.axes = Axes(field + ".axes", message.axes(), read);
  motion.rotation_center =
      read.Vector(field + ".rotation_center", message.rotation_center(), motion.rotation_center);
  motion.rotation_axis =
      read.Vector(field + ".rotation_axis", message.rotation_axis(), motion.rotation_axis);
  motion.keyframes = Keyframes(read, field, message.keyframes());
  if (message.has_release()) motion.release = OneRelease(message.release());
  return motion;
}

Load LoadFromMessage(const v1::Load& message, const std::string& field, const FieldReader& read) {
  Load load;
  load.node_set = message.node_set();
  switch (message.kind_case()) {
    case v1::Load::kForce:
      load.kind = PointForce{
          read.RequiredVector(field + ".force.total", message.force().total(), {0, 0, 0})};
      break;
    case v1::Load::kTraction:
      load.kind = SurfaceTraction{read.RequiredVector(field + ".traction.traction",
                                                      message.traction().traction(), {0, 0, 0})};
      break;
    case v1::Load::kPressure:
      load.kind = SurfacePressure{message.pressure().pressure()};
      break;
    case v1::Load::KIND_NOT_SET:
      break;
  }
  for (const v1::LoadKeyframe& from : message.keyframes()) {
    LoadKeyframe& keyframe = load.keyframes.emplace_back();
    keyframe.time = from.time();
    if (from.has_intensity()) keyframe.intensity = from.intensity();
  }
  if (message.has_release()) load.release = OneRelease(message.release());
  return load;
}

Collider ColliderFromMessage(const v1::Collider& message, const std::string& field,
                             const FieldReader& read) {
  Collider collider;
  collider.name = message.name();
  collider.shape = OneShape(field, message, read);
  collider.keyframes = Keyframes(read, field, message.keyframes());
  collider.rotation_center =
      read.Vector(field + ".rotation_center", message.rotation_center(), collider.rotation_center);
  collider.rotation_axis =
      read.Vector(field + ".rotation_axis", message.rotation_axis(), collider.rotation_axis);
  if (message.has_body()) {
    const v1::RigidBody& from = message.body();
    RigidBody& body = collider.body.emplace();
    if (from.has_mass()) body.mass = from.mass();
    if (from.has_density()) body.density = from.density();
    body.velocity = read.Vector(field + ".body.velocity", from.velocity(), body.velocity);
    body.angular_velocity = read.Vector(field + ".body.angular_velocity", from.angular_velocity(),
                                        body.angular_velocity);
  }
  collider.friction = message.friction();
  if (message.has_stiffness()) collider.stiffness = message.stiffness();
  collider.margin = message.margin();
  return collider;
}

}  // namespace cleave
