#include "core/scene/collider_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/scene/validate.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;

SurfaceShape Pyramid() {
  return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

Scene WithCollider(const Shape& shape) {
  Scene scene;
  scene.colliders.emplace_back().shape = shape;
  return scene;
}

Faults Check(const Scene& scene) {
  Faults faults;
  CheckColliders(scene, faults);
  return faults;
}

TEST(ColliderRules, EveryShapeIsAcceptedAtRestAndMoving) {
  Scene scene = WithCollider(PlaneShape{});
  for (const Shape& shape : {Shape(SphereShape{{0, 0, 0}, 1}),
                             Shape(BoxShape{{0, 0, 0}, {1, 1, 1}}), Shape(Pyramid())}) {
    Collider& collider = scene.colliders.emplace_back();
    collider.shape = shape;
    collider.body.emplace().density = 1000;
  }
  scene.colliders[0].keyframes = {{0, {0, 0, 0}, 0}, {1, {0, 0, 1}, 3}};
  EXPECT_TRUE(Check(scene).ok()) << Check(scene).ToStatus();
}

TEST(ColliderRules, NameTheFieldOfEveryKindOfFault) {
  struct Case {
    const char* expected;
    std::function<void(Collider&)> spoil;
  };
  const auto shape = [](const Shape& s) { return [s](Collider& c) { c.shape = s; }; };
  const std::vector<Case> cases = {
      {"colliders[0]: names no shape", shape(std::monostate{})},
      {"colliders[0].plane.normal: [0, 0, 0] has no direction",
       shape(PlaneShape{{0, 0, 0}, {0, 0, 0}})},
      {"colliders[0].plane.point[1]: nan", shape(PlaneShape{{0, NAN, 0}, {0, 0, 1}})},
      {"colliders[0].sphere.radius: 0 is outside", shape(SphereShape{{0, 0, 0}, 0})},
      {"colliders[0].box.size[2]: -1 is outside", shape(BoxShape{{0, 0, 0}, {1, 1, -1}})},
      {"colliders[0].box.rotation_axis", shape(BoxShape{{0, 0, 0}, {1, 1, 1}, {0, 0, 0}, 1})},
      {"colliders[0].surface.triangles: is empty", shape(SurfaceShape{{{0, 0, 0}}, {}})},
      {"colliders[0].surface.file: \"ball.obj\" is a path of the client",
       shape(SurfaceShape{{}, {}, "ball.obj"})},
      {"colliders[0].keyframes[1].time: 0 s is not after",
       [](Collider& c) {
         c.keyframes = {{0, {0, 0, 0}, 0}, {0, {1, 0, 0}, 0}};
       }},
      {"colliders[0].rotation_axis",
       [](Collider& c) {
         c.rotation_axis = {0, 0, 0};
       }},
      {"colliders[0].body: a plane has no mass",
       [](Collider& c) {
         c.shape = PlaneShape{};
         c.body.emplace().mass = 1;
       }},
      {"colliders[0].body: needs either mass or density", [](Collider& c) { c.body.emplace(); }},
      {"colliders[0].body.density: -1", [](Collider& c) { c.body.emplace().density = -1; }},
      {"colliders[0].body: the collider follows keyframes",
       [](Collider& c) {
         c.body.emplace().mass = 1;
         c.keyframes = {{0, {0, 0, 0}, 0}};
       }},
      {"colliders[0].friction: -0.1", [](Collider& c) { c.friction = -0.1; }},
      {"colliders[0].stiffness: 0 is outside", [](Collider& c) { c.stiffness = 0; }},
      {"colliders[0].margin: nan", [](Collider& c) { c.margin = NAN; }},
  };
  for (const Case& one : cases) {
    Scene scene = WithCollider(SphereShape{{0, 0, 0}, 1});
    one.spoil(scene.colliders[0]);
    EXPECT_THAT(Check(scene).ToStatus().message(), HasSubstr(one.expected));
  }
}

TEST(ColliderRules, AnOpenSurfaceIsRefusedByItsEdge) {
  SurfaceShape surface = Pyramid();
  surface.triangles.pop_back();
  EXPECT_THAT(Check(WithCollider(surface)).ToStatus().message(),
              HasSubstr("colliders[0].surface.triangles: the surface is not closed: the edge from "
                        "vertex"));
  surface = Pyramid();
  std::swap(surface.triangles[3][0], surface.triangles[3][1]);
  EXPECT_THAT(Check(WithCollider(surface)).ToStatus().message(), HasSubstr("not closed"));
}

TEST(ColliderRules, ASurfaceThatFacesInwardsIsRefused) {
  SurfaceShape surface = Pyramid();
  for (auto& triangle : surface.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_THAT(Check(WithCollider(surface)).ToStatus().message(), HasSubstr("encloses -0.16"));
}

TEST(ColliderRules, TrianglesOfNoAreaOrUnknownVerticesAreNamed) {
  SurfaceShape surface = Pyramid();
  surface.triangles[1] = {0, 1, 1};
  surface.triangles[2] = {0, 3, 9};
  const Faults faults = Check(WithCollider(surface));
  EXPECT_THAT(faults.ToStatus().message(), HasSubstr("triangles[1]: has no area"));
  EXPECT_THAT(faults.ToStatus().message(), HasSubstr("triangles[2]: 9 is outside [0, 3]"));
}

TEST(ContactRules, NameEachFieldThatIsOutOfRange) {
  Scene scene;
  scene.contact = Contact{0, -1};
  Faults faults;
  CheckContact(scene, faults);
  EXPECT_THAT(faults.ToStatus().message(),
              HasSubstr("contact.stiffness: 0 is outside [0.01, 1000]"));
  EXPECT_THAT(faults.ToStatus().message(), HasSubstr("contact.friction: -1 is outside [0, 10]"));
}

TEST(SleepRules, NameEachFieldThatIsOutOfRange) {
  Scene scene;
  scene.sleep.emplace();
  EXPECT_TRUE(ValidateScene(scene).ToStatus().message().find("sleep") == std::string::npos);
  scene.sleep = Sleep{0, INFINITY};
  const auto message = std::string(ValidateScene(scene).ToStatus().message());
  EXPECT_THAT(message, HasSubstr("sleep.speed: 0 is outside (0, 1]"));
  EXPECT_THAT(message, HasSubstr("sleep.time: inf is outside (0, 3600]"));
}

TEST(ColliderRules, TwoCollidersOfOneNameAreRefused) {
  Scene scene = WithCollider(PlaneShape{});
  scene.colliders[0].name = "floor";
  scene.colliders.push_back(scene.colliders[0]);
  EXPECT_THAT(Check(scene).ToStatus().message(),
              HasSubstr("colliders[1].name: \"floor\" is taken"));
}

}  // namespace
}  // namespace cleave
