#ifndef CLEAVE_CORE_MESH_WINDING_NUMBER_H_
#define CLEAVE_CORE_MESH_WINDING_NUMBER_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// How often a triangle surface goes round a point: 1 inside and 0 outside a closed one whose
// triangles turn anticlockwise seen from outside, a number between near the holes of an open one.
// Above one half is inside, by which holes are closed smoothly. Parts of the surface that are far
// away count as one small dipole each, which errs by about a hundredth. Immutable; any thread may
// ask. Source: Jacobson, Kavan, Sorkine-Hornung, "Robust inside-outside segmentation using
// generalized winding numbers", 2013; Barill et al., "Fast winding numbers for soups and clouds",
// 2018.
class WindingNumber {
 public:
  // Preconditions: at least one triangle, ids of vertices within range, finite coordinates.
  WindingNumber(const std::vector<Vec3>& vertices,
                const std::vector<std::array<int32_t, 3>>& triangles);

  double At(const Eigen::Vector3d& point) const;

 private:
  using Triangle = std::array<Eigen::Vector3d, 3>;
  // Triangles [begin, end), or the nodes after it and at `right`.
  struct Node {
    Eigen::Vector3d center;                          // of area
    Eigen::Vector3d area = Eigen::Vector3d::Zero();  // m^2, summed normals
    double radius = 0;                               // m, of a ball round `center` that holds all
    int32_t begin = 0;
    int32_t end = 0;
    int32_t right = -1;  // -1: a leaf
  };

  int32_t Build(int32_t begin, int32_t end);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_WINDING_NUMBER_H_
