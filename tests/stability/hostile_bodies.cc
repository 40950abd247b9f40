#include "tests/stability/hostile_input.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/solver/test_scene.h"

namespace cleave {

HostileBody FreeCube() {
  HostileBody body;
  body.scene = TightScene(1e5, 0.3, 1000, 0.01);
  body.scene.quality = Quality{};
  body.scene.mesh.source = MeshAsset{std::string(64, '0')};
  body.scene.gravity = Vec3{0, 0, -9.81};
  body.mesh = KuhnBox({3, 3, 3}, {1, 1, 1});
  return body;
}

HostileBody SoftCube() {
  HostileBody body = FreeCube();
  AddBoxSet(body.scene, "floor", {-1e9, -1e9, -1e9}, {1e9, 1e9, 1e-12});
  AddMotion(body.scene, "floor");
  return body;
}

HostileBody CrushedCube(double depth) {
  HostileBody body = SoftCube();
  body.scene.materials[0].youngs_modulus = 1e6;
  body.scene.quality.newton_iterations = 100;
  AddBoxSet(body.scene, "lid", {-1, -1, 1 - 1e-9}, {2, 2, 2});
  AddMotion(body.scene, "lid").keyframes = {{0, {0, 0, 0}, 0}, {0.2, {0, 0, -depth}, 0}};
  return body;
}

}  // namespace cleave
