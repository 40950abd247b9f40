#ifndef CLEAVE_CORE_PROBE_MATERIAL_POINT_H_
#define CLEAVE_CORE_PROBE_MATERIAL_POINT_H_

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/material/moduli.h"
#include "core/scene/scene.h"

namespace cleave {

using Matrix9d = Eigen::Matrix<double, 9, 9>;

// What plastic flow has left at a point.
struct PlasticState {
  Eigen::Matrix3d inverse_change = Eigen::Matrix3d::Zero();  // F_p^-1 - I
  double strain = 0;                                         // equivalent plastic strain
};

// How a material answers a deformation gradient.
struct PointResponse {
  double energy = 0;       // J/m^3, elastic
  Eigen::Matrix3d stress;  // first Piola-Kirchhoff, Pa
  // What breaks edges: the derivative of the energy by F_e, Pa, and its part without the fibres.
  // Without plastic flow the former is `stress`.
  Eigen::Matrix3d elastic_stress;
  Eigen::Matrix3d matrix_stress;
};

// A point of a material: its law, its fibres and its flow, from the same headers as in a body.
// Deformation gradients F are given as G = F - I, so that small strains keep their digits.
// Immutable.
class MaterialPoint {
 public:
  // `fibre_directions`: of any length but 0, a family of the material each. Precondition: the
  // material passed CheckMaterial.
  MaterialPoint(const Material& material, std::span<const Vec3> fibre_directions);

  PointResponse Respond(const Eigen::Matrix3d& g, const PlasticState& plastic = {}) const;
  // d2 psi / dF2, Pa, at fixed flow and not projected; entry (3 i + j, 3 k + l) is dP_ij / dF_kl.
  // Where the laws of singular values and turned-over fibres kink, deep in inversion, it is the
  // bounded one that the solver uses.
  Matrix9d Tangent(const Eigen::Matrix3d& g, const PlasticState& plastic = {}) const;
  // Lets the point flow until it is at yield, however long that takes. False where it does not.
  bool Flow(const Eigen::Matrix3d& g, PlasticState& plastic) const;
  // J/m^3, the work that slow flow up to this equivalent plastic strain took.
  double FlowWork(double plastic_strain) const;

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
  std::optional<Plasticity> plasticity_;
};

// F_e - I.
inline Eigen::Matrix3d ElasticChange(const Eigen::Matrix3d& g, const PlasticState& plastic) {
  return g + plastic.inverse_change + g * plastic.inverse_change;
}

}  // namespace cleave

#endif  // CLEAVE_CORE_PROBE_MATERIAL_POINT_H_
