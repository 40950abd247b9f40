#include "client/io/impurity/layer_files.h"

#include <algorithm>
#include <filesystem>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/io/impurity/picture_file.h"
#include "client/io/impurity/ply_points.h"
#include "client/io/mesh/file_bytes.h"
#include "client/io/mesh/vtu.h"
#include "client/io/surface/surface_file.h"
#include "core/base/status.h"
#include "core/scene/impurity_rules.h"
#include "proto/convert/impurity_layer.h"

namespace cleave {
namespace {

// The status with the path before it.
absl::Status At(const std::string& path, const absl::Status& status) {
  return absl::Status(status.code(), absl::StrCat(path, ": ", status.message()));
}

absl::StatusOr<PlyPoints> ReadPly(const std::string& path, const std::string& property) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
  auto points = ParsePlyPoints(bytes, property);
  if (!points.ok()) return At(path, points.status());
  return points;
}

absl::Status ReadImage(const std::string& path, v1::SegmentPattern& pattern) {
  const ImageDrawing image = ImageFromMessage(pattern.image());
  Faults faults;
  CheckTracing("", image, faults);
  if (!faults.ok()) return faults.ToStatus();
  CLEAVE_ASSIGN_OR_RETURN(const GreyRaster raster, ReadPictureFile(path));
  const auto curves = TraceDrawing(raster, image);
  if (!curves.ok()) return At(path, curves.status());
  WriteCurves(*curves, *pattern.mutable_curves());
  pattern.clear_image();
  return absl::OkStatus();
}

absl::Status ReadNodeValues(const std::string& path, v1::NodeValues& values) {
  std::vector<double> shares;
  if (absl::EndsWithIgnoreCase(path, ".ply")) {
    CLEAVE_ASSIGN_OR_RETURN(PlyPoints points, ReadPly(path, values.array()));
    shares = std::move(points.values);
  } else if (absl::EndsWithIgnoreCase(path, ".vtu")) {
    CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
    auto array = ParseVtuPointArray(bytes, values.array());
    if (!array.ok()) return At(path, array.status());
    shares = *std::move(array);
  } else {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ": values of nodes come in a .vtu or a .ply file"));
  }
  values.mutable_shares()->Add(shares.begin(), shares.end());
  values.clear_file();
  values.clear_array();
  return absl::OkStatus();
}

// A side. Nodes sample a texture, and bodies have fewer of them along a side; a larger picture
// would only fill the 4 MiB that servers take.
constexpr int kMostTexels = 1024;

absl::Status ReadTexture(const std::string& path, v1::SurfaceTexture& texture) {
  const int channel = texture.channel();
  if (channel < 0 || channel > v1::TextureChannel_MAX)
    return absl::InvalidArgumentError(absl::StrCat("channel: ", channel, " is none"));
  CLEAVE_ASSIGN_OR_RETURN(
      const PictureBytes read,
      ReadChannelFile(path, static_cast<TextureChannel>(std::max(channel, 1) - 1)));
  const PictureBytes picture = Reduced(read, kMostTexels);
  texture.set_width(picture.width);
  texture.set_height(picture.height);
  texture.set_values(std::string(picture.values.begin(), picture.values.end()));
  texture.clear_file();
  texture.clear_channel();
  return absl::OkStatus();
}

// The surface that a texture is on.
absl::Status ReadTexturedSurface(const std::string& path, v1::SurfacePaint& paint) {
  if (!paint.array().empty())
    return absl::InvalidArgumentError("array: has no meaning where a texture has the values");
  CLEAVE_ASSIGN_OR_RETURN(const SurfaceMesh surface, ReadSurfaceFile(path));
  if (surface.uvs.empty()) {
    return absl::InvalidArgumentError(
        absl::StrCat(path, ": has no texture coordinates, or only some of its faces have"));
  }
  for (const Vec3& vertex : surface.vertices)
    paint.mutable_vertices()->Add(vertex.begin(), vertex.end());
  for (const auto& triangle : surface.triangles)
    paint.mutable_triangles()->Add(triangle.begin(), triangle.end());
  for (const auto& corners : surface.uvs) {
    for (const auto& uv : corners)
      paint.mutable_texture()->mutable_uvs()->Add(uv.begin(), uv.end());
  }
  paint.clear_file();
  return absl::OkStatus();
}

absl::Status ReadPaint(const std::string& path, v1::SurfacePaint& paint) {
  if (!absl::EndsWithIgnoreCase(path, ".ply")) {
    return absl::InvalidArgumentError(absl::StrCat(
        path, ": values of vertices come in a .ply file; other surfaces need a texture"));
  }
  CLEAVE_ASSIGN_OR_RETURN(const PlyPoints points, ReadPly(path, paint.array()));
  if (points.triangles.empty())
    return absl::InvalidArgumentError(absl::StrCat(path, ": has no faces; paint needs a surface"));
  paint.mutable_shares()->Add(points.values.begin(), points.values.end());
  for (const Vec3& vertex : points.vertices)
    paint.mutable_vertices()->Add(vertex.begin(), vertex.end());
  for (const auto& triangle : points.triangles)
    paint.mutable_triangles()->Add(triangle.begin(), triangle.end());
  paint.clear_file();
  paint.clear_array();
  return absl::OkStatus();
}

constexpr char kBesides[] = "stands beside what it should hold; give one of both";

}  // namespace

std::vector<Fault> ReadLayerFiles(const std::string& folder, v1::Impurities& impurities) {
  std::vector<Fault> faults;
  for (int k = 0; k < impurities.layers_size(); ++k) {
    v1::ImpurityLayer& layer = *impurities.mutable_layers(k);
    const auto read = [&](const char* field, const std::string& file, bool besides,
                          const auto& read_file) {
      const std::string path = absl::StrCat("impurities.layers[", k, "].", field);
      if (besides) {
        faults.push_back({path, kBesides});
        return;
      }
      const absl::Status status =
          read_file((std::filesystem::path(folder) / file).lexically_normal().string());
      if (!status.ok()) faults.push_back({path, std::string(status.message())});
    };
    if (layer.pattern().has_image() && !layer.pattern().image().file().empty()) {
      v1::SegmentPattern& pattern = *layer.mutable_pattern();
      read("pattern.image.file", pattern.image().file(), pattern.curves_size() > 0,
           [&](const std::string& path) { return ReadImage(path, pattern); });
    } else if (!layer.node_values().file().empty()) {
      v1::NodeValues& values = *layer.mutable_node_values();
      read("node_values.file", values.file(), values.shares_size() > 0,
           [&](const std::string& path) { return ReadNodeValues(path, values); });
    } else if (layer.has_paint()) {
      v1::SurfacePaint& paint = *layer.mutable_paint();
      if (!paint.file().empty()) {
        const bool besides = paint.shares_size() + paint.vertices_size() + paint.triangles_size() +
                                 paint.texture().uvs_size() >
                             0;
        read("paint.file", paint.file(), besides, [&](const std::string& path) {
          return paint.has_texture() ? ReadTexturedSurface(path, paint) : ReadPaint(path, paint);
        });
      }
      if (!paint.texture().file().empty()) {
        v1::SurfaceTexture& texture = *paint.mutable_texture();
        const bool besides =
            texture.width() != 0 || texture.height() != 0 || !texture.values().empty();
        read("paint.texture.file", texture.file(), besides,
             [&](const std::string& path) { return ReadTexture(path, texture); });
      }
    }
  }
  return faults;
}

}  // namespace cleave
