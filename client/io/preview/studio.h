#ifndef CLEAVE_CLIENT_IO_PREVIEW_STUDIO_H_
#define CLEAVE_CLIENT_IO_PREVIEW_STUDIO_H_

#include <cstdint>
#include <map>
#include <memory>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/io/preview/motion_survey.h"
#include "client/io/preview/preview.h"
#include "client/io/series/surface_sequence.h"
#include "core/picture/legend.h"

namespace cleave {

// What the camera stands on.
enum class Stand { kStill, kTurntable };

// Everything that the pictures of one run share: camera, colours, legend. Not thread-safe.
class Studio {
 public:
  // Looks through the run first (SurveyMotion). The arguments must outlive this object. Errors:
  // InvalidArgument for bad options or frames, Unavailable without a renderer.
  static absl::StatusOr<std::unique_ptr<Studio>> Create(const TetMesh& mesh,
                                                        const FrameSource& frames,
                                                        const PreviewOptions& options,
                                                        Stand stand = Stand::kStill);

  const MotionSurvey& survey() const { return survey_; }
  const Legend& legend() const { return legend_; }
  int width() const { return options_.width; }  // pixels of a picture
  int height() const { return height_; }
  double aspect() const { return static_cast<double>(options_.width) / height_; }
  double LetterHeight() const;  // pixels, of capitals

  // The picture of a frame, with time, pieces and broken edges at its foot. Frames are drawn in
  // ascending order.
  absl::StatusOr<Image> Draw(int64_t position) { return Draw(position, camera_); }
  // The same with the camera gone round by an angle (rad). Precondition: Stand::kTurntable.
  absl::StatusOr<Image> DrawTurned(int64_t position, double angle) {
    return Draw(position, Turned(camera_, angle));
  }

  // Title and legend on top of a picture.
  void DrawHead(Image& image) const;

 private:
  Studio(Renderer renderer, const TetMesh& mesh, const FrameSource& frames,
         const PreviewOptions& options);
  absl::Status Prepare(Stand stand);
  absl::StatusOr<Image> Draw(int64_t position, const Camera& camera);
  // Makes a frame ready, unless it is: a turntable's pictures are all of one.
  absl::Status Show(int64_t position);
  // Takes note of all frames before `position`.
  absl::Status FollowTo(int64_t position);
  void AddSwatches(const std::map<int32_t, RegionLook>& looks);
  absl::Status ChooseStrainLimit();

  Renderer renderer_;
  const TetMesh& mesh_;
  const FrameSource& frames_;
  const PreviewOptions& options_;
  SurfaceSequence sequence_;
  MotionSurvey survey_;
  Camera camera_;  // on a turntable, one that sees everything from wherever it is turned
  RenderStyle style_;
  Legend legend_;
  int height_ = 0;
  // The frame that is ready to be drawn.
  int64_t shown_ = -1;  // its position; -1: none
  double shown_time_ = 0;
  ShownSurface shown_props_;
  std::shared_ptr<const LitSolids> solids_;  // of the sequence's surface
  int64_t followed_ = 0;                     // frames that the sequence has taken note of
  double step_ = 0;                          // s, between the frames looked at
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PREVIEW_STUDIO_H_
