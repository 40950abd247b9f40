#ifndef CLEAVE_CORE_PICTURE_SURFACE_NORMALS_H_
#define CLEAVE_CORE_PICTURE_SURFACE_NORMALS_H_

#include <Eigen/Core>
#include <array>
#include <vector>

#include "core/picture/shown_surface.h"

namespace cleave {

// Of the largest angle between triangles that look as one round surface: 40 degrees.
inline constexpr float kCreaseCosine = 0.766f;

// Normals of the three corners of every triangle, of length 1. A corner takes the area-weighted
// mean over the triangles round its point that lie on the same side of the crack and bend away by
// less than the crease angle (40 degrees), so that round bodies look round and cuts stay sharp. A
// triangle without area has the normal zero.
std::vector<std::array<Eigen::Vector3f, 3>> CornerNormals(const ShownSurface& surface);

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_SURFACE_NORMALS_H_
