#ifndef CLEAVE_TESTS_UNIT_CORE_SURFACE_FINE_BOX_H_
#define CLEAVE_TESTS_UNIT_CORE_SURFACE_FINE_BOX_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/mesh/render_mesh.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"
#include "tests/unit/core/surface/surface_checks.h"

namespace cleave {

// The boundary of a box of finer cells, its points moved by `place`.
template <typename Place>
RenderMesh FineBox(std::array<int, 3> cells, const Vec3& size, const Place& place) {
  const SurfaceCase box(KuhnBox(cells, size));
  const SurfaceTopology surface = ExtractSurface(box.mesh, box.incidence, box.faces, {}, {});
  RenderMesh render;
  for (const SurfacePoint& point : surface.points) render.points.push_back(place(point.rest));
  render.triangles = surface.triangles;
  for (const auto& triangle : render.triangles) {
    CornerUvs uvs{};
    for (size_t k = 0; k < 3; ++k) {
      const Vec3& at = surface.points[static_cast<size_t>(triangle[k])].rest;
      uvs[k] = {static_cast<float>(at[0]), static_cast<float>(at[1])};
    }
    render.uvs.push_back(uvs);
  }
  return render;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_SURFACE_FINE_BOX_H_
