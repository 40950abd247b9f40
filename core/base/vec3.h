#ifndef CLEAVE_CORE_BASE_VEC3_H_
#define CLEAVE_CORE_BASE_VEC3_H_

#include <array>

namespace cleave {

// Three coordinates of plain data (metres unless a field says otherwise). Code that calculates maps
// it: Eigen::Map<const Eigen::Vector3d>(v.data()); headers that only carry it need no Eigen.
using Vec3 = std::array<double, 3>;

}  // namespace cleave

#endif  // CLEAVE_CORE_BASE_VEC3_H_
