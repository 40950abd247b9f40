#ifndef CLEAVE_CORE_MESH_TRIANGLE_HALVES_H_
#define CLEAVE_CORE_MESH_TRIANGLE_HALVES_H_

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

namespace cleave {

// For trees of triangles: orders [begin, end) so that no centre of the first half lies behind one
// of the second along the longest side of the box that holds them; returns where the second begins.
// `corners_of` gives the three corners of an element, m; `extent` is the box's, m.
template <typename Triangle, typename CornersOf>
int32_t SplitInHalves(const Eigen::Vector3d& extent, int32_t begin, int32_t end,
                      std::vector<Triangle>& triangles, CornersOf corners_of) {
  int axis = 0;
  extent.maxCoeff(&axis);
  const int32_t middle = begin + (end - begin) / 2;
  const auto place = [&](const Triangle& triangle) {
    const auto& corners = corners_of(triangle);
    return corners[0][axis] + corners[1][axis] + corners[2][axis];
  };
  std::nth_element(triangles.begin() + begin, triangles.begin() + middle, triangles.begin() + end,
                   [&](const Triangle& a, const Triangle& b) { return place(a) < place(b); });
  return middle;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_TRIANGLE_HALVES_H_
