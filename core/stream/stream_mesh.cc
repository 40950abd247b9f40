#include "core/stream/stream_mesh.h"

#include <cstddef>

#include "core/mesh/tet_mesh.h"
#include "core/stream/edge_lookup.h"
#include "core/stream/stream_header.h"

namespace cleave {
namespace {

// That each tet has its edges.
absl::Status CheckTets(const StreamHeader& header, const StreamMesh& mesh) {
  const EdgeLookup lookup(mesh.edges, mesh.rest_positions.size());
  bool fit = mesh.tets.size() == header.tet_count;
  for (size_t tet = 0; fit && tet < mesh.tets.size(); ++tet) {
    for (const int32_t node : mesh.tets[tet]) {
      fit &= node >= 0 && static_cast<uint64_t>(node) < header.node_count;
    }
    for (size_t k = 0; fit && k < kTetEdges.size(); ++k) {
      fit = lookup.Find(mesh.tets[tet][static_cast<size_t>(kTetEdges[k][0])],
                        mesh.tets[tet][static_cast<size_t>(kTetEdges[k][1])]) >= 0;
    }
  }
  return fit ? absl::OkStatus()
             : absl::FailedPreconditionError("tets are not those of the stream's mesh");
}

}  // namespace

absl::Status CheckStreamMesh(const StreamHeader& header, const StreamMesh& mesh) {
  if (mesh.rest_positions.size() != header.node_count ||
      RestPositionsSha256(mesh.rest_positions) != header.rest_sha256) {
    return absl::FailedPreconditionError("rest positions are not those of the stream's mesh");
  }
  if (header.predictor_id != kPredictorInterpolation) return absl::OkStatus();
  bool fits = mesh.edges.size() == header.edge_count;
  for (size_t edge = 0; fits && edge < mesh.edges.size(); ++edge) {
    const std::array<int32_t, 2>& ends = mesh.edges[edge];
    fits = ends[0] >= 0 && ends[0] < ends[1] &&
           static_cast<uint64_t>(ends[1]) < header.node_count &&
           (edge == 0 || mesh.edges[edge - 1] < ends);
  }
  if (!fits) return absl::FailedPreconditionError("edges are not those of the stream's mesh");
  return header.is_surface() ? CheckTets(header, mesh) : absl::OkStatus();
}

}  // namespace cleave
