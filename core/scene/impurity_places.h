#ifndef CLEAVE_CORE_SCENE_IMPURITY_PLACES_H_
#define CLEAVE_CORE_SCENE_IMPURITY_PLACES_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/mesh/tet_mesh.h"
#include "core/scene/scene.h"

namespace cleave {

// Where sources that fill space are. Preconditions: CheckImpurities finds no error in the layer.

// What the random numbers of a layer come from: apart from the scene's own and from other layers'.
uint64_t LayerSeed(const Scene& scene, size_t layer);

// How far every node is outside the nearest band, m; 0 or less inside.
std::vector<double> DistancesOutside(const BandField& bands, const TetMesh& mesh);

// The same of balls round centres that are spread evenly over the volume of the body; infinite for
// some or all nodes beyond `reach` (m), and of nodes inside any number that is not above 0.
std::vector<double> DistancesOutside(const PocketField& pockets, double reach, uint64_t seed,
                                     const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_SCENE_IMPURITY_PLACES_H_
