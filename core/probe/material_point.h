#ifndef CLEAVE_CORE_PROBE_MATERIAL_POINT_H_
#define CLEAVE_CORE_PROBE_MATERIAL_POINT_H_

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/material/moduli.h"
#include "core/scene/scene.h"

namespace cleave {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

// How a material answers a deformation gradient.
struct PointResponse {
  double energy = 0;              // J/m^3
  Eigen::Matrix3d stress;         // first Piola-Kirchhoff, Pa
  Eigen::Matrix3d matrix_stress;  // the part without the fibres
};

// A point of a material: its law and its fibres, from the same headers as in a body. Deformation
// gradients F are given as G = F - I, so that small strains keep their digits. Immutable.
class MaterialPoint {
 public:
  // `fibre_directions`: of any length but 0, a family of the material each. Precondition: the
  // material passed CheckMaterial.
  MaterialPoint(const Material& material, std::span<const Vec3> fibre_directions);

  PointResponse Respond(const Eigen::Matrix3d& g) const;
  // d2 psi / dF2, Pa, not projected; entry (3 i + j, 3 k + l) is dP_ij / dF_kl. Where the laws of
  // singular values and turned-over fibres kink, deep in inversion, it is the bounded one that the
  // solver uses.
  Matrix9d Tangent(const Eigen::Matrix3d& g) const;

  struct Fibre {
    Eigen::Vector3d direction;  // unit
    double stiffness;           // Pa
    double strength_ratio;
  };
  std::span<const Fibre> fibres() const { return fibres_; }

 private:
  ElasticLaw law_;
  LameConstants<double> lame_;
  std::vector<Fibre> fibres_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_PROBE_MATERIAL_POINT_H_
