#ifndef CLEAVE_CLIENT_IO_SERIES_SURFACE_SEQUENCE_H_
#define CLEAVE_CLIENT_IO_SERIES_SURFACE_SEQUENCE_H_

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "absl/status/status.h"
#include "client/io/series/moved_points.h"
#include "core/damage/named_pieces.h"
#include "core/mesh/incidence.h"
#include "core/mesh/tet_mesh.h"
#include "core/picture/shown_surface.h"
#include "core/stream/frame.h"
#include "core/surface/embedded_mesh.h"
#include "core/surface/faces.h"
#include "core/surface/visible_surface.h"

namespace cleave {

// What a sequence works out beside positions.
struct SequenceOptions {
  bool strains = false;
  bool damages = false;
  bool displacements = false;
  bool velocities = false;
  // Alpha of impurities, a node each; empty: the surface carries none. Precondition: finite.
  std::vector<double> node_potencies = {};
  bool sources = false;  // of outer triangles
  // Shown in place of the body's own surface, where it is given; CheckRenderMesh holds.
  const RenderMesh* render_mesh = nullptr;
};

// Turns the frames of one run, given in order, into the surfaces to be seen. Only what is round
// edges that broke since the last frame is made anew; else points just move. Not thread-safe; loops
// run on the caller's TBB arena.
class SurfaceSequence {
 public:
  // `mesh` must outlive this object and have passed CheckMesh.
  SurfaceSequence(const TetMesh& mesh, const SequenceOptions& options);
  SurfaceSequence(const SurfaceSequence&) = delete;
  SurfaceSequence& operator=(const SurfaceSequence&) = delete;

  // Goes on to `frame`, whose time is not before the last one's; frames may be left out. Errors:
  // InvalidArgument for a frame that is not this mesh's or not finite, or is of a surface view
  // where strains, velocities or a render mesh are wanted; then nothing changed.
  absl::Status Advance(const Frame& frame);
  // Goes on to a frame that is not to be shown: later ones look as if it had been, down to the bit.
  // Errors: as of Advance.
  absl::Status PassBy(const Frame& frame);

  // The surface of the last frame that was to be shown. Piece ids are those of NamedPieces: they
  // follow from the frames that were given, and are the simulation's own where none was left out,
  // as are the places of nodes that have lost their last tet (point_motion.h). Strains are means
  // over the live tets at the nodes (0 where there is none); velocities are means since the frame
  // before, 0 in the first.
  // Damages are means over all tets at the nodes on a point's side; potencies are interpolated.
  const ShownSurface& surface() const { return shown_; }
  // Its sheets share no edge and no point where they only touch (shared_edges.h, fans.h).
  const SurfaceTopology& topology() const { return topology_; }
  // Where there is a render mesh: how it is bound to the body. Else null.
  const EmbeddedMesh* embedded() const { return embedded_ ? &*embedded_ : nullptr; }
  const std::vector<int32_t>& node_pieces() const { return node_pieces_; }  // -1: of no tet
  int64_t piece_count() const { return pieces_->count(); }
  const Incidence& incidence() const { return incidence_; }
  // Whether the topology is another one than a frame before, be it shown or passed by.
  bool changed() const { return changed_; }

  // The share of broken edges of every tet, in [0, 1].
  std::vector<float> TetDamages() const;
  // Largest principal stretch minus 1 of every tet at the node positions given (m), as flat tets
  // have it: 0 for a tet without rest volume.
  std::vector<float> TetStrains(const std::vector<Vec3>& positions) const;

 private:
  absl::Status CheckKnown(const Frame& frame) const;
  // Takes pieces and points on to a frame.
  absl::Status GoOn(const Frame& frame);
  // Breaks what broke since the last frame.
  void Follow(const Frame& frame);
  void TakeApart();
  // Copies what the topology says into shown_.
  void Show();
  void FindSources();
  void FindDamages();
  void FindPotencies();
  void FindStrains(const std::vector<Vec3>& positions);

  const TetMesh& mesh_;
  SequenceOptions options_;
  Incidence incidence_;
  Faces faces_;
  MovedPoints moved_;
  std::vector<std::array<float, 9>> rest_inverses_;  // 1/m, a tet each; only with strains
  std::vector<float> rest_volumes_;                  // m^3; only with strains

  bool changed_ = false;
  bool is_stale_ = false;  // what is shown is of fewer broken edges
  double last_time_ = -std::numeric_limits<double>::infinity();  // s
  std::vector<int32_t> broken_edges_;
  std::optional<VisibleSurface> surface_;  // or, where there is a render mesh,
  std::optional<EmbeddedMesh> embedded_;
  SurfaceTopology topology_;      // of either
  std::vector<CornerUvs> uvs_;    // of the render mesh, a triangle each
  std::vector<int32_t> sources_;  // the same
  std::optional<NamedPieces> pieces_;
  std::vector<int32_t> node_pieces_;
  ShownSurface shown_;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_SERIES_SURFACE_SEQUENCE_H_
