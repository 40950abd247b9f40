#ifndef CLEAVE_CORE_DAMAGE_PLASTIC_TET_H_
#define CLEAVE_CORE_DAMAGE_PLASTIC_TET_H_

#include <Eigen/Core>
#include <cstdint>
#include <span>

namespace cleave {

// What plastic flow has made of a tet.
struct PlasticTet {
  Eigen::Matrix3d deformation;  // F_p, determinant 1
  double exhaustion = 0;        // equivalent plastic strain over that at failure; 0 where none is
};

// The ductile tets of a mesh.
struct PlasticTets {
  std::span<const int32_t> record_of;  // a tet each: where in `tets` it is, -1 where it is elastic
  std::span<const PlasticTet> tets;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_DAMAGE_PLASTIC_TET_H_
