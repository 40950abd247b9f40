#ifndef CLEAVE_CORE_PICTURE_IMPURITY_PICTURE_H_
#define CLEAVE_CORE_PICTURE_IMPURITY_PICTURE_H_

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/base/faults.h"
#include "core/mesh/tet_mesh.h"
#include "core/picture/camera.h"
#include "core/picture/image.h"

namespace cleave {

struct ImpurityPictureOptions {
  int width = 960;  // pixels; the height is as fits the body
  int samples = 3;  // RenderStyle::samples
  CameraOptions camera;
  std::string title;
  std::string low = "pure", high = "most impure";  // what shares of 0 and 1 are called
};

// What is wrong with options, by the names of their fields; those of the camera without a prefix.
// The width must be in [16, max_width].
Faults CheckImpurityPicture(const ImpurityPictureOptions& options, int max_width);

// How impure every node looks, [0, 1]: its |potency| in the largest, or how far edges of it are
// weakened or strengthened, whichever is more. `weakenings` has what the strength of each of
// `edges` counts, [0, infinity]; edges that count as they are may be left out. Precondition: nodes
// of edges have potencies.
std::vector<double> ImpurityShares(std::span<const double> potencies,
                                   std::span<const std::array<int32_t, 2>> edges,
                                   std::span<const double> weakenings);

// Draws the surface of a body at rest in magenta on yellow: `impurities` has a share in [0, 1] for
// every node, 1 for the most impure. Precondition: `mesh` passed CheckMesh. Errors: InvalidArgument
// for bad options or shares, Unavailable without a renderer.
absl::StatusOr<Image> RenderImpurities(const TetMesh& mesh, std::span<const double> impurities,
                                       const ImpurityPictureOptions& options);

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_IMPURITY_PICTURE_H_
