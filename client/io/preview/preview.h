#ifndef CLEAVE_CLIENT_IO_PREVIEW_PREVIEW_H_
#define CLEAVE_CLIENT_IO_PREVIEW_PREVIEW_H_

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/io/preview/props.h"
#include "client/io/series/frame_source.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"
#include "core/picture/camera.h"
#include "core/picture/image.h"
#include "core/picture/render.h"

namespace cleave {

// How a region is drawn. Regions of the same label share a line of the legend.
struct RegionLook {
  std::string label;
  int32_t slot = 0;  // of the palette
};

struct PreviewOptions {
  int width = 960;  // pixels of one picture, or of one tile of a sheet
  int height = 0;   // 0: as fits the motion
  int samples = 2;  // RenderStyle::samples
  ColorBy color_by = ColorBy::kRegion;
  // Of the mesh's region ids; empty: a slot a region, by ascending id, with the mesh's names.
  std::map<int32_t, RegionLook> regions;
  std::optional<double> strain_limit;  // absent: a round number that 1 % of the surface exceeds
  // Alpha of impurities, a finite number a node, for ColorBy::kImpurity.
  std::vector<double> node_potencies;
  std::vector<Prop> props;  // colliders, in grey
  // Drawn in place of the body's surface, where it is given (embedded_mesh.h); CheckRenderMesh
  // holds.
  const RenderMesh* render_mesh = nullptr;
  CameraOptions camera;
  std::string title;  // of the picture or sheet; may be empty
};

struct SheetOptions {
  int tiles = 12;   // at most; the frames between them are chosen where most happens
  int columns = 0;  // 0: as makes a sheet of handy shape
};

struct AnimationOptions {
  double frames_per_second = 24;  // of the animation, whatever the run's are
  int max_frames = 240;           // longer runs are thinned evenly
  double hold_seconds = 1;        // how long the last picture stays
  double quality = 82;            // of WebP, 0 to 100
};

struct TurntableOptions {
  int pictures = 72;              // of the turn, in [2, 1000]
  double frames_per_second = 24;  // of the animation
  int tiles = 8;                  // of the sheet, in [2, 100]
  double quality = 82;            // of WebP, 0 to 100
};

// All of these draw with one camera that holds the whole motion (but for crumbs: pieces of fewer
// than four nodes or 0.5 % of them), and write time, pieces and broken edges into each picture.
// They read the frames once for the camera (up to 256 of them) and once for the pictures. The same
// input gives the same bytes for any thread count. `progress` may be empty; it counts pictures.
// Precondition: `mesh` passed CheckMesh. Errors: InvalidArgument for no frames, frames of another
// mesh or bad options; Cancelled by `progress`; what reading frames gives.
absl::StatusOr<Image> RenderStill(const TetMesh& mesh, const FrameSource& frames, int64_t position,
                                  const PreviewOptions& options);

// A grid of pictures in the order of time.
absl::StatusOr<Image> RenderContactSheet(const TetMesh& mesh, const FrameSource& frames,
                                         const SheetOptions& sheet, const PreviewOptions& options,
                                         const Progress& progress);

// The bytes of an animated WebP.
absl::StatusOr<std::string> RenderAnimation(const TetMesh& mesh, const FrameSource& frames,
                                            const AnimationOptions& animation,
                                            const PreviewOptions& options,
                                            const Progress& progress);

// One frame, while the camera goes once round it: at one distance, from which it always sees all of
// that frame, and light goes along. An endless animation, and a sheet of views from equal angles.
absl::StatusOr<std::string> RenderTurntable(const TetMesh& mesh, const FrameSource& frames,
                                            int64_t position, const TurntableOptions& turntable,
                                            const PreviewOptions& options,
                                            const Progress& progress);
absl::StatusOr<Image> RenderTurntableSheet(const TetMesh& mesh, const FrameSource& frames,
                                           int64_t position, const TurntableOptions& turntable,
                                           const PreviewOptions& options, const Progress& progress);

// Writes a PNG file aside and renames it to `path`.
absl::Status WritePng(const std::string& path, const Image& image);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PREVIEW_PREVIEW_H_
