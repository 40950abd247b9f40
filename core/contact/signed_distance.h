#ifndef CLEAVE_CORE_CONTACT_SIGNED_DISTANCE_H_
#define CLEAVE_CORE_CONTACT_SIGNED_DISTANCE_H_

#include <Eigen/Core>
#include <cstdint>
#include <variant>

#include "core/mesh/surface_distance.h"
#include "core/scene/scene.h"

namespace cleave {

// Signed distance to a shape where the scene puts it. Immutable; any thread may ask.
class ShapeDistance {
 public:
  // Preconditions: ValidateScene holds for the shape.
  explicit ShapeDistance(const Shape& shape);

  SignedDistance At(const Eigen::Vector3d& point) const;

  // A ball round the shape; of a plane the radius is infinite.
  const Eigen::Vector3d& center() const { return center_; }
  double radius() const { return radius_; }

  // How far inside points are at most, m, or a good part of it: what moves less in a step does not
  // come out on the other side.
  double depth() const { return depth_; }

  int64_t bytes() const;

 private:
  struct Plane {
    Eigen::Vector3d normal;
  };
  struct Sphere {};
  struct Box {
    Eigen::Matrix3d axes;  // columns
    Eigen::Vector3d half;  // m
  };

  Eigen::Vector3d center_ = Eigen::Vector3d::Zero();
  double radius_ = 0;
  double depth_ = 0;
  std::variant<Plane, Sphere, Box, SurfaceDistance> shape_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_CONTACT_SIGNED_DISTANCE_H_
