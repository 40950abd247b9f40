#ifndef CLEAVE_CORE_CONTACT_RIGID_BODY_H_
#define CLEAVE_CORE_CONTACT_RIGID_BODY_H_

#include <Eigen/Core>

#include "core/scene/scene.h"

namespace cleave {

// Of a shape that is filled evenly.
struct MassProperties {
  double mass = 0;          // kg
  Eigen::Vector3d center;   // m, of mass
  Eigen::Matrix3d axes;     // principal ones, columns, right-handed
  Eigen::Vector3d moments;  // kg m^2 about them
};

// Preconditions: ValidateScene holds for a collider with this shape and body.
MassProperties MassOf(const Shape& shape, const RigidBody& body);

// The rotation about `vector` by its length, rad.
Eigen::Matrix3d RotationBy(const Eigen::Vector3d& vector);

// How the rotation by a vector turns when the vector changes: a change d of it turns the rotated
// frame by RotationChange(vector) * d, in space.
Eigen::Matrix3d RotationChange(const Eigen::Vector3d& vector);

// The matrix of v x .
Eigen::Matrix3d CrossMatrix(const Eigen::Vector3d& v);

}  // namespace cleave

#endif  // CLEAVE_CORE_CONTACT_RIGID_BODY_H_
