#include "client/io/mesh/mesh_builder.h"

#include <algorithm>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/status.h"
#include "core/mesh/mesh_check.h"

namespace cleave {

absl::StatusOr<TetMesh> MeshBuilder::Finish() {
  if (tets_.empty()) {
    return absl::InvalidArgumentError(
        "the file holds no tetrahedra; only the inside of a body can break, so mesh its volume "
        "(Gmsh: `gmsh -3`, with the volume in a physical group if there are any)");
  }
  CLEAVE_RETURN_IF_ERROR(CheckMeshCounts(node_count(), tet_count()).ToStatus());

  bool consecutive = true;
  for (size_t node = 1; node < numbers_.size() && consecutive; ++node)
    consecutive = numbers_[node - 1] < INT64_MAX && numbers_[node] == numbers_[node - 1] + 1;
  std::vector<std::pair<int64_t, int32_t>> sorted;
  if (!consecutive) {
    for (size_t node = 0; node < numbers_.size(); ++node)
      sorted.push_back({numbers_[node], static_cast<int32_t>(node)});
    std::sort(sorted.begin(), sorted.end());
    for (size_t i = 1; i < sorted.size(); ++i) {
      if (sorted[i].first == sorted[i - 1].first) {
        return absl::InvalidArgumentError(
            absl::StrCat("two nodes have the number ", sorted[i].first));
      }
    }
  }
  // The id of a node's number, or -1.
  const auto id_of = [&](int64_t number) -> int32_t {
    if (numbers_.empty()) return -1;
    if (consecutive) {
      if (number < numbers_.front() || number > numbers_.back()) return -1;
      return static_cast<int32_t>(number - numbers_.front());
    }
    const auto found =
        std::lower_bound(sorted.begin(), sorted.end(), std::pair(number, int32_t{-1}));
    return found != sorted.end() && found->first == number ? found->second : -1;
  };

  mesh_.tets.reserve(tets_.size());
  for (size_t tet = 0; tet < tets_.size(); ++tet) {
    std::array<int32_t, 4> ids;
    for (size_t k = 0; k < 4; ++k) {
      ids[k] = id_of(tets_[tet][k]);
      if (ids[k] < 0) {
        return absl::InvalidArgumentError(absl::StrCat("element ", tet_numbers_[tet],
                                                       " names node ", tets_[tet][k],
                                                       ", which the file does not hold"));
      }
    }
    mesh_.tets.push_back(ids);
  }
  if (std::all_of(mesh_.tet_regions.begin(), mesh_.tet_regions.end(),
                  [](int32_t region) { return region == 0; })) {
    mesh_.tet_regions.clear();
  }
  for (auto& [id, name] : region_names_) mesh_.regions.push_back({id, std::move(name)});
  TetMesh result = std::move(mesh_);
  *this = MeshBuilder();
  return result;
}

absl::Status RefuseElement(absl::string_view where, absl::string_view kind) {
  return absl::InvalidArgumentError(
      absl::StrCat(where, " is a ", kind,
                   "; only 4-node tetrahedra can be used: mesh the body with first-order "
                   "tetrahedra (Gmsh: no recombination, `-order 1`)"));
}

}  // namespace cleave
