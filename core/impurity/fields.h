#ifndef CLEAVE_CORE_IMPURITY_FIELDS_H_
#define CLEAVE_CORE_IMPURITY_FIELDS_H_

#include <cstdint>
#include <vector>

#include "core/mesh/tet_mesh.h"
#include "core/scene/impurities.h"

namespace cleave {

// Sources that fill space: a value for every node of the mesh. `layer` is the one that the source
// is of. All are pure functions of their arguments; nodes count by the client's ids.

// Random numbers of mean 0 and variance 1. Correlated ones follow from places alone, so that finer
// meshes see the same field: a sum of 256 waves whose numbers are normal, which is a Gaussian field
// of the covariance exp(-r^2 / (2 length^2)) in the limit; uniform ones are its quantiles. Source:
// Shinozuka and Deodatis, "Simulation of stochastic processes by spectral representation", 1991.
std::vector<double> NoiseValues(const NoiseField& field, uint64_t seed, const TetMesh& mesh);

// Shares.
std::vector<double> BandShares(const BandField& field, const ImpurityLayer& layer,
                               const TetMesh& mesh);
// Centres are spread evenly over the volume of the body.
std::vector<double> PocketShares(const PocketField& field, const ImpurityLayer& layer,
                                 uint64_t seed, const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_IMPURITY_FIELDS_H_
