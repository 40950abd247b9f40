#ifndef CLEAVE_CORE_PICTURE_CAMERA_H_
#define CLEAVE_CORE_PICTURE_CAMERA_H_

#include <optional>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/faults.h"
#include "core/base/vec3.h"

namespace cleave {

// A pinhole camera above a ground plane. The three axes are orthogonal and of length 1.
struct Camera {
  Vec3 position{0, 0, 0};  // m
  Vec3 right{1, 0, 0};
  Vec3 up{0, 0, 1};
  Vec3 forward{0, 1, 0};
  double half_width = 0.2;  // tangents of half the angles of view
  double half_height = 0.15;
  Vec3 scene_center{0, 0, 0};   // m
  double scene_radius = 1;      // m, of a ball that holds what is framed
  Vec3 ground_normal{0, 0, 1};  // the scene's up
  double ground_height = 0;     // m, along the normal: the lowest point that is framed
};

// Where to look from; angles in degrees.
struct CameraOptions {
  // The scene's up, any length but 0. Absent: chosen so that a long body lies and a plate lies
  // flat.
  std::optional<Vec3> up;
  std::optional<double> azimuth;  // from the view square to the longest axis; default 20 to 32
  std::optional<double>
      elevation;         // above the ground, in (-89, 89); default by the body's flatness
  double margin = 0.08;  // free part of the picture at each side, in [0, 0.45]
};

// Where a scene's up is: against gravity (m/s^2), absent without it.
std::optional<Vec3> UpAgainst(const std::optional<Vec3>& gravity);

// What is wrong with options, by the names of their fields.
Faults CheckCameraOptions(const CameraOptions& options);

// The closest camera of the default lens that holds all `points` (m), usually the points of all
// frames. `aspect` is width by height. Errors: InvalidArgument for no points, NaN or bad options.
absl::StatusOr<Camera> FrameCamera(std::span<const Vec3> points, double aspect,
                                   const CameraOptions& options);

// The camera gone round the scene's middle by an angle (rad), about the scene's up.
Camera Turned(const Camera& camera, double angle);

// The points, and where they come when the body is turned about the scene's up, as `camera` has it,
// in `steps` equal angles: what a camera must hold that goes round.
std::vector<Vec3> TurnedAround(std::span<const Vec3> points, const Camera& camera, int steps);

// Width by height of the picture in which the points fill the frame, held within [0.75, 2.6].
// Errors: those of FrameCamera.
absl::StatusOr<double> NaturalAspect(std::span<const Vec3> points, const CameraOptions& options);

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_CAMERA_H_
