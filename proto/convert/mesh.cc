#include "proto/convert/mesh.h"

#include <limits>

#include "absl/strings/str_cat.h"
#include "cleave/v1/scene.pb.h"
#include "core/base/faults.h"
#include "core/base/status.h"
#include "google/protobuf/io/coded_stream.h"
#include "google/protobuf/io/zero_copy_stream_impl_lite.h"

namespace cleave {

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

absl::StatusOr<TetMesh> ParseMesh(absl::string_view bytes) {
  v1::TetMesh message;
  if (bytes.size() > static_cast<size_t>(std::numeric_limits<int32_t>::max()) ||
      !message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
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

void ScaleMesh(double unit_scale, TetMesh& mesh) {
  for (Vec3& position : mesh.rest_positions) {
    for (double& coordinate : position) coordinate *= unit_scale;
  }
}

}  // namespace cleave
