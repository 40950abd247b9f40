#include "core/mesh/reorder.h"

#include <algorithm>
#include <utility>

#include "core/mesh/morton.h"

namespace cleave {
namespace {

// Fills `old_of_new` and its inverse by ascending code(id).
template <typename CodeOf>
void SortByCode(int64_t count, const CodeOf& code_of, std::vector<int32_t>& old_of_new,
                std::vector<int32_t>& new_of_old) {
  std::vector<std::pair<uint64_t, int32_t>> codes(static_cast<size_t>(count));
  for (int64_t id = 0; id < count; ++id)
    codes[static_cast<size_t>(id)] = {code_of(id), static_cast<int32_t>(id)};
  std::sort(codes.begin(), codes.end());
  old_of_new.resize(codes.size());
  new_of_old.resize(codes.size());
  for (size_t position = 0; position < codes.size(); ++position) {
    old_of_new[position] = codes[position].second;
    new_of_old[static_cast<size_t>(codes[position].second)] = static_cast<int32_t>(position);
  }
}

}  // namespace

MeshOrder LocalityOrder(const TetMesh& mesh) {
  const MortonCurve curve(mesh.rest_positions);
  MeshOrder order;
  SortByCode(
      mesh.node_count(),
      [&](int64_t node) { return curve.CodeOf(mesh.rest_positions[static_cast<size_t>(node)]); },
      order.old_node, order.new_node);
  SortByCode(
      mesh.tet_count(),
      [&](int64_t tet) {
        Vec3 centroid{0, 0, 0};
        for (const int32_t node : mesh.tets[static_cast<size_t>(tet)]) {
          for (size_t axis = 0; axis < 3; ++axis)
            centroid[axis] += mesh.rest_positions[static_cast<size_t>(node)][axis] / 4;
        }
        return curve.CodeOf(centroid);
      },
      order.old_tet, order.new_tet);
  return order;
}

TetMesh Reordered(const TetMesh& mesh, const MeshOrder& order) {
  TetMesh result;
  result.regions = mesh.regions;
  result.rest_positions.reserve(mesh.rest_positions.size());
  for (const int32_t node : order.old_node)
    result.rest_positions.push_back(mesh.rest_positions[static_cast<size_t>(node)]);
  result.tets.reserve(mesh.tets.size());
  for (const int32_t tet : order.old_tet) {
    std::array<int32_t, 4> nodes = mesh.tets[static_cast<size_t>(tet)];
    for (int32_t& node : nodes) node = order.new_node[static_cast<size_t>(node)];
    result.tets.push_back(nodes);
    if (!mesh.tet_regions.empty())
      result.tet_regions.push_back(mesh.tet_regions[static_cast<size_t>(tet)]);
  }
  return result;
}

}  // namespace cleave
