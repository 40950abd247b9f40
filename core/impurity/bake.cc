#include "core/impurity/bake.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/impurity/falloff.h"
#include "core/impurity/fields.h"
#include "core/impurity/impurity_noise.h"
#include "core/impurity/surface_paint.h"
#include "core/mesh/blades.h"
#include "core/scene/impurity_blades.h"
#include "core/scene/impurity_places.h"
#include "core/scene/selection.h"

namespace cleave {
namespace {

using Edges = std::span<const std::array<int32_t, 2>>;

// What a source says, before node sets and blending.
struct Shares {
  std::vector<double> nodes;
  std::vector<double> edges;  // empty where the source marks none
  bool random = false;        // nodes have random numbers and are all covered
};

// Nonzero for the nodes of a named set.
std::vector<uint8_t> Chosen(const std::string& name, const Scene& scene, const TetMesh& mesh,
                            const RegionIndex& regions) {
  std::vector<uint8_t> chosen(mesh.rest_positions.size(), name.empty() ? 1 : 0);
  for (const NodeSet& set : scene.node_sets) {
    if (name.empty() || set.name != name) continue;
    for (const int32_t node : SelectNodes(set, mesh, regions))
      chosen[static_cast<size_t>(node)] = 1;
  }
  return chosen;
}

// Where no layer has been.
std::vector<double> BasePotencies(const Scene& scene, const TetMesh& mesh,
                                  const RegionIndex& regions) {
  const Impurities& impurities = *scene.impurities;
  std::vector<double> map = impurities.map;
  if (map.empty()) map.assign(mesh.rest_positions.size(), impurities.patches.empty() ? 1 : 0);
  for (const PotencyPatch& patch : impurities.patches) {
    const std::vector<uint8_t> chosen = Chosen(patch.node_set, scene, mesh, regions);
    for (size_t node = 0; node < map.size(); ++node)
      if (chosen[node] != 0) map[node] = patch.share;
  }
  for (size_t node = 0; node < map.size(); ++node) {
    map[node] *= impurities.potency;
    if (impurities.noise > 0) {
      map[node] += impurities.noise *
                   NodeNoise(scene.seed, static_cast<int32_t>(node), impurities.distribution);
    }
  }
  return map;
}

Shares BladeShares(const BladeSet& set, const ImpurityLayer& layer, const TetMesh& mesh,
                   Edges edges) {
  const Blades blades(set, mesh);
  const bool wide = std::any_of(set.segments.begin(), set.segments.end(), [](const auto& segment) {
    return segment.radii[0] > 0 || segment.radii[1] > 0;
  });
  Shares shares;
  shares.nodes.assign(mesh.rest_positions.size(), 0);
  std::vector<double> outside;
  if (wide || layer.falloff > 0) {
    outside = blades.DistancesOutside(layer.falloff);
    for (size_t node = 0; node < outside.size(); ++node)
      shares.nodes[node] = ShareAt(outside[node], layer);
  }
  const std::vector<uint8_t> crossed = blades.CrossedEdges(edges);
  shares.edges.assign(edges.size(), 0);
  for (size_t edge = 0; edge < edges.size(); ++edge) {
    const auto a = static_cast<size_t>(edges[edge][0]), b = static_cast<size_t>(edges[edge][1]);
    const bool in_groove = wide && outside[a] == 0 && outside[b] == 0;
    if (crossed[edge] == 0 && !in_groove) continue;
    shares.edges[edge] = 1;
    shares.nodes[a] = shares.nodes[b] = 1;
  }
  return shares;
}

Shares SharesOf(const ImpurityLayer& layer, uint64_t seed, const TetMesh& mesh, Edges edges) {
  if (const auto* values = std::get_if<NodeValues>(&layer.source)) return {values->shares, {}};
  if (const auto* noise = std::get_if<NoiseField>(&layer.source))
    return {NoiseValues(*noise, seed, mesh), {}, true};
  if (const auto* bands = std::get_if<BandField>(&layer.source))
    return {BandShares(*bands, layer, mesh), {}};
  if (const auto* pockets = std::get_if<PocketField>(&layer.source))
    return {PocketShares(*pockets, layer, seed, mesh), {}};
  if (const auto* strokes = std::get_if<Strokes>(&layer.source))
    return BladeShares(BladesOf(*strokes).blades, layer, mesh, edges);
  if (const auto* pattern = std::get_if<SegmentPattern>(&layer.source))
    return BladeShares(BladesOf(*pattern).blades, layer, mesh, edges);
  if (const auto* paint = std::get_if<SurfacePaint>(&layer.source))
    return {PaintShares(*paint, layer, mesh), {}};
  return {std::vector<double>(mesh.rest_positions.size(), 0), {}};
}

double BlendPotency(Blend blend, double below, double layer, double share, bool random) {
  const double value = layer * share;
  if (blend == Blend::kAdd) return below + value;
  if (blend == Blend::kMax) return std::max(below, value);
  return random ? value : (1 - share) * below + value;
}

// From a at share 0 to b at share 1; with an infinite one, infinite in between.
double Mix(double a, double b, double share) {
  if (share <= 0) return a;
  return share >= 1 ? b : (1 - share) * a + share * b;
}

double BlendFactor(Blend blend, double below, double layer, double share) {
  if (blend == Blend::kReplace) return Mix(below, layer, share);
  const double factor = Mix(1, layer, share);
  if (blend == Blend::kAdd) {
    // A cut and an unbreakable edge have no product: the upper one counts.
    const bool settles = factor == 0 || std::isinf(factor);
    return settles ? factor : below * factor;
  }
  const auto farness = [](double w) { return w < 1 ? 1 / w : w; };
  return farness(factor) >= farness(below) ? factor : below;
}

}  // namespace

BakedImpurities BakeImpurities(const Scene& scene, const TetMesh& mesh, Edges edges) {
  const Impurities& impurities = *scene.impurities;
  const RegionIndex regions(mesh);
  BakedImpurities baked;
  baked.potencies = BasePotencies(scene, mesh, regions);
  baked.touched_edges.assign(edges.size(), 0);
  if (WeakensEdges(impurities)) baked.edge_factors.assign(edges.size(), 1);
  for (size_t k = 0; k < impurities.layers.size(); ++k) {
    const ImpurityLayer& layer = impurities.layers[k];
    const Shares shares = SharesOf(layer, LayerSeed(scene, k), mesh, edges);
    const std::vector<uint8_t> chosen = Chosen(layer.node_set, scene, mesh, regions);
    if (layer.potency) {
      for (size_t node = 0; node < chosen.size(); ++node) {
        if (chosen[node] == 0 || (!shares.random && shares.nodes[node] == 0)) continue;
        baked.potencies[node] = BlendPotency(layer.blend, baked.potencies[node], *layer.potency,
                                             shares.nodes[node], shares.random);
      }
    }
    if (shares.random) continue;
    for (size_t edge = 0; edge < edges.size(); ++edge) {
      const auto a = static_cast<size_t>(edges[edge][0]), b = static_cast<size_t>(edges[edge][1]);
      if (chosen[a] == 0 || chosen[b] == 0) continue;
      const double share =
          shares.edges.empty() ? std::min(shares.nodes[a], shares.nodes[b]) : shares.edges[edge];
      if (share <= 0) continue;
      baked.touched_edges[edge] = 1;
      if (!layer.weakening) continue;
      double& factor = baked.edge_factors[edge];
      factor = BlendFactor(layer.blend, factor, *layer.weakening, share);
    }
  }
  return baked;
}

}  // namespace cleave
