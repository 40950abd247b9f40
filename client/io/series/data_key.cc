#include "client/io/series/data_key.h"

#include <cstdint>
#include <vector>

#include "absl/strings/str_format.h"

namespace cleave {
namespace {

// Raised whenever the files made from the same frames change.
constexpr int kExportVersion = 4;

template <typename T>
void Absorb(const std::vector<T>& values, StateHash& hash) {
  const uint64_t count = values.size();
  hash.Update(&count, sizeof(count));
  hash.Update(values.data(), count * sizeof(T));
}

}  // namespace

DataKey::DataKey(const TetMesh& mesh, absl::string_view format) {
  hash_.Update(&kExportVersion, sizeof(kExportVersion));
  hash_.Update(format.data(), format.size());
  Absorb(mesh.rest_positions, hash_);
  Absorb(mesh.tets, hash_);
  Absorb(mesh.tet_regions, hash_);
  for (const MeshRegion& region : mesh.regions) {
    hash_.Update(&region.id, sizeof(region.id));
    hash_.Update(region.name.data(), region.name.size());
  }
}

void DataKey::Add(const Frame& frame) {
  hash_.Update(&frame.frame, sizeof(frame.frame));
  hash_.Update(&frame.time, sizeof(frame.time));
  Absorb(frame.positions, hash_);
  Absorb(frame.broken_edges, hash_);
}

std::string DataKey::Comment() const { return absl::StrFormat("cleave %016x", hash_.Digest()); }

std::string RenderMeshKey(const RenderMesh* mesh) {
  if (mesh == nullptr) return "";
  StateHash hash;
  Absorb(mesh->points, hash);
  Absorb(mesh->triangles, hash);
  Absorb(mesh->uvs, hash);
  return absl::StrFormat(" render %d", hash.Digest());
}

}  // namespace cleave
