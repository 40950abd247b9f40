#ifndef CLEAVE_CLIENT_IO_PREVIEW_MOTION_SURVEY_H_
#define CLEAVE_CLIENT_IO_PREVIEW_MOTION_SURVEY_H_

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "client/io/series/frame_source.h"
#include "core/base/vec3.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// What a first look at a run tells: where it goes and when it breaks.
struct MotionSurvey {
  std::vector<int64_t> positions;  // of the frames looked at, ascending, first and last among them
  std::vector<double> times;       // s, of those
  std::vector<int64_t> broken_edges;  // of those
  std::vector<Vec3> points;           // m, nodes of all frames but those of crumbs
};

// Looks at up to `most` frames, evenly spaced. With `points`, nodes of up to 64 of them are kept,
// at most 4096 a frame. Errors: InvalidArgument for no frames or frames of another mesh.
absl::StatusOr<MotionSurvey> SurveyMotion(const TetMesh& mesh, const FrameSource& frames,
                                          int64_t most);

// `count` of the survey's frames, first and last among them, ascending and different: as many as
// there are where there are fewer. Half of the choice follows time, half follows the edges that
// break, so that a short break gets its pictures.
std::vector<int64_t> ChooseFrames(const MotionSurvey& survey, int count);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PREVIEW_MOTION_SURVEY_H_
