#ifndef CLEAVE_CORE_SCENE_IMPURITY_REACH_H_
#define CLEAVE_CORE_SCENE_IMPURITY_REACH_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/base/faults.h"
#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// The edges of all tets, each once.
std::vector<std::array<int32_t, 2>> EdgesOfTets(const TetMesh& mesh);

// Names what of layer `k` is nowhere on the body, as of something in another unit or finer than
// the mesh: every stroke that crosses no edge and whose groove holds none; a pattern, bands,
// pockets or a painted surface where none of it meets the body; and any of them where no node that
// it reaches is in the layer's set. `edges` are those of the mesh. Preconditions: CheckImpurities
// finds no error in the layer; the mesh passed CheckMesh.
void CheckReach(const Scene& scene, size_t k, const TetMesh& mesh,
                std::span<const std::array<int32_t, 2>> edges, Faults& faults);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_IMPURITY_REACH_H_
