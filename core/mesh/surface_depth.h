#ifndef CLEAVE_CORE_MESH_SURFACE_DEPTH_H_
#define CLEAVE_CORE_MESH_SURFACE_DEPTH_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/plane_grid.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// How deep points lie below the surface that one sees looking along a direction from far away.
// Immutable; any thread may ask.
class SurfaceDepth {
 public:
  // Preconditions: the mesh passed CheckMesh; `direction` is finite and not 0, of any length.
  SurfaceDepth(const TetMesh& mesh, const Vec3& direction);

  // m, along the direction from the first surface over or at the point; 0 where there is none.
  double At(const Vec3& point) const;

 private:
  const Vec3 direction_;
  const PlaneView view_;
  double margin_ = 0;  // m, above the rounding of places in the plane
  std::vector<std::array<Vec3, 3>> faces_;
  PlaneGrid grid_{{}};
};

// m, above what PlaneView rounds places of the mesh's size by.
double ViewMargin(const TetMesh& mesh);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_SURFACE_DEPTH_H_
