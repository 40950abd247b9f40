#ifndef CLEAVE_CLIENT_IO_EXPORT_PLY_H_
#define CLEAVE_CLIENT_IO_EXPORT_PLY_H_

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/picture/shown_surface.h"

namespace cleave {

// The bytes of a PLY file (1.0, binary little-endian). Vertices: x, y, z in metres as float, and
// red, green, blue by piece; then, as floats, what the surface carries of rest_x, _y, _z (m),
// velocity_x, _y, _z (m/s), strain, damage and potency. Faces: vertex_indices, piece and region as
// int, inside as uchar (1: opened by a crack), and what it carries of source as int (-1 inside) and
// texcoord, a list of six floats, u and v of each corner (0 inside). `comment` is one line. Errors:
// those of CheckShownSurface; InvalidArgument for a source that an int does not hold.
absl::StatusOr<std::string> EncodePly(const ShownSurface& surface, absl::string_view comment);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_EXPORT_PLY_H_
