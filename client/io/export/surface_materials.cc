#include "client/io/export/surface_materials.h"

#include <cmath>
#include <set>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"

namespace cleave {
namespace {

// What every format takes as a name.
std::string PlainName(const std::string& name) {
  std::string plain = name;
  for (char& letter : plain) {
    if (!absl::ascii_isalnum(static_cast<unsigned char>(letter))) letter = '_';
  }
  return plain;
}

}  // namespace

SurfaceMaterials::SurfaceMaterials(const TetMesh& mesh) {
  std::set<int32_t> regions(mesh.tet_regions.begin(), mesh.tet_regions.end());
  if (mesh.tet_regions.empty()) regions.insert(0);
  std::set<std::string> taken;
  for (const int32_t region : regions) {
    std::string name = absl::StrCat(region);
    for (const MeshRegion& named : mesh.regions) {
      if (named.id == region && !named.name.empty()) name = PlainName(named.name);
    }
    // Two names may be alike once they are plain.
    if (!taken.insert(name).second) taken.insert(name = absl::StrCat(name, "_", region));
    first_[region] = list_.size();
    list_.push_back({absl::StrCat("outside_", name), region, false, RegionColor(region)});
    list_.push_back({absl::StrCat("inside_", name), region, true, InsideColor(region)});
  }
}

size_t FacedAxis(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Vec3 v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const Vec3 normal{std::abs(u[1] * v[2] - u[2] * v[1]), std::abs(u[2] * v[0] - u[0] * v[2]),
                    std::abs(u[0] * v[1] - u[1] * v[0])};
  if (normal[2] >= normal[0] && normal[2] >= normal[1]) return 2;
  return normal[0] >= normal[1] ? 0 : 1;
}

}  // namespace cleave
