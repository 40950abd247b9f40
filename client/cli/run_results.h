#ifndef CLEAVE_CLIENT_CLI_RUN_RESULTS_H_
#define CLEAVE_CLIENT_CLI_RUN_RESULTS_H_

#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/cli/interrupt.h"
#include "client/io/preview/preview.h"
#include "client/io/record/recording.h"
#include "client/io/series/frame_source.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// A recording and the mesh that its frames are of, ready for exporters.
struct RecordedRun {
  TetMesh mesh;  // m, checked
  Recording recording;
};

// Opens what a person names: a run's folder (frames.clv and mesh.pb in it) or a .clv file, with its
// mesh beside it (mesh.pb) unless `mesh_path` names one (ReadAnyMesh).
absl::StatusOr<RecordedRun> OpenRecordedRun(const std::string& path, const std::string& mesh_path,
                                            double unit_scale);

// Gives pictures the scene's title, material names, up and colliders where the run's folder (or the
// .clv's) holds its scene; else leaves them as they are. Colliders are where the folder's reports
// say.
absl::Status ApplyRunLook(const std::string& path, const TetMesh& mesh, PreviewOptions& look);

// Alpha of impurities, a node each, where the run's folder (or the .clv's) holds its scene and that
// has impurities; else nothing. Makes the scene's model: takes the time and the memory of that.
absl::StatusOr<std::vector<double>> RunPotencies(const std::string& path, const TetMesh& mesh);

// Only every `stride`-th frame from `first` to `last` (frame numbers), at most all.
absl::StatusOr<FrameSource> SelectFrames(const Recording& recording, int64_t first, int64_t last,
                                         int64_t stride);

// Shows "what: done of total" on stderr about every two seconds; stops when a signal came.
Progress ShowingProgress(std::string what, Interrupt& interrupt);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_CLI_RUN_RESULTS_H_
