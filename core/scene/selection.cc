#include "core/scene/selection.h"

#include "absl/strings/numbers.h"

namespace cleave {
namespace {

struct Chooser {
  const TetMesh& mesh;
  const RegionIndex& regions;
  std::vector<uint8_t>& chosen;

  template <typename Inside>
  void ByPosition(const Inside& inside) const {
    for (size_t node = 0; node < chosen.size(); ++node) {
      if (inside(mesh.rest_positions[node])) chosen[node] = 1;
    }
  }

  void operator()(std::monostate) const {}
  void operator()(const BoxSelector& box) const {
    ByPosition([&](const Vec3& x) {
      for (size_t axis = 0; axis < 3; ++axis) {
        if (!(x[axis] >= box.min[axis] && x[axis] <= box.max[axis])) return false;
      }
      return true;
    });
  }
  void operator()(const SphereSelector& sphere) const {
    ByPosition([&](const Vec3& x) {
      double squared = 0;
      for (size_t axis = 0; axis < 3; ++axis) {
        const double offset = x[axis] - sphere.center[axis];
        squared += offset * offset;
      }
      return squared <= sphere.radius * sphere.radius;
    });
  }
  void operator()(const PlaneSelector& plane) const {
    ByPosition([&](const Vec3& x) {
      double height = 0;
      for (size_t axis = 0; axis < 3; ++axis) {
        height += (x[axis] - plane.point[axis]) * plane.normal[axis];
      }
      return height >= 0;
    });
  }
  void operator()(const RegionSelector& selector) const {
    const std::optional<int32_t> region = regions.Find(selector.region);
    if (!region.has_value()) return;
    for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
      if (mesh.region_of(tet) != *region) continue;
      for (const int32_t node : mesh.tets[static_cast<size_t>(tet)]) {
        chosen[static_cast<size_t>(node)] = 1;
      }
    }
  }
  void operator()(const IdSelector& selector) const {
    for (const int64_t id : selector.ids) {
      if (id >= 0 && id < mesh.node_count()) chosen[static_cast<size_t>(id)] = 1;
    }
  }
};

}  // namespace

RegionIndex::RegionIndex(const TetMesh& mesh) {
  for (const MeshRegion& region : mesh.regions) by_name_.emplace(region.name, region.id);
  if (mesh.tet_regions.empty()) {
    ids_.insert(0);
    return;
  }
  int32_t last = mesh.tet_regions.front();
  ids_.insert(last);
  for (const int32_t region : mesh.tet_regions) {
    if (region != last) ids_.insert(region);
    last = region;
  }
}

std::optional<int32_t> RegionIndex::Find(absl::string_view name_or_id) const {
  const auto named = by_name_.find(std::string(name_or_id));
  if (named != by_name_.end()) return named->second;
  int32_t id = 0;
  if (absl::SimpleAtoi(name_or_id, &id) && ids_.count(id) > 0) return id;
  return std::nullopt;
}

std::vector<int32_t> SelectNodes(const NodeSet& set, const TetMesh& mesh,
                                 const RegionIndex& regions) {
  std::vector<uint8_t> chosen(static_cast<size_t>(mesh.node_count()), 0);
  for (const Selector& selector : set.select) std::visit(Chooser{mesh, regions, chosen}, selector);
  std::vector<int32_t> nodes;
  for (size_t node = 0; node < chosen.size(); ++node) {
    if (chosen[node] != 0) nodes.push_back(static_cast<int32_t>(node));
  }
  return nodes;
}

std::vector<int32_t> AssignMaterials(const std::vector<Material>& materials, const TetMesh& mesh,
                                     const RegionIndex& regions) {
  int32_t everywhere = -1;
  std::map<int32_t, int32_t> by_region;  // only materials later than `everywhere`
  for (size_t material = 0; material < materials.size(); ++material) {
    const auto index = static_cast<int32_t>(material);
    if (materials[material].regions.empty()) {
      everywhere = index;
      by_region.clear();
    }
    for (const std::string& name : materials[material].regions) {
      if (const auto region = regions.Find(name)) by_region[*region] = index;
    }
  }
  std::vector<int32_t> material_of(static_cast<size_t>(mesh.tet_count()), everywhere);
  if (by_region.empty()) return material_of;
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const auto found = by_region.find(mesh.region_of(tet));
    if (found != by_region.end()) material_of[static_cast<size_t>(tet)] = found->second;
  }
  return material_of;
}

}  // namespace cleave
