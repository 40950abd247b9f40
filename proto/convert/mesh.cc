#include "proto/convert/mesh.h"

#include <limits>
#include <vector>

#include "absl/strings/str_cat.h"
#include "cleave/v1/scene.pb.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "google/protobuf/io/coded_stream.h"
#include "google/protobuf/io/zero_copy_stream_impl_lite.h"

namespace cleave {
namespace {

// The same bytes for the same message.
absl::StatusOr<std::string> Serialize(const google::protobuf::Message& message) {
  if (message.ByteSizeLong() > std::numeric_limits<int32_t>::max()) {
    return absl::InvalidArgumentError(absl::StrCat("mesh: ", message.ByteSizeLong(),
                                                   " bytes are more than one asset holds, 2 GiB"));
  }
  std::string bytes;
  {
    google::protobuf::io::StringOutputStream sink(&bytes);
    google::protobuf::io::CodedOutputStream coded(&sink);
    coded.SetSerializationDeterministic(true);
    message.SerializeWithCachedSizes(&coded);
  }
  return bytes;
}

// False for bytes that are no such message.
bool Parse(absl::string_view bytes, google::protobuf::Message& message) {
  return bytes.size() <= static_cast<size_t>(std::numeric_limits<int32_t>::max()) &&
         message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

void ScalePoints(double unit_scale, std::vector<Vec3>& points) {
  for (Vec3& point : points) {
    for (double& coordinate : point) coordinate *= unit_scale;
  }
}

}  // namespace

absl::StatusOr<std::string> SerializeMesh(const TetMesh& mesh) {
  v1::TetMesh message;
  message.mutable_positions()->Reserve(static_cast<int>(3 * mesh.rest_positions.size()));
  for (const Vec3& position : mesh.rest_positions) {
    for (const double coordinate : position) message.add_positions(coordinate);
  }
  message.mutable_tets()->Reserve(static_cast<int>(4 * mesh.tets.size()));
  for (const auto& tet : mesh.tets) {
    for (const int32_t node : tet) message.add_tets(static_cast<uint32_t>(node));
  }
  message.mutable_tet_regions()->Add(mesh.tet_regions.begin(), mesh.tet_regions.end());
  for (const MeshRegion& region : mesh.regions) {
    v1::MeshRegion* added = message.add_regions();
    added->set_id(region.id);
    added->set_name(region.name);
  }
  return Serialize(message);
}

absl::StatusOr<TetMesh> ParseMesh(absl::string_view bytes) {
  v1::TetMesh message;
  if (!Parse(bytes, message)) {
    return absl::InvalidArgumentError("mesh: the bytes are not a cleave.v1.TetMesh message");
  }
  Faults faults;
  if (message.positions_size() % 3 != 0) {
    faults.Error("positions",
                 absl::StrCat("has ", message.positions_size(), " numbers, not three a node"));
  }
  if (message.tets_size() % 4 != 0) {
    faults.Error("tets", absl::StrCat("has ", message.tets_size(), " node ids, not four a tet"));
  } else if (message.tet_regions_size() != 0 &&
             message.tet_regions_size() != message.tets_size() / 4) {
    faults.Error("tet_regions", absl::StrCat("has ", message.tet_regions_size(), " items for ",
                                             message.tets_size() / 4, " tets"));
  }
  for (int i = 0; i < message.tets_size(); ++i) {
    if (message.tets(i) > static_cast<uint32_t>(std::numeric_limits<int32_t>::max())) {
      faults.Error(absl::StrCat("tets[", i / 4, "]"),
                   absl::StrCat("node id ", message.tets(i), " is beyond 31 bits"));
    }
  }
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());

  TetMesh mesh;
  mesh.rest_positions.resize(static_cast<size_t>(message.positions_size() / 3));
  for (int i = 0; i < message.positions_size(); ++i) {
    mesh.rest_positions[static_cast<size_t>(i / 3)][static_cast<size_t>(i % 3)] =
        message.positions(i);
  }
  mesh.tets.resize(static_cast<size_t>(message.tets_size() / 4));
  for (int i = 0; i < message.tets_size(); ++i) {
    mesh.tets[static_cast<size_t>(i / 4)][static_cast<size_t>(i % 4)] =
        static_cast<int32_t>(message.tets(i));
  }
  mesh.tet_regions.assign(message.tet_regions().begin(), message.tet_regions().end());
  for (const v1::MeshRegion& region : message.regions()) {
    mesh.regions.push_back({region.id(), region.name()});
  }
  return mesh;
}

absl::StatusOr<std::string> SerializeRenderMesh(const RenderMesh& mesh) {
  v1::RenderMesh message;
  message.mutable_points()->Reserve(static_cast<int>(3 * mesh.points.size()));
  for (const Vec3& point : mesh.points) message.mutable_points()->Add(point.begin(), point.end());
  message.mutable_triangles()->Reserve(static_cast<int>(3 * mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    for (const int32_t point : triangle) message.add_triangles(static_cast<uint32_t>(point));
  }
  message.mutable_uvs()->Reserve(static_cast<int>(6 * mesh.uvs.size()));
  for (const CornerUvs& corners : mesh.uvs) {
    for (const auto& uv : corners) message.mutable_uvs()->Add(uv.begin(), uv.end());
  }
  return Serialize(message);
}

absl::StatusOr<RenderMesh> ParseRenderMesh(absl::string_view bytes) {
  v1::RenderMesh message;
  if (!Parse(bytes, message)) {
    return absl::InvalidArgumentError(
        "render_mesh: the bytes are not a cleave.v1.RenderMesh message");
  }
  Faults faults;
  if (message.points_size() % 3 != 0) {
    faults.Error("points",
                 absl::StrCat("has ", message.points_size(), " numbers, not three a point"));
  }
  if (message.triangles_size() % 3 != 0) {
    faults.Error("triangles", absl::StrCat("has ", message.triangles_size(),
                                           " point ids, not three a triangle"));
  } else if (message.uvs_size() != 0 && message.uvs_size() != 2 * message.triangles_size()) {
    faults.Error("uvs", absl::StrCat("has ", message.uvs_size(), " numbers for ",
                                     message.triangles_size() / 3, " triangles; six each"));
  }
  for (int i = 0; i < message.triangles_size(); ++i) {
    if (message.triangles(i) > static_cast<uint32_t>(std::numeric_limits<int32_t>::max())) {
      faults.Error(absl::StrCat("triangles[", i / 3, "]"),
                   absl::StrCat("point id ", message.triangles(i), " is beyond 31 bits"));
    }
  }
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());

  RenderMesh mesh;
  mesh.points.resize(static_cast<size_t>(message.points_size() / 3));
  for (int i = 0; i < message.points_size(); ++i)
    mesh.points[static_cast<size_t>(i / 3)][static_cast<size_t>(i % 3)] = message.points(i);
  mesh.triangles.resize(static_cast<size_t>(message.triangles_size() / 3));
  for (int i = 0; i < message.triangles_size(); ++i) {
    mesh.triangles[static_cast<size_t>(i / 3)][static_cast<size_t>(i % 3)] =
        static_cast<int32_t>(message.triangles(i));
  }
  mesh.uvs.resize(static_cast<size_t>(message.uvs_size() / 6));
  for (int i = 0; i < message.uvs_size(); ++i) {
    const auto corner = static_cast<size_t>(i / 2 % 3);
    mesh.uvs[static_cast<size_t>(i / 6)][corner][static_cast<size_t>(i % 2)] = message.uvs(i);
  }
  return mesh;
}

void ScaleMesh(double unit_scale, TetMesh& mesh) { ScalePoints(unit_scale, mesh.rest_positions); }

void ScaleMesh(double unit_scale, RenderMesh& mesh) { ScalePoints(unit_scale, mesh.points); }

}  // namespace cleave
