#include "core/mesh/reorder.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace cleave {
namespace {

// The low 21 bits of `x`, two zero bits between each.
uint64_t Spread(uint64_t x) {
  x &= 0x1FFFFF;
  x = (x | x << 32) & 0x1F00000000FFFFu;
  x = (x | x << 16) & 0x1F0000FF0000FFu;
  x = (x | x << 8) & 0x100F00F00F00F00Fu;
  x = (x | x << 4) & 0x10C30C30C30C30C3u;
  x = (x | x << 2) & 0x1249249249249249u;
  return x;
}

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
  Vec3 low;
  Vec3 high;
  low.fill(std::numeric_limits<double>::infinity());
  high.fill(-std::numeric_limits<double>::infinity());
  for (const Vec3& p : mesh.rest_positions) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  const double side = std::max(
      {high[0] - low[0], high[1] - low[1], high[2] - low[2], std::numeric_limits<double>::min()});
  const auto code_of = [&](const Vec3& p) {
    uint64_t code = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double cell = (p[axis] - low[axis]) / side * 0x1FFFFF;
      code |= Spread(static_cast<uint64_t>(std::clamp(cell, 0.0, double{0x1FFFFF}))) << axis;
    }
    return code;
  };

  MeshOrder order;
  SortByCode(
      mesh.node_count(),
      [&](int64_t node) { return code_of(mesh.rest_positions[static_cast<size_t>(node)]); },
      order.old_node, order.new_node);
  SortByCode(
      mesh.tet_count(),
      [&](int64_t tet) {
        Vec3 centroid{0, 0, 0};
        for (const int32_t node : mesh.tets[static_cast<size_t>(tet)]) {
          for (size_t axis = 0; axis < 3; ++axis)
            centroid[axis] += mesh.rest_positions[static_cast<size_t>(node)][axis] / 4;
        }
        return code_of(centroid);
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
