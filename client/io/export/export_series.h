#ifndef CLEAVE_CLIENT_IO_EXPORT_EXPORT_SERIES_H_
#define CLEAVE_CLIENT_IO_EXPORT_EXPORT_SERIES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/io/series/frame_source.h"
#include "core/mesh/render_mesh.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// What the cells of a VTU series are.
enum class VtuContent {
  kSurface,  // triangles of the closed surfaces of all pieces, split elements included
  kVolume,   // every tet; four corner cells in place of one whose vertices are separated
};

struct ExportOptions {
  std::string folder;           // made where it is missing
  std::string name = "cleave";  // files are NAME_000012.vtu, the collection NAME.pvd
  // Alpha of impurities, a finite number a node; empty: files carry none.
  std::vector<double> node_potencies = {};
  // Written in place of the body's surface, where it is given (embedded_mesh.h); not with a volume.
  const RenderMesh* render_mesh = nullptr;
};

struct ExportResult {
  int64_t written = 0;     // files
  int64_t kept = 0;        // files that stood already, made from the same data
  std::string collection;  // path of the .pvd; empty for PLY and OBJ
  int64_t gaps = 0;        // of a render mesh: EmbeddedMesh::gaps
};

// Writes a file a frame and a ParaView collection of them. A frame's file does not depend on which
// others `frames` leaves out.
// Point data of both contents: piece, rest (m), displacement (m, from rest), velocity (m/s, mean
// since the frame before; 0 in the first), and potency where it is given. Surface: strain a point
// (largest principal stretch less 1, mean of the tets round it), damage a point (share of broken
// edges, mean of the tets round it), id a point and a cell (surface_ids.h), and uv a point (VTK's
// TCoords; surface_grid.h) of a render mesh that has them; region, tet, piece, inside (1: opened by
// a crack) and source (ShownSurface::sources) a cell. Volume: region, tet,
// piece, strain, damage, broken_edges (of the tet, 0 to 6) and separated (0 or 1) a cell. Pieces
// are those of SurfaceSequence, tets the mesh file's.
//
// A file that an earlier call made from the same data is kept, so that a cut export goes on where
// it was. Files are written aside and renamed. After an error (or a stop by `progress`, Cancelled)
// the collection lists what is there. `progress` may be empty. Precondition: `mesh` passed
// CheckMesh. Errors: InvalidArgument for no frames or frames of another mesh; what reading frames
// and writing files gives.
absl::StatusOr<ExportResult> WriteVtuSeries(const TetMesh& mesh, const FrameSource& frames,
                                            VtuContent content, const ExportOptions& options,
                                            const Progress& progress);

// The same as PLY files of the surface (ply.h), with rest, velocity, strain, damage and potency a
// point; there is no collection.
absl::StatusOr<ExportResult> WritePlySeries(const TetMesh& mesh, const FrameSource& frames,
                                            const ExportOptions& options, const Progress& progress);

// The same as Wavefront OBJ files (obj.h) and NAME.mtl, their materials.
absl::StatusOr<ExportResult> WriteObjSeries(const TetMesh& mesh, const FrameSource& frames,
                                            const ExportOptions& options, const Progress& progress);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_EXPORT_EXPORT_SERIES_H_
