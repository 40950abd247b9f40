#include "core/surface/fragments.h"

#include <algorithm>
#include <numeric>

#include "core/damage/components.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {

Fragments FindFragments(const TetMesh& mesh, const Incidence& incidence,
                        std::span<const int32_t> broken_edges) {
  std::vector<uint8_t> broken(incidence.edges.size(), 0);
  for (const int32_t edge : broken_edges) broken[static_cast<size_t>(edge)] = 1;
  Fragments fragments;
  const int32_t count = LabelComponents(incidence, broken, fragments.node_fragments);
  fragments.volumes.assign(static_cast<size_t>(count), 0.0);
  fragments.node_counts.assign(static_cast<size_t>(count), 0);
  for (const int32_t fragment : fragments.node_fragments) {
    if (fragment >= 0) ++fragments.node_counts[static_cast<size_t>(fragment)];
  }
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const double quarter = SignedVolume(CornersOf(mesh, tet)) / 4;
    for (const int32_t node : mesh.tets[static_cast<size_t>(tet)]) {
      const int32_t fragment = fragments.node_fragments[static_cast<size_t>(node)];
      fragments.volumes[static_cast<size_t>(fragment)] += quarter;
    }
  }
  return fragments;
}

int32_t CountPieces(std::span<const double> sizes, double smallest_share) {
  const double smallest = smallest_share * std::accumulate(sizes.begin(), sizes.end(), 0.0);
  return static_cast<int32_t>(
      std::count_if(sizes.begin(), sizes.end(), [&](double size) { return size >= smallest; }));
}

}  // namespace cleave
