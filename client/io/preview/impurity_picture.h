#ifndef CLEAVE_CLIENT_IO_PREVIEW_IMPURITY_PICTURE_H_
#define CLEAVE_CLIENT_IO_PREVIEW_IMPURITY_PICTURE_H_

#include <span>
#include <string>

#include "absl/status/statusor.h"
#include "client/io/preview/camera.h"
#include "client/io/preview/image.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

struct ImpurityPictureOptions {
  int width = 960;  // pixels; the height is as fits the body
  int samples = 3;  // RenderStyle::samples
  CameraOptions camera;
  std::string title;
  std::string low = "pure", high = "most impure";  // what shares of 0 and 1 are called
};

// Draws the surface of a body at rest in magenta on yellow: `impurities` has a share in [0, 1] for
// every node, 1 for the most impure. Precondition: `mesh` passed CheckMesh. Errors: InvalidArgument
// for bad options or shares, Unavailable without a renderer.
absl::StatusOr<Image> RenderImpurities(const TetMesh& mesh, std::span<const double> impurities,
                                       const ImpurityPictureOptions& options);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PREVIEW_IMPURITY_PICTURE_H_
