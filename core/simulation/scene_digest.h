#ifndef CLEAVE_CORE_SIMULATION_SCENE_DIGEST_H_
#define CLEAVE_CORE_SIMULATION_SCENE_DIGEST_H_

#include <cstdint>

#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// A digest of everything that decides the motion: the mesh and the scene without names of its own,
// frame count, output settings and render mesh, so that a run may be prolonged, encoded or shown
// otherwise.
uint64_t DigestScene(const Scene& scene, const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_SIMULATION_SCENE_DIGEST_H_
