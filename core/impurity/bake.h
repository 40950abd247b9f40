#ifndef CLEAVE_CORE_IMPURITY_BAKE_H_
#define CLEAVE_CORE_IMPURITY_BAKE_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// What the impurities of a scene come to on a mesh.
struct BakedImpurities {
  std::vector<double> potencies;  // alpha, a node each
  // w, what thresholds count, an edge each, [0, infinity]; empty where no layer weakens.
  std::vector<double> edge_factors;
  std::vector<uint8_t> touched_edges;  // an edge each: 1 where a layer marks it or weakens it
};

// Map, noise and layers, one over the other. `mesh` is in the client's order; `edges` are pairs of
// its nodes, in any order, each once. Preconditions: the scene has impurities and passed validation
// with the mesh.
BakedImpurities BakeImpurities(const Scene& scene, const TetMesh& mesh,
                               std::span<const std::array<int32_t, 2>> edges);

}  // namespace cleave

#endif  // CLEAVE_CORE_IMPURITY_BAKE_H_
