#ifndef CLEAVE_CLIENT_IO_PREVIEW_PROPS_H_
#define CLEAVE_CLIENT_IO_PREVIEW_PROPS_H_

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/base/vec3.h"
#include "core/picture/shown_surface.h"
#include "core/scene/scene.h"

namespace cleave {

// Where a prop is: a point that the scene puts at X is at rotation * X + translation.
struct PropPlace {
  std::array<double, 4> rotation{1, 0, 0, 0};  // unit quaternion: w, x, y, z
  Vec3 translation{0, 0, 0};                   // m
};

// A rigid thing that pictures show beside the body.
struct Prop {
  std::vector<Vec3> points;                       // m, where the scene puts them
  std::vector<std::array<int32_t, 3>> triangles;  // counter-clockwise from outside
  // By frame number. A frame that is not there takes the place of the last one before it; frames
  // before the first, the scene's.
  std::map<int64_t, PropPlace> places;

  std::vector<Vec3> PointsAt(int64_t frame) const;  // m
};

// The surface of a collider's shape; none for a plane: pictures have a ground of their own.
std::optional<Prop> PropOf(const Shape& shape);

// All props as one surface, for the renderer.
ShownSurface PropsAt(std::span<const Prop> props, int64_t frame);

// Points (m) of props that a camera should hold beside `body` (m, not empty): of props that are no
// larger than the body, wherever they come close to it.
std::vector<Vec3> PropPointsNear(std::span<const Prop> props, std::span<const Vec3> body);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PREVIEW_PROPS_H_
