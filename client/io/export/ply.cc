#include "client/io/export/ply.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "core/base/bytes.h"
#include "core/base/status.h"
#include "core/picture/palette.h"

namespace cleave {
namespace {

// One of the two is there.
struct Attribute {
  const char* name;
  const std::vector<Vec3>* vectors;
  const std::vector<float>* values;
};

}  // namespace

absl::StatusOr<std::string> EncodePly(const ShownSurface& surface, absl::string_view comment) {
  CLEAVE_RETURN_IF_ERROR(CheckShownSurface(surface));
  std::vector<int32_t> point_pieces(surface.points.size(), 0);
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const int32_t point : surface.triangles[i]) {
      point_pieces[static_cast<size_t>(point)] = surface.pieces[i];
    }
  }
  constexpr int64_t kMostSource = std::numeric_limits<int32_t>::max();
  for (size_t i = 0; i < surface.sources.size(); ++i) {
    if (surface.sources[i] <= kMostSource) continue;
    return absl::InvalidArgumentError(
        absl::StrCat("sources[", i, "]: ", surface.sources[i], " is above ", kMostSource));
  }
  // What the surface carries beside positions, a group of properties each.
  std::vector<Attribute> attributes;
  const auto add_vectors = [&](const char* name, const std::vector<Vec3>& vectors) {
    if (!vectors.empty()) attributes.push_back({name, &vectors, nullptr});
  };
  const auto add_values = [&](const char* name, const std::vector<float>& values) {
    if (!values.empty()) attributes.push_back({name, nullptr, &values});
  };
  add_vectors("rest", surface.rest_points);
  add_vectors("velocity", surface.velocities);
  add_values("strain", surface.strains);
  add_values("damage", surface.damages);
  add_values("potency", surface.potencies);
  std::string out = absl::StrFormat(
      "ply\nformat binary_little_endian 1.0\ncomment %s\ncomment time %.9g s, frame %d\n"
      "element vertex %u\nproperty float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n",
      comment, surface.time, surface.frame, surface.points.size());
  for (const Attribute& attribute : attributes) {
    if (attribute.values != nullptr) {
      absl::StrAppend(&out, "property float ", attribute.name, "\n");
      continue;
    }
    for (const char* axis : {"_x", "_y", "_z"}) {
      absl::StrAppend(&out, "property float ", attribute.name, axis, "\n");
    }
  }
  absl::StrAppend(&out, "element face ", surface.triangles.size(),
                  "\nproperty list uchar int vertex_indices\nproperty int piece\n"
                  "property int region\nproperty uchar inside\n");
  if (!surface.sources.empty()) absl::StrAppend(&out, "property int source\n");
  if (!surface.uvs.empty()) absl::StrAppend(&out, "property list uchar float texcoord\n");
  absl::StrAppend(&out, "end_header\n");
  out.reserve(out.size() + surface.points.size() * (15 + 12 * attributes.size()) +
              surface.triangles.size() * (surface.uvs.empty() ? 26 : 51));
  ByteWriter writer(out);
  const auto put = [&](const Vec3& vector) {
    for (const double coordinate : vector) writer.Put(static_cast<float>(coordinate));
  };
  for (size_t i = 0; i < surface.points.size(); ++i) {
    put(surface.points[i]);
    for (const float channel : PieceColor(point_pieces[i])) {
      writer.Put(static_cast<uint8_t>(std::lround(channel * 255.0f)));
    }
    for (const Attribute& attribute : attributes) {
      if (attribute.vectors != nullptr) {
        put((*attribute.vectors)[i]);
      } else {
        writer.Put((*attribute.values)[i]);
      }
    }
  }
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    writer.Put<uint8_t>(3);
    for (const int32_t point : surface.triangles[i]) writer.Put(point);
    writer.Put(surface.pieces[i]);
    writer.Put(surface.regions[i]);
    writer.Put(surface.inside[i]);
    if (!surface.sources.empty()) writer.Put(static_cast<int32_t>(surface.sources[i]));
    if (surface.uvs.empty()) continue;
    writer.Put<uint8_t>(6);
    for (const auto& [u, v] : surface.uvs[i]) {
      writer.Put(u);
      writer.Put(v);
    }
  }
  return out;
}

}  // namespace cleave
