#ifndef CLEAVE_CLIENT_IO_MESH_MESH_BUILDER_H_
#define CLEAVE_CLIENT_IO_MESH_MESH_BUILDER_H_

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "core/mesh/tet_mesh.h"

namespace cleave {

// Collects a mesh whose file names nodes by numbers of its own, in any order and with gaps. Node
// and tet ids of the result are positions in the file.
class MeshBuilder {
 public:
  void AddNode(int64_t number, const Vec3& position) {
    numbers_.push_back(number);
    mesh_.rest_positions.push_back(position);
  }
  // `number` is the file's own number of the element, for messages.
  void AddTet(int64_t number, const std::array<int64_t, 4>& node_numbers, int32_t region) {
    tet_numbers_.push_back(number);
    tets_.push_back(node_numbers);
    mesh_.tet_regions.push_back(region);
  }
  void NameRegion(int32_t id, std::string name) { region_names_[id] = std::move(name); }

  int64_t node_count() const { return mesh_.node_count(); }
  int64_t tet_count() const { return static_cast<int64_t>(tets_.size()); }
  void SetRegion(int64_t tet, int32_t region) {
    mesh_.tet_regions[static_cast<size_t>(tet)] = region;
  }

  // The mesh. Errors: no tets, more than limits::kMaxTets or kMaxNodes, two nodes of one number, a
  // tet that names a node which is not there. Leaves the builder empty.
  absl::StatusOr<TetMesh> Finish();

 private:
  TetMesh mesh_;
  std::vector<int64_t> numbers_;
  std::vector<int64_t> tet_numbers_;
  std::vector<std::array<int64_t, 4>> tets_;
  std::map<int32_t, std::string> region_names_;
};

// What a reader says to elements that it cannot use: InvalidArgument that names them, and the way
// out. `where` as "element 17".
absl::Status RefuseElement(absl::string_view where, absl::string_view kind);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_MESH_MESH_BUILDER_H_
