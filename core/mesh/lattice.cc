#include "core/mesh/lattice.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/counter_rng.h"
#include "core/mesh/tet_geometry.h"

namespace cleave {
namespace {

// A number in (-1, 1) for one coordinate of a node.
double Offset(uint32_t seed, int64_t node, uint64_t axis) {
  return 2 * UniformDraw(seed, RandomStream::kMeshJitter, static_cast<uint64_t>(node), axis) - 1;
}

void OrientAll(TetMesh& mesh) {
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
    auto& nodes = mesh.tets[static_cast<size_t>(tet)];
    if (SignedVolume(CornersOf(mesh, tet)) < 0) std::swap(nodes[2], nodes[3]);
  }
}

// Moves nodes to place(node, share of their full offset): the whole of it where every tet round a
// node keeps 30 % of its volume, else a half, a quarter and so on. Precondition: the mesh stands
// at place(node, 0) with positive volumes.
template <typename Place>
void Jitter(TetMesh& mesh, const Place& place) {
  constexpr double kLeastVolume = 0.3;
  constexpr int kMostHalvings = 12;
  std::vector<double> rest_volumes(mesh.tets.size());
  for (int64_t tet = 0; tet < mesh.tet_count(); ++tet)
    rest_volumes[static_cast<size_t>(tet)] = SignedVolume(CornersOf(mesh, tet));
  std::vector<double> shares(mesh.rest_positions.size(), 1);
  std::vector<bool> crushed(shares.size());
  for (int halving = 0; halving <= kMostHalvings; ++halving) {
    for (size_t node = 0; node < shares.size(); ++node)
      mesh.rest_positions[node] = place(static_cast<int64_t>(node), shares[node]);
    crushed.assign(shares.size(), false);
    bool any = false;
    for (int64_t tet = 0; tet < mesh.tet_count(); ++tet) {
      const auto index = static_cast<size_t>(tet);
      if (SignedVolume(CornersOf(mesh, tet)) >= kLeastVolume * rest_volumes[index]) continue;
      any = true;
      for (const int32_t node : mesh.tets[index]) crushed[static_cast<size_t>(node)] = true;
    }
    if (!any) return;
    for (size_t node = 0; node < shares.size(); ++node) {
      // The last round puts what still fails back where it was.
      if (crushed[node]) shares[node] = halving + 1 < kMostHalvings ? shares[node] / 2 : 0;
    }
  }
}

// A cross-section of a round body.
struct RingPlan {
  std::vector<double> radii;                      // a node each, m
  std::vector<double> angles;                     // rad
  std::vector<std::array<int32_t, 3>> triangles;  // node ids
  int32_t inner_rim = 0;                          // nodes [0, inner_rim) lie on the inner radius
  int32_t outer_rim = 0;                          // nodes [outer_rim, end) lie on the outer radius
};

// Adds a ring of `count` nodes, the first at `phase` steps, and returns its first id.
int32_t AddRing(RingPlan& plan, double radius, int32_t count, double phase) {
  const auto first = static_cast<int32_t>(plan.radii.size());
  for (int32_t node = 0; node < count; ++node) {
    plan.radii.push_back(radius);
    plan.angles.push_back(2 * std::numbers::pi * (node + phase) / count);
  }
  return first;
}

// Fills the band between two rings with triangles, always stepping along the ring whose next node
// has the smaller angle.
void ZipRings(RingPlan& plan, int32_t inner, int32_t inner_count, double inner_phase, int32_t outer,
              int32_t outer_count, double outer_phase) {
  for (int32_t i = 0, j = 0; i < inner_count || j < outer_count;) {
    const int32_t inner_now = inner + i % inner_count;
    const int32_t outer_now = outer + j % outer_count;
    const double inner_next = (i + 1 + inner_phase) / inner_count;
    const double outer_next = (j + 1 + outer_phase) / outer_count;
    if (i == inner_count || (j < outer_count && outer_next <= inner_next)) {
      plan.triangles.push_back({inner_now, outer_now, outer + (j + 1) % outer_count});
      ++j;
    } else {
      plan.triangles.push_back({inner_now, outer_now, inner + (i + 1) % inner_count});
      ++i;
    }
  }
}

RingPlan PlanRings(const Body& body, double cell_size) {
  RingPlan plan;
  if (body.inner_radius == 0) {
    const auto rings = static_cast<int32_t>(CellsAlong(body.outer_radius, cell_size, 1));
    AddRing(plan, 0, 1, 0);
    for (int32_t ring = 1; ring <= rings; ++ring) {
      const int32_t inner = ring == 1 ? 0 : plan.outer_rim;
      const int32_t inner_count = ring == 1 ? 1 : 6 * (ring - 1);
      plan.outer_rim = AddRing(plan, body.outer_radius * ring / rings, 6 * ring, 0);
      if (ring == 1) {
        for (int32_t k = 0; k < 6; ++k)
          plan.triangles.push_back({0, plan.outer_rim + k, plan.outer_rim + (k + 1) % 6});
      } else {
        ZipRings(plan, inner, inner_count, 0, plan.outer_rim, 6 * ring, 0);
      }
    }
    return plan;
  }
  const double wall = body.outer_radius - body.inner_radius;
  const auto rings = static_cast<int32_t>(CellsAlong(wall, cell_size, 1));
  int32_t previous_count = 0;
  double previous_phase = 0;
  for (int32_t ring = 0; ring <= rings; ++ring) {
    const double radius =
        ring == rings ? body.outer_radius : body.inner_radius + wall * ring / rings;
    const auto count =
        static_cast<int32_t>(CellsAlong(2 * std::numbers::pi * radius, cell_size, 6));
    const double phase = ring % 2 == 0 ? 0 : 0.5;
    const int32_t previous = plan.outer_rim;
    plan.outer_rim = AddRing(plan, radius, count, phase);
    if (ring == 0) {
      plan.inner_rim = count;
    } else {
      ZipRings(plan, previous, previous_count, previous_phase, plan.outer_rim, count, phase);
    }
    previous_count = count;
    previous_phase = phase;
  }
  return plan;
}

}  // namespace

TetMesh BoxLattice(const Body& body, const MeshResolution& resolution) {
  std::array<int64_t, 3> cells;
  for (size_t axis = 0; axis < 3; ++axis)
    cells[axis] = CellsAlong(body.size[axis], resolution.cell_size, 1);
  const auto id = [&](int64_t i, int64_t j, int64_t k) {
    return static_cast<int32_t>((i * (cells[1] + 1) + j) * (cells[2] + 1) + k);
  };
  const auto place = [&](int64_t node, double share) {
    const std::array<int64_t, 3> index = {node / ((cells[1] + 1) * (cells[2] + 1)),
                                          node / (cells[2] + 1) % (cells[1] + 1),
                                          node % (cells[2] + 1)};
    Vec3 position;
    for (size_t axis = 0; axis < 3; ++axis) {
      double at = static_cast<double>(index[axis]);
      if (index[axis] > 0 && index[axis] < cells[axis] && share > 0)
        at += share * resolution.jitter * Offset(resolution.seed, node, axis);
      position[axis] = body.size[axis] * (at / static_cast<double>(cells[axis]));
    }
    return position;
  };

  TetMesh mesh;
  const int64_t nodes = (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1);
  mesh.rest_positions.reserve(static_cast<size_t>(nodes));
  for (int64_t node = 0; node < nodes; ++node) mesh.rest_positions.push_back(place(node, 0));
  mesh.tets.reserve(static_cast<size_t>(6 * cells[0] * cells[1] * cells[2]));
  for (int64_t i = 0; i < cells[0]; ++i) {
    for (int64_t j = 0; j < cells[1]; ++j) {
      for (int64_t k = 0; k < cells[2]; ++k) {
        // One tet an order of the axes: from the cell's first corner to its last, a step along
        // each axis in turn.
        std::array<size_t, 3> axes = {0, 1, 2};
        do {
          std::array<int64_t, 3> corner = {i, j, k};
          std::array<int32_t, 4> tet;
          tet[0] = id(i, j, k);
          for (size_t step = 0; step < 3; ++step) {
            ++corner[axes[step]];
            tet[step + 1] = id(corner[0], corner[1], corner[2]);
          }
          mesh.tets.push_back(tet);
        } while (std::next_permutation(axes.begin(), axes.end()));
      }
    }
  }
  OrientAll(mesh);
  if (resolution.jitter > 0) Jitter(mesh, place);
  return mesh;
}

TetMesh RingLattice(const Body& body, const MeshResolution& resolution) {
  const RingPlan plan = PlanRings(body, resolution.cell_size);
  const auto plan_nodes = static_cast<int64_t>(plan.radii.size());
  const int64_t layers = CellsAlong(body.size[2], resolution.cell_size, body.min_layers);
  // Cells are no longer than asked for in the plane, and may be thinner: a node's offset is bounded
  // by the smaller.
  const double wall = body.outer_radius - body.inner_radius;
  const double ring_width = wall / static_cast<double>(CellsAlong(wall, resolution.cell_size, 1));
  const double reach = resolution.jitter * std::min(ring_width, resolution.cell_size);

  const auto place = [&](int64_t node, double share) -> Vec3 {
    const auto in_plan = static_cast<size_t>(node % plan_nodes);
    const int64_t layer = node / plan_nodes;
    const double radius = plan.radii[in_plan];
    double angle = plan.angles[in_plan];
    double height = static_cast<double>(layer);
    Vec3 moved{0, 0, 0};
    if (share > 0) {
      if (layer > 0 && layer < layers)
        height += share * resolution.jitter * Offset(resolution.seed, node, 2);
      const auto plan_id = static_cast<int32_t>(in_plan);
      if (plan_id < plan.inner_rim || plan_id >= plan.outer_rim) {
        angle += share * reach / radius * Offset(resolution.seed, node, 0);
      } else {
        moved[0] = share * reach * Offset(resolution.seed, node, 0);
        moved[1] = share * reach * Offset(resolution.seed, node, 1);
      }
    }
    return {radius * std::cos(angle) + moved[0], radius * std::sin(angle) + moved[1],
            body.size[2] * (height / static_cast<double>(layers))};
  };

  TetMesh mesh;
  mesh.rest_positions.reserve(static_cast<size_t>(plan_nodes * (layers + 1)));
  for (int64_t node = 0; node < plan_nodes * (layers + 1); ++node)
    mesh.rest_positions.push_back(place(node, 0));
  mesh.tets.reserve(3 * plan.triangles.size() * static_cast<size_t>(layers));
  for (int64_t layer = 0; layer < layers; ++layer) {
    const auto bottom = static_cast<int32_t>(layer * plan_nodes);
    const auto top = static_cast<int32_t>((layer + 1) * plan_nodes);
    // Each upright quad is cut from the node of lower rank below to that of higher rank above.
    // Ranks are random, so that the cuts run in no common direction.
    const auto rank = [&](int32_t node) {
      return std::pair(UniformDraw(resolution.seed, RandomStream::kMeshJitter,
                                   static_cast<uint64_t>(bottom + node), 3),
                       node);
    };
    for (std::array<int32_t, 3> t : plan.triangles) {
      std::sort(t.begin(), t.end(), [&](int32_t a, int32_t b) { return rank(a) < rank(b); });
      mesh.tets.push_back({bottom + t[0], bottom + t[1], bottom + t[2], top + t[2]});
      mesh.tets.push_back({bottom + t[0], bottom + t[1], top + t[1], top + t[2]});
      mesh.tets.push_back({bottom + t[0], top + t[0], top + t[1], top + t[2]});
    }
  }
  OrientAll(mesh);
  if (resolution.jitter > 0) Jitter(mesh, place);
  return mesh;
}

}  // namespace cleave
