#ifndef CLEAVE_CLIENT_IO_EXPORT_SURFACE_MATERIALS_H_
#define CLEAVE_CLIENT_IO_EXPORT_SURFACE_MATERIALS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/vec3.h"
#include "core/mesh/tet_mesh.h"
#include "core/picture/palette.h"

namespace cleave {

// What a renderer shades alike: the outer faces of a region, or its faces that cracks opened.
struct SurfaceMaterial {
  std::string name;  // outside_crust, inside_7: letters, digits and _ alone
  int32_t region = 0;
  bool inside = false;
  Color color{};  // sRGB
};

// Two a region that some tet has, by ascending region, the outer one first. A region is called by
// its name where the mesh has one, else by its id.
class SurfaceMaterials {
 public:
  explicit SurfaceMaterials(const TetMesh& mesh);

  const std::vector<SurfaceMaterial>& list() const { return list_; }
  // The place in the list. Precondition: some tet has the region.
  size_t IndexOf(int32_t region, bool inside) const { return first_.at(region) + (inside ? 1 : 0); }

 private:
  std::vector<SurfaceMaterial> list_;
  std::map<int32_t, size_t> first_;
};

// Texture coordinates without an unwrapped mesh: the rest shape seen along the axis that a triangle
// faces most, one unit a metre. They stay with the material as it moves, and meet at the edges of
// each direction's area.
size_t FacedAxis(const Vec3& a, const Vec3& b, const Vec3& c);
inline std::array<double, 2> RestUv(const Vec3& rest, size_t axis) {
  return {rest[(axis + 1) % 3], rest[(axis + 2) % 3]};
}

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_EXPORT_SURFACE_MATERIALS_H_
