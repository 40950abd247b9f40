#include "client/io/bake/baked_surface.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

#include "absl/strings/str_cat.h"
#include "client/io/export/surface_materials.h"
#include "client/io/series/frame_check.h"
#include "core/base/status.h"
#include "core/mesh/tet_geometry.h"
#include "core/surface/embedded_mesh.h"
#include "core/surface/faces.h"
#include "core/surface/fans.h"
#include "core/surface/shared_edges.h"
#include "core/surface/visible_surface.h"

namespace cleave {
namespace {

std::vector<BakedPiece> FindPieces(const TetMesh& mesh, const NamedPieces& named) {
  std::vector<BakedPiece> pieces(static_cast<size_t>(named.count()));
  const std::vector<int32_t> first_nodes = named.FirstNodes();
  for (int32_t piece = 0; piece < named.count(); ++piece) {
    pieces[static_cast<size_t>(piece)].smallest_node = first_nodes[static_cast<size_t>(piece)];
    pieces[static_cast<size_t>(piece)].volume = named.volume(piece);
  }
  for (int32_t node = 0; node < mesh.node_count(); ++node) {
    const int32_t piece = named.piece_of(node);
    if (piece >= 0) ++pieces[static_cast<size_t>(piece)].nodes;
  }
  std::vector<double> volumes(pieces.size(), 0.0);
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    const double quarter = SignedVolume(CornersOf(mesh, tet)) / 4;
    for (const int32_t node : mesh.tets[static_cast<size_t>(tet)]) {
      const auto piece = static_cast<size_t>(named.piece_of(node));
      volumes[piece] += quarter;
      for (size_t k = 0; k < 3; ++k) {
        pieces[piece].center[k] += quarter * mesh.rest_positions[static_cast<size_t>(node)][k];
      }
    }
  }
  for (size_t piece = 0; piece < pieces.size(); ++piece) {
    for (double& coordinate : pieces[piece].center) coordinate /= volumes[piece];
  }
  return pieces;
}

// The tets that meet where a point lies, all of whose nodes they have.
void AppendTetsOf(const TetMesh& mesh, const Incidence& incidence, const SurfacePoint& point,
                  std::vector<int32_t>& tets) {
  for (const int32_t tet : incidence.node_tets[point.nodes[0]]) {
    const std::array<int32_t, 4>& corners = mesh.tets[static_cast<size_t>(tet)];
    bool has_all = true;
    for (size_t i = 1; i < point.node_count; ++i) {
      has_all &= std::find(corners.begin(), corners.end(), point.nodes[i]) != corners.end();
    }
    if (has_all) tets.push_back(tet);
  }
}

}  // namespace

BakedSurface BakeSurface(const TetMesh& mesh, const Incidence& incidence, const NamedPieces& pieces,
                         std::span<const int32_t> broken_edges, const RenderMesh* render_mesh) {
  BakedSurface surface;
  const Faces faces = BuildFaces(mesh);
  if (render_mesh != nullptr) {
    EmbeddedMesh embedded(mesh, incidence, faces, *render_mesh);
    embedded.Break(broken_edges, pieces);
    surface.topology = embedded.topology();
    surface.uvs = embedded.uvs();
    surface.gaps = embedded.gaps();
  } else {
    surface.topology = ExtractSurface(mesh, incidence, faces, broken_edges, SurfaceOptions{});
  }
  std::vector<int32_t> no_sources;
  SeparateSharedEdges(surface.topology, surface.uvs, no_sources);
  SeparateFans(surface.topology);
  surface.pieces = FindPieces(mesh, pieces);
  const SurfaceTopology& topology = surface.topology;
  surface.point_pieces.assign(topology.points.size(), -1);
  for (size_t i = 0; i < topology.triangles.size(); ++i) {
    const int32_t piece = pieces.piece_of(topology.nodes[i]);
    surface.triangle_pieces.push_back(piece);
    surface.triangle_regions.push_back(mesh.region_of(topology.tets[i]));
    for (const int32_t point : topology.triangles[i]) {
      surface.point_pieces[static_cast<size_t>(point)] = piece;
    }
  }
  return surface;
}

std::array<float, 2> BakedSurface::UvAt(size_t triangle, size_t corner) const {
  if (!uvs.empty() && topology.inside[triangle] == 0) return uvs[triangle][corner];
  const auto& points = topology.triangles[triangle];
  const auto rest = [&](size_t k) { return topology.points[static_cast<size_t>(points[k])].rest; };
  const auto [u, v] = RestUv(rest(corner), FacedAxis(rest(0), rest(1), rest(2)));
  return {static_cast<float>(u), static_cast<float>(v)};
}

BakedMotion::BakedMotion(const TetMesh& mesh, const Incidence& incidence,
                         const BakedSurface& surface, std::span<const int32_t> last_broken_edges)
    : mesh_(mesh),
      incidence_(incidence),
      surface_(surface),
      last_broken_edges_(last_broken_edges),
      moved_(mesh, incidence) {
  now_.points = surface.topology.points;
  split_tets_.offsets.push_back(0);
  for (size_t i = 0; i < now_.points.size(); ++i) {
    if (now_.points[i].owned_by_all()) continue;
    split_points_.push_back(static_cast<int32_t>(i));
    AppendTetsOf(mesh, incidence, now_.points[i], split_tets_.items);
    split_tets_.offsets.push_back(static_cast<int32_t>(split_tets_.items.size()));
  }
}

uint8_t BakedMotion::OwnersOf(const SurfacePoint& point, std::span<const int32_t> tets) const {
  std::array<size_t, 4> group{0, 1, 2, 3};  // of each node of the point
  for (const int32_t tet : tets) {
    const std::array<int32_t, 4>& corners = mesh_.tets[static_cast<size_t>(tet)];
    const VertexGroups& groups = kVertexGroups[now_.tet_masks[static_cast<size_t>(tet)]];
    std::array<int8_t, 4> in_tet{};
    for (size_t i = 0; i < point.node_count; ++i) {
      const auto at = std::find(corners.begin(), corners.end(), point.nodes[i]) - corners.begin();
      in_tet[i] = groups.group[static_cast<size_t>(at)];
    }
    for (size_t i = 0; i < point.node_count; ++i) {
      for (size_t j = i + 1; j < point.node_count; ++j) {
        if (in_tet[i] != in_tet[j] || group[i] == group[j]) continue;
        const size_t old = group[j];
        for (size_t& each : group) {
          if (each == old) each = group[i];
        }
      }
    }
  }
  uint8_t owners = 0;
  for (size_t i = 0; i < point.node_count; ++i) {
    for (size_t j = 0; j < point.node_count; ++j) {
      if ((point.owners >> j & 1) != 0 && group[i] == group[j]) {
        owners |= static_cast<uint8_t>(1u << i);
      }
    }
  }
  return owners;
}

absl::Status BakedMotion::Advance(const Frame& frame) {
  CLEAVE_RETURN_IF_ERROR(CheckFrame(frame, mesh_, incidence_.edge_count(),
                                    started_ ? time_ : -std::numeric_limits<double>::infinity()));
  const bool changed = !started_ || frame.broken_edges != broken_edges_;
  if (changed) {
    if (!std::includes(last_broken_edges_.begin(), last_broken_edges_.end(),
                       frame.broken_edges.begin(), frame.broken_edges.end())) {
      return absl::InvalidArgumentError(
          absl::StrCat("broken_edges: frame ", frame.frame,
                       " has one that is whole in the last frame, whose surface is baked"));
    }
    broken_edges_ = frame.broken_edges;
    now_.tet_masks = TetEdgeMasks(incidence_, broken_edges_);
    for (size_t i = 0; i < split_points_.size(); ++i) {
      const auto id = static_cast<size_t>(split_points_[i]);
      now_.points[id].owners =
          OwnersOf(surface_.topology.points[id], split_tets_[static_cast<int64_t>(i)]);
    }
  }
  moved_.Advance(now_, changed, frame.positions, frame.time, true);
  time_ = frame.time;
  started_ = true;
  return absl::OkStatus();
}

}  // namespace cleave
