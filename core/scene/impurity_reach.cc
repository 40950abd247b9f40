#include "core/scene/impurity_reach.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>
#include <variant>

#include "absl/strings/str_cat.h"
#include "core/mesh/blades.h"
#include "core/mesh/boundary_faces.h"
#include "core/mesh/surface_distance.h"
#include "core/scene/checker.h"
#include "core/scene/impurity_blades.h"
#include "core/scene/impurity_places.h"
#include "core/scene/selection.h"

namespace cleave {
namespace {

constexpr char kCrossesNone[] =
    "crosses no edge of the mesh: it misses the body, or is finer than the mesh";

// Nodes and edges of the mesh that a layer acts on, nonzero for each.
struct Reached {
  std::vector<uint8_t> nodes;
  std::vector<uint8_t> edges;
};

class ReachRules {
 public:
  ReachRules(const Scene& scene, size_t k, const TetMesh& mesh,
             std::span<const std::array<int32_t, 2>> edges, Faults& faults)
      : scene_(scene),
        k_(k),
        layer_(scene.impurities->layers[k]),
        field_(At("impurities.layers", k)),
        mesh_(mesh),
        edges_(edges),
        faults_(faults) {
    if (layer_.node_set.empty()) return;
    for (const NodeSet& set : scene.node_sets) {
      if (set.name == layer_.node_set) nodes_of_set_ = SelectNodes(set, mesh, RegionIndex(mesh));
    }
  }

  void operator()(std::monostate) {}
  void operator()(const NodeValues&) {}
  void operator()(const NoiseField&) {}
  void operator()(const BandField& bands) {
    CheckWithin(field_ + ".bands", DistancesOutside(bands, mesh_));
  }
  void operator()(const PocketField& pockets) {
    CheckWithin(field_ + ".pockets",
                DistancesOutside(pockets, layer_.falloff, LayerSeed(scene_, k_), mesh_));
  }
  void operator()(const Strokes& strokes) {
    CheckCurves(field_ + ".strokes", BladesOf(strokes), strokes.curves.size());
  }
  void operator()(const SegmentPattern& pattern) {
    CurveBlades cut = BladesOf(pattern);
    // All of a pattern counts as one curve.
    std::fill(cut.curve_of.begin(), cut.curve_of.end(), 0);
    CheckCurves(field_ + ".pattern", std::move(cut), std::nullopt);
  }
  void operator()(const SurfacePaint& paint) {
    const double reach = paint.depth + layer_.falloff;
    if (!paint.vertices.empty() && !MeetsBody(paint, reach)) {
      faults_.Error(field_ + ".paint",
                    absl::StrCat("its surface is farther than ", reach,
                                 " m, depth and falloff, from every node of the body; "
                                 "`unit_scale` says what its unit is"));
      return;
    }
    if (nodes_of_set_.empty()) return;
    std::vector<Vec3> places;
    for (const int32_t node : nodes_of_set_)
      places.push_back(mesh_.rest_positions[static_cast<size_t>(node)]);
    std::vector<std::array<int32_t, 3>> triangles = paint.triangles;
    if (paint.vertices.empty()) {
      std::vector<int32_t> nodes(mesh_.rest_positions.size());
      std::iota(nodes.begin(), nodes.end(), 0);
      for (const BoundaryFace& face : FindBoundaryFaces(mesh_, nodes))
        triangles.push_back(face.nodes);
    }
    if (!SurfaceReaches(paint.vertices.empty() ? mesh_.rest_positions : paint.vertices, triangles,
                        reach, places))
      RefuseSet();
  }

 private:
  // Of sources that have all nodes near a place.
  void CheckWithin(const std::string& field, const std::vector<double>& distances) {
    const Reached reached = Within(distances, layer_.falloff);
    if (!ActsOn(reached, false)) {
      faults_.Error(field, absl::StrCat("hold no ", layer_.potency ? "node" : "edge",
                                        " of the mesh: they miss the body, or are finer than the "
                                        "mesh"));
    } else if (!ActsOn(reached, true)) {
      RefuseSet();
    }
  }

  // Each of so many curves by its name, or all as one.
  void CheckCurves(const std::string& field, CurveBlades cut, std::optional<size_t> curves) {
    const bool wide = std::any_of(
        cut.blades.segments.begin(), cut.blades.segments.end(),
        [](const auto& segment) { return segment.radii[0] > 0 || segment.radii[1] > 0; });
    const Blades blades(std::move(cut.blades), mesh_);
    const std::vector<uint8_t> crosses =
        blades.CrossingCurves(edges_, cut.curve_of, curves.value_or(1));
    // A curve beside the body or within a cell may be wide.
    std::vector<uint8_t> holds(crosses.size(), 0);
    const bool all_cross = std::count(crosses.begin(), crosses.end(), 0) == 0;
    if (wide && !all_cross) holds = blades.HoldingCurves(cut.curve_of, crosses.size());
    bool all = true;
    for (size_t c = 0; c < crosses.size(); ++c) {
      if (crosses[c] != 0 || holds[c] != 0) continue;
      all = false;
      faults_.Error(curves ? At(field + ".curves", c) : field, kCrossesNone);
    }
    if (!all || (all_cross && nodes_of_set_.empty())) return;
    Reached reached{std::vector<uint8_t>(mesh_.rest_positions.size(), 0),
                    blades.CrossedEdges(edges_)};
    std::vector<double> outside;
    if (wide || layer_.falloff > 0) outside = blades.DistancesOutside(layer_.falloff);
    for (size_t node = 0; node < outside.size(); ++node)
      reached.nodes[node] = outside[node] <= 0 || outside[node] < layer_.falloff ? 1 : 0;
    for (size_t edge = 0; edge < edges_.size(); ++edge) {
      const auto a = static_cast<size_t>(edges_[edge][0]), b = static_cast<size_t>(edges_[edge][1]);
      if (wide && outside[a] <= 0 && outside[b] <= 0) reached.edges[edge] = 1;
      if (reached.edges[edge] != 0) reached.nodes[a] = reached.nodes[b] = 1;
    }
    if (ActsOn(reached, true)) return;
    if (!nodes_of_set_.empty()) return RefuseSet();
    faults_.Error(field, kCrossesNone);
  }

  // Nodes less than `reach` (m) outside, and the edges between them.
  Reached Within(const std::vector<double>& distances, double reach) const {
    Reached reached;
    for (const double distance : distances)
      reached.nodes.push_back(distance <= 0 || distance < reach ? 1 : 0);
    for (const auto& [a, b] : edges_) {
      reached.edges.push_back(reached.nodes[static_cast<size_t>(a)] &
                              reached.nodes[static_cast<size_t>(b)]);
    }
    return reached;
  }

  // A potency acts on nodes, a weakening on edges with both ends in the set.
  bool ActsOn(const Reached& reached, bool in_set) const {
    std::vector<uint8_t> chosen(mesh_.rest_positions.size(), 1);
    if (in_set && !nodes_of_set_.empty()) {
      std::fill(chosen.begin(), chosen.end(), 0);
      for (const int32_t node : nodes_of_set_) chosen[static_cast<size_t>(node)] = 1;
    }
    for (size_t node = 0; layer_.potency && node < chosen.size(); ++node)
      if (reached.nodes[node] != 0 && chosen[node] != 0) return true;
    for (size_t edge = 0; layer_.weakening && edge < edges_.size(); ++edge) {
      const auto& [a, b] = edges_[edge];
      if (reached.edges[edge] != 0 && chosen[static_cast<size_t>(a)] != 0 &&
          chosen[static_cast<size_t>(b)] != 0)
        return true;
    }
    return false;
  }

  bool MeetsBody(const SurfacePaint& paint, double reach) const {
    for (size_t axis = 0; axis < 3; ++axis) {
      const auto less = [axis](const Vec3& a, const Vec3& b) { return a[axis] < b[axis]; };
      const auto [low, high] =
          std::minmax_element(mesh_.rest_positions.begin(), mesh_.rest_positions.end(), less);
      const auto [first, last] =
          std::minmax_element(paint.vertices.begin(), paint.vertices.end(), less);
      if ((*first)[axis] - reach > (*high)[axis] || (*last)[axis] + reach < (*low)[axis])
        return false;
    }
    return SurfaceReaches(paint.vertices, paint.triangles, reach, mesh_.rest_positions);
  }

  void RefuseSet() {
    faults_.Error(field_ + ".node_set",
                  absl::StrCat("\"", layer_.node_set, "\" holds nothing that the layer acts on"));
  }

  const Scene& scene_;
  const size_t k_;
  const ImpurityLayer& layer_;
  const std::string field_;
  const TetMesh& mesh_;
  const std::span<const std::array<int32_t, 2>> edges_;
  Faults& faults_;
  std::vector<int32_t> nodes_of_set_;  // empty: the layer has no set, or one that is refused
};

}  // namespace

std::vector<std::array<int32_t, 2>> EdgesOfTets(const TetMesh& mesh) {
  std::vector<std::array<int32_t, 2>> edges;
  edges.reserve(6 * mesh.tets.size());
  for (const auto& tet : mesh.tets) {
    for (const auto& [i, j] : kTetEdges)
      edges.push_back({tet[static_cast<size_t>(i)], tet[static_cast<size_t>(j)]});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

void CheckReach(const Scene& scene, size_t k, const TetMesh& mesh,
                std::span<const std::array<int32_t, 2>> edges, Faults& faults) {
  std::visit(ReachRules(scene, k, mesh, edges, faults), scene.impurities->layers[k].source);
}

}  // namespace cleave
