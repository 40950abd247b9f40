#ifndef CLEAVE_CORE_MESH_MESH_LIMITS_H_
#define CLEAVE_CORE_MESH_MESH_LIMITS_H_

#include <cstdint>

// Every bound that meshes are held to, with its reason.

namespace cleave::limits {

// 6 edge uses a tet are counted in 32 bits, and 64 million tets already ask for about 60 GB.
inline constexpr int64_t kMaxTets = 64'000'000;
inline constexpr int64_t kMaxNodes = 64'000'000;

// A coordinate or length in metres. Above it squares of lengths lose the last float.
inline constexpr double kMaxLength = 1e9;
// Shorter than an atom; the cube of its inverse, which stiffness needs, still fits a float.
inline constexpr double kMinEdgeLength = 1e-12;  // m

// A tet whose volume is below this share of its longest edge cubed is flat: its inverse rest shape
// is rounding error (method note, section 12, item 10).
inline constexpr double kMinTetFlatness = 1e-14;
// A warning from this aspect (tet_geometry.h) on; below it the solver's conditioning does not show.
inline constexpr double kSliverAspect = 100;

}  // namespace cleave::limits

#endif  // CLEAVE_CORE_MESH_MESH_LIMITS_H_
