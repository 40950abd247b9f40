#ifndef CLEAVE_CLIENT_IO_BAKE_BAKE_H_
#define CLEAVE_CLIENT_IO_BAKE_BAKE_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/io/series/frame_source.h"
#include "core/base/vec3.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

enum class BakeFormat {
  kPc2,   // NAME.obj, NAME.mtl and NAME.pc2
  kMdd,   // NAME.obj, NAME.mtl and NAME.mdd
  kGlb,   // NAME.glb
  kUsda,  // NAME.usda
};

struct BakeOptions {
  std::string folder;           // made where it is missing
  std::string name = "cleave";  // what file names begin with
  BakeFormat format = BakeFormat::kPc2;
  // Frame numbers a second, in [0.001, 100000], at which GLB, USDA and MDD play; absent: as fast as
  // simulated.
  std::optional<double> playback_rate;
  // PC2 and MDD: also NAME.velocity.pc2 or .mdd, m/s in place of m; GLB: `_VELOCITY` in every morph
  // target. USDA always has them.
  bool velocities = false;
  Vec3 up{0, 0, 1};  // of the scene: what GLB turns to its y
  // Baked in place of the body's surface, where it is given (embedded_mesh.h); CheckRenderMesh
  // holds.
  const RenderMesh* render_mesh = nullptr;
};

struct BakeResult {
  int64_t written = 0;            // frames
  int64_t kept = 0;               // frames that stood already, made from the same data
  std::string path;               // the file with the frames
  std::vector<std::string> also;  // the others
  int64_t gaps = 0;               // of a render mesh: EmbeddedMesh::gaps
};

// Writes a run as one surface whose topology is the same in all frames (baked_surface.h), in the
// scene's axes and metres. Beside each file stands FILE.json: what it is made from, frames, rate,
// up, and the pieces with their volumes.
//
// One frame is in memory at a time. A file grows as FILE.part and is renamed when it is whole; a
// call that was cut goes on where the last mark says, at most some seconds back, and a whole file
// made from the same data is kept. The bytes are those of an unbroken call. Pieces are called as
// in a SurfaceSequence of the same frames. `progress` counts frames, once for the names of pieces
// and again as they are written (USDA: twice as many), and may be empty. Precondition: `mesh`
// passed CheckMesh. Errors: InvalidArgument for no frames, frames of another mesh, frames without a
// surface, bad options or a format's limits; Cancelled by `progress`; what reading frames and
// writing files gives.
absl::StatusOr<BakeResult> WriteBake(const TetMesh& mesh, const FrameSource& frames,
                                     const BakeOptions& options, const Progress& progress);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_BAKE_BAKE_H_
