#include "client/io/preview/scene_look.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/picture/camera.h"
#include "core/scene/selection.h"

namespace cleave {

void ApplySceneLook(const Scene& scene, const TetMesh& mesh, PreviewOptions& options) {
  options.title = scene.name;
  options.camera.up = UpAgainst(scene.gravity);
  options.props.clear();
  for (const Collider& collider : scene.colliders) {
    std::optional<Prop> prop = PropOf(collider.shape);
    if (prop.has_value()) options.props.push_back(*std::move(prop));
  }
  options.regions.clear();
  const std::vector<int32_t> materials = AssignMaterials(scene.materials, mesh, RegionIndex(mesh));
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const int32_t material = materials[static_cast<size_t>(tet)];
    if (material < 0) continue;
    RegionLook& look = options.regions[mesh.region_of(tet)];
    if (!look.label.empty()) continue;
    const std::string& name = scene.materials[static_cast<size_t>(material)].name;
    look.label = name.empty() ? absl::StrCat("material ", material) : name;
    look.slot = material;
  }
}

}  // namespace cleave
