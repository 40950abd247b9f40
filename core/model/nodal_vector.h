#ifndef CLEAVE_CORE_MODEL_NODAL_VECTOR_H_
#define CLEAVE_CORE_MODEL_NODAL_VECTOR_H_

#include <vector>

#include "core/base/double4.h"
#include "core/base/vec3.h"

namespace cleave {

// A vector for every node, by the solver's node ids: x, y, z and a lane that holds 0.
using NodalVector = std::vector<Double4>;

inline Double4 ToDouble4(const Vec3& v) { return Double4{v[0], v[1], v[2], 0}; }
inline Vec3 ToVec3(Double4 v) { return {v[0], v[1], v[2]}; }

}  // namespace cleave

#endif  // CLEAVE_CORE_MODEL_NODAL_VECTOR_H_
