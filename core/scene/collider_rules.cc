#include "core/scene/collider_rules.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/scene/checker.h"
#include "core/scene/keyframe_rules.h"
#include "core/scene/limits.h"

namespace cleave {
namespace {

Vec3 Minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double Dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

struct ShapeRules {
  std::string field;
  Faults& faults;
  Checker& check;

  void operator()(std::monostate) const {
    faults.Error(field, "names no shape; one of plane, sphere, box, surface is required");
  }
  void operator()(const PlaneShape& plane) const {
    check.Coordinates(field + ".plane.point", plane.point);
    check.Direction(field + ".plane.normal", plane.normal);
  }
  void operator()(const SphereShape& sphere) const {
    check.Coordinates(field + ".sphere.center", sphere.center);
    check.Above(field + ".sphere.radius", sphere.radius, 0, limits::kMaxLength);
  }
  void operator()(const BoxShape& box) const {
    check.Coordinates(field + ".box.center", box.center);
    for (size_t axis = 0; axis < 3; ++axis) {
      check.Above(absl::StrCat(field, ".box.size[", axis, "]"), box.size[axis], 0,
                  limits::kMaxLength);
    }
    check.Direction(field + ".box.rotation_axis", box.rotation_axis);
    check.Within(field + ".box.rotation", box.rotation, -limits::kMaxLength, limits::kMaxLength);
  }
  void operator()(const SurfaceShape& surface) const {
    const std::string at = field + ".surface";
    if (!surface.file.empty()) {
      faults.Error(at + ".file", absl::StrCat("\"", surface.file.substr(0, limits::kMaxNameBytes),
                                              "\" is a path of the client; send what it holds as "
                                              "vertices and triangles"));
      return;
    }
    if (!check.List(at + ".triangles", surface.triangles.size(), limits::kMaxColliderTriangles) ||
        !check.List(at + ".vertices", surface.vertices.size(), 3 * limits::kMaxColliderTriangles)) {
      return;
    }
    if (surface.triangles.empty()) faults.Error(at + ".triangles", "is empty");
    for (size_t k = 0; k < surface.vertices.size(); ++k)
      check.Coordinates(At(at + ".vertices", k), surface.vertices[k]);
    if (!faults.ok()) return;
    CheckTriangles(at + ".triangles", surface);
  }

  void CheckTriangles(const std::string& at, const SurfaceShape& surface) const {
    const auto count = static_cast<int32_t>(surface.vertices.size());
    // Edges as (from, to), triangle.
    std::vector<std::pair<std::pair<int32_t, int32_t>, size_t>> edges;
    double volume = 0;
    bool whole = true;
    for (size_t k = 0; k < surface.triangles.size(); ++k) {
      const auto& corners = surface.triangles[k];
      bool known = true;
      for (const int32_t corner : corners) {
        if (corner >= 0 && corner < count) continue;
        faults.Error(At(at, k), absl::StrCat(corner, " is outside [0, ", count - 1, "]"));
        known = false;
      }
      whole = whole && known;
      if (!known) continue;
      const Vec3& a = surface.vertices[static_cast<size_t>(corners[0])];
      const Vec3 ab = Minus(surface.vertices[static_cast<size_t>(corners[1])], a);
      const Vec3 ac = Minus(surface.vertices[static_cast<size_t>(corners[2])], a);
      const Vec3 normal = Cross(ab, ac);
      if (!(Dot(normal, normal) > 0)) {
        faults.Error(At(at, k), "has no area");
        whole = false;
        continue;
      }
      volume += Dot(Minus(a, surface.vertices[0]), normal) / 6;
      for (size_t i = 0; i < 3; ++i) edges.push_back({{corners[i], corners[(i + 1) % 3]}, k});
    }
    if (!whole) return;
    std::sort(edges.begin(), edges.end());
    const auto count_of = [&](int32_t from, int32_t to) {
      const auto first = std::lower_bound(edges.begin(), edges.end(),
                                          std::make_pair(std::make_pair(from, to), size_t{0}));
      auto last = first;
      while (last != edges.end() && last->first == std::make_pair(from, to)) ++last;
      return last - first;
    };
    for (const auto& [edge, triangle] : edges) {
      const auto& [from, to] = edge;
      if (count_of(from, to) == 1 && count_of(to, from) == 1) continue;
      faults.Error(at, absl::StrCat("the surface is not closed: the edge from vertex ", from,
                                    " to vertex ", to, " of triangle ", triangle, " has ",
                                    count_of(to, from), " that run the other way, and ",
                                    count_of(from, to), " like it; one of each is required"));
      return;
    }
    if (!(volume > 0)) {
      faults.Error(at, absl::StrCat("the surface encloses ", volume,
                                    " m^3: turn its triangles to be counterclockwise seen from "
                                    "outside"));
    }
  }
};

void CheckBody(const std::string& field, const Collider& collider, Faults& faults, Checker& check) {
  const RigidBody& body = *collider.body;
  if (std::holds_alternative<PlaneShape>(collider.shape))
    faults.Error(field, "a plane has no mass: it rests or follows keyframes");
  if (!collider.keyframes.empty())
    faults.Error(field, "the collider follows keyframes already; give one of both");
  if (body.mass.has_value() == body.density.has_value())
    faults.Error(field, "needs either mass or density");
  if (body.mass.has_value()) check.Above(field + ".mass", *body.mass, 0, limits::kMaxColliderMass);
  if (body.density.has_value())
    check.Above(field + ".density", *body.density, 0, limits::kMaxDensity);
  check.Coordinates(field + ".velocity", body.velocity);
  check.Coordinates(field + ".angular_velocity", body.angular_velocity);
}

}  // namespace

void CheckContact(const Scene& scene, Faults& faults) {
  if (!scene.contact.has_value()) return;
  Checker check(faults);
  check.Within("contact.stiffness", scene.contact->stiffness, limits::kMinContactStiffness,
               limits::kMaxContactStiffness);
  check.Within("contact.friction", scene.contact->friction, 0, limits::kMaxFriction);
}

void CheckSleep(const Scene& scene, Faults& faults) {
  if (!scene.sleep.has_value()) return;
  Checker check(faults);
  check.Above("sleep.speed", scene.sleep->speed, 0, limits::kMaxSleepSpeed);
  check.Above("sleep.time", scene.sleep->time, 0, limits::kMaxSleepSeconds);
}

void CheckColliders(const Scene& scene, Faults& faults) {
  Checker check(faults);
  if (!check.List("colliders", scene.colliders.size(), limits::kMaxColliders)) return;
  std::set<std::string> names;
  for (size_t i = 0; i < scene.colliders.size(); ++i) {
    const Collider& collider = scene.colliders[i];
    const auto at = [&](absl::string_view field) { return At("colliders", i, field); };
    check.Name(at("name"), collider.name, false);
    if (!collider.name.empty() && !names.insert(collider.name).second)
      faults.Error(at("name"), absl::StrCat("\"", collider.name, "\" is taken"));
    Faults of_shape;
    Checker shape_check(of_shape);
    std::visit(ShapeRules{At("colliders", i), of_shape, shape_check}, collider.shape);
    faults.Append("", of_shape);
    CheckKeyframes(at("keyframes"), collider.keyframes, faults);
    check.Coordinates(at("rotation_center"), collider.rotation_center);
    check.Direction(at("rotation_axis"), collider.rotation_axis);
    if (collider.body.has_value()) CheckBody(at("body"), collider, faults, check);
    check.Within(at("friction"), collider.friction, 0, limits::kMaxFriction);
    check.Within(at("stiffness"), collider.stiffness, limits::kMinContactStiffness,
                 limits::kMaxContactStiffness);
    check.Within(at("margin"), collider.margin, 0, limits::kMaxLength);
  }
}

}  // namespace cleave
