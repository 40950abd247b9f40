#ifndef CLEAVE_CLIENT_IO_EXPORT_SURFACE_GRID_H_
#define CLEAVE_CLIENT_IO_EXPORT_SURFACE_GRID_H_

#include "client/io/export/vtu.h"
#include "client/io/series/surface_sequence.h"

namespace cleave {

// The surface of the sequence's last frame, with the arrays of VtuContent::kSurface. VTK takes
// texture coordinates from points, so where those of outer faces meet, a point is doubled; its
// copies share its id, and faces that cracks opened have whichever of them.
VtuGrid SurfaceGrid(const SurfaceSequence& sequence);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_EXPORT_SURFACE_GRID_H_
