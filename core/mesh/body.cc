#include "core/mesh/body.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace cleave {

Body BodyOf(const BoxMesh& shape) {
  Body body;
  body.size = shape.size;
  return body;
}

Body BodyOf(const CylinderMesh& shape) {
  Body body;
  body.round = true;
  body.size[2] = shape.height;
  body.outer_radius = shape.radius;
  return body;
}

Body BodyOf(const TubeMesh& shape) {
  Body body;
  body.round = true;
  body.size[2] = shape.height;
  body.outer_radius = shape.outer_radius;
  body.inner_radius = shape.inner_radius;
  return body;
}

Body BodyOf(const DiscMesh& shape) {
  Body body;
  body.round = true;
  body.size[2] = shape.thickness;
  body.outer_radius = shape.radius;
  body.min_layers = 2;
  return body;
}

double VolumeOf(const Body& body) {
  if (!body.round) return body.size[0] * body.size[1] * body.size[2];
  return std::numbers::pi * body.size[2] *
         (body.outer_radius * body.outer_radius - body.inner_radius * body.inner_radius);
}

int64_t CellsAlong(double length, double cell_size, int64_t fewest) {
  return std::max(fewest, static_cast<int64_t>(std::llround(length / cell_size)));
}

}  // namespace cleave
