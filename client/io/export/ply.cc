#include "client/io/export/ply.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/io/series/palette.h"
#include "core/base/bytes.h"
#include "core/base/status.h"

namespace cleave {

absl::StatusOr<std::string> EncodePly(const ShownSurface& surface, absl::string_view comment) {
  CLEAVE_RETURN_IF_ERROR(CheckShownSurface(surface));
  std::vector<int32_t> point_pieces(surface.points.size(), 0);
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const int32_t point : surface.triangles[i]) {
      point_pieces[static_cast<size_t>(point)] = surface.pieces[i];
    }
  }
  std::string out = absl::StrFormat(
      "ply\nformat binary_little_endian 1.0\ncomment %s\ncomment time %.9g s, frame %d\n"
      "element vertex %u\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face %u\nproperty list uchar int vertex_indices\nproperty int piece\n"
      "property int region\nproperty uchar inside\nend_header\n",
      comment, surface.time, surface.frame, surface.points.size(), surface.triangles.size());
  out.reserve(out.size() + surface.points.size() * 15 + surface.triangles.size() * 22);
  ByteWriter writer(out);
  for (size_t i = 0; i < surface.points.size(); ++i) {
    for (const double coordinate : surface.points[i]) writer.Put(static_cast<float>(coordinate));
    for (const float channel : PieceColor(point_pieces[i])) {
      writer.Put(static_cast<uint8_t>(std::lround(channel * 255.0f)));
    }
  }
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    writer.Put<uint8_t>(3);
    for (const int32_t point : surface.triangles[i]) writer.Put(point);
    writer.Put(surface.pieces[i]);
    writer.Put(surface.regions[i]);
    writer.Put(surface.inside[i]);
  }
  return out;
}

}  // namespace cleave
