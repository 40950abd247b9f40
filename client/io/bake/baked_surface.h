#ifndef CLEAVE_CLIENT_IO_BAKE_BAKED_SURFACE_H_
#define CLEAVE_CLIENT_IO_BAKE_BAKED_SURFACE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/io/series/moved_points.h"
#include "core/base/vec3.h"
#include "core/damage/named_pieces.h"
#include "core/mesh/incidence.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"
#include "core/stream/frame.h"
#include "core/surface/surface_topology.h"

namespace cleave {

// A piece of the body as the last frame has it.
struct BakedPiece {
  int32_t smallest_node = 0;
  int32_t nodes = 0;
  double volume = 0;     // m^3 at rest
  Vec3 center{0, 0, 0};  // m at rest, of the nodes' shares of the volume
};

// The surface of a run's last frame as one topology for all of its frames: what is in pieces at the
// end is so from the start, and the two sides of a crack coincide until it opens.
struct BakedSurface {
  SurfaceTopology topology;
  std::vector<BakedPiece> pieces;  // by id
  std::vector<int32_t> triangle_pieces;
  std::vector<int32_t> triangle_regions;
  std::vector<int32_t> point_pieces;
  std::vector<CornerUvs> uvs;  // of a render mesh, a triangle each; empty: it has none
  int64_t gaps = 0;            // of a render mesh: EmbeddedMesh::gaps

  // Texture coordinates of a triangle's corner: its own on outer faces where there are any, else
  // RestUv.
  std::array<float, 2> UvAt(size_t triangle, size_t corner) const;
};

// Preconditions: `broken_edges`, those of the last frame, are ascending and in range; `pieces` has
// come to the last frame. With a render mesh that stands for the body's surface; null: none.
BakedSurface BakeSurface(const TetMesh& mesh, const Incidence& incidence, const NamedPieces& pieces,
                         std::span<const int32_t> broken_edges, const RenderMesh* render_mesh);

// Carries a baked surface through the frames of its run. A copy of a point moves with all nodes
// that some tet still joins to its own at that frame, so copies coincide to the last bit for as
// long as nothing parts them there, and the surface is that of ExtractSurface but for finer
// triangles. Not thread-safe; loops run on the caller's TBB arena.
class BakedMotion {
 public:
  // All arguments must outlive this object.
  BakedMotion(const TetMesh& mesh, const Incidence& incidence, const BakedSurface& surface,
              std::span<const int32_t> last_broken_edges);
  BakedMotion(const BakedMotion&) = delete;
  BakedMotion& operator=(const BakedMotion&) = delete;

  // Goes on to `frame`; frames come in order, those that are not shown too: crumbs keep the turn of
  // the last one before they came apart. Errors: InvalidArgument for what CheckFrame refuses and
  // for a broken edge that the last frame does not have.
  absl::Status Advance(const Frame& frame);

  const std::vector<Vec3>& points() const { return moved_.points(); }  // m
  // m/s, means since the frame before: 0 in the first.
  const std::vector<Vec3>& velocities() const { return moved_.velocities(); }

 private:
  uint8_t OwnersOf(const SurfacePoint& point, std::span<const int32_t> tets) const;

  const TetMesh& mesh_;
  const Incidence& incidence_;
  const BakedSurface& surface_;
  const std::span<const int32_t> last_broken_edges_;
  SurfaceTopology now_;                // points and masks as they are in this frame, nothing else
  std::vector<int32_t> split_points_;  // copies among several
  Csr split_tets_;                     // the tets that may join a copy's nodes, a row each
  MovedPoints moved_;
  std::vector<int32_t> broken_edges_;
  double time_ = 0;
  bool started_ = false;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_BAKE_BAKED_SURFACE_H_
