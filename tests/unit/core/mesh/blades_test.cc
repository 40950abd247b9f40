#include "core/mesh/blades.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/mesh/boundary_faces.h"
#include "core/mesh/incidence.h"
#include "core/mesh/projected_side.h"
#include "core/mesh/surface_depth.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

// Whole numbers in [-most, most], as doubles.
class Draws {
 public:
  explicit Draws(uint64_t seed) : seed_(seed) {}
  double Whole(int most) {
    return std::floor(UniformDraw(seed_, RandomStream::kMeshJitter, next_++, 0) * (2 * most + 1)) -
           most;
  }
  Vec3 Point(int most) { return {Whole(most), Whole(most), Whole(most)}; }

 private:
  const uint64_t seed_;
  uint64_t next_ = 0;
};

// Nodes on whole coordinates round the origin, 16 apart, each off by up to `jitter`.
TetMesh WholeMesh(int jitter, uint64_t seed) {
  TetMesh mesh = KuhnBox({4, 4, 3}, {64, 64, 48}, {-32, -32, -24});
  Draws draws(seed);
  for (Vec3& point : mesh.rest_positions)
    for (double& x : point) x += draws.Whole(jitter);
  return mesh;
}

using Whole = int64_t;
using WholeVec = std::array<Whole, 3>;
WholeVec ToWhole(const Vec3& v) {
  return {static_cast<Whole>(v[0]), static_cast<Whole>(v[1]), static_cast<Whole>(v[2])};
}
WholeVec Minus(const WholeVec& a, const WholeVec& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
Whole Determinant(const WholeVec& a, const WholeVec& b, const WholeVec& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

// Solves a + lambda (b - a) = p + s (q - p) + t d by Cramer's rule in whole numbers; the crossing
// counts for s in [0, 1] and lambda in [0, 1], its ends by which side the edge lies on.
bool CrossesByBruteForce(const WholeVec& p, const WholeVec& q, const WholeVec& d, const WholeVec& a,
                         const WholeVec& b) {
  const WholeVec edge = Minus(b, a), blade = Minus(p, q), back = {-d[0], -d[1], -d[2]};
  const WholeVec right = Minus(p, a);
  Whole whole = Determinant(edge, blade, back);
  if (whole == 0) return false;  // parallel
  Whole lambda = Determinant(right, blade, back), s = Determinant(edge, right, back);
  if (whole < 0) {
    whole = -whole;
    lambda = -lambda;
    s = -s;
  }
  if (s < 0 || s > whole || lambda < 0 || lambda > whole) return false;
  const WholeVec along = Minus(q, p);
  if (lambda == 0) return Determinant(along, d, Minus(b, p)) < 0;
  if (lambda == whole) return Determinant(along, d, Minus(a, p)) < 0;
  return true;
}

TEST(Blades, CrossExactlyTheEdgesThatABruteForceTestOfWholeNumbersFinds) {
  int64_t crossings = 0, through_nodes = 0;
  for (uint64_t seed = 0; seed < 60; ++seed) {
    // Every third mesh is a lattice, whose nodes and edges lie on many of these blades.
    const TetMesh mesh = WholeMesh(seed % 3 == 0 ? 0 : 3, seed);
    const Incidence incidence = BuildIncidence(mesh);
    Draws draws(1000 + seed);
    BladeSet set;
    do {
      set.direction = draws.Point(seed % 2 == 0 ? 1 : 7);
    } while (set.direction == Vec3{0, 0, 0});
    for (int k = 0; k < 12; ++k) {
      BladeSegment& segment = set.segments.emplace_back();
      segment.start = draws.Point(40);
      segment.end = draws.Point(40);
      if (k % 2 == 0) {  // onto the lattice
        for (double& x : segment.start) x = 16 * std::round(x / 16);
        for (double& x : segment.end) x = 16 * std::round(x / 16);
      }
    }
    const Blades blades(set, mesh);
    const std::vector<uint8_t> crossed = blades.CrossedEdges(incidence.edges);
    std::vector<int32_t> curve_of(set.segments.size());
    std::iota(curve_of.begin(), curve_of.end(), 0);
    const std::vector<uint8_t> hits =
        blades.CrossingCurves(incidence.edges, curve_of, curve_of.size());
    std::vector<uint8_t> expected_hits(set.segments.size(), 0);
    for (size_t e = 0; e < incidence.edges.size(); ++e) {
      const auto [a, b] = incidence.edges[e];
      bool expected = false;
      for (size_t k = 0; k < set.segments.size(); ++k) {
        const WholeVec p = ToWhole(set.segments[k].start), q = ToWhole(set.segments[k].end);
        const WholeVec first = ToWhole(mesh.rest_positions[static_cast<size_t>(a)]);
        const WholeVec second = ToWhole(mesh.rest_positions[static_cast<size_t>(b)]);
        const WholeVec direction = ToWhole(set.direction);
        through_nodes += Determinant(Minus(q, p), direction, Minus(first, p)) == 0;
        if (!CrossesByBruteForce(p, q, direction, first, second)) continue;
        expected = true;
        expected_hits[k] = 1;
      }
      ASSERT_EQ(crossed[e] != 0, expected) << "seed " << seed << ", edge " << a << "-" << b;
      crossings += crossed[e];
    }
    ASSERT_EQ(hits, expected_hits) << "seed " << seed;
  }
  // The comparison had something to compare.
  EXPECT_GT(crossings, 3000);
  EXPECT_GT(through_nodes, 3000);
}

TEST(Blades, EndAtTheirDepth) {
  const TetMesh mesh = WholeMesh(0, 0);  // its top is at z = 24
  const Incidence incidence = BuildIncidence(mesh);
  for (const double depth : {0.3, 7.1, 16.7, 33.3, 47.9}) {
    BladeSet set;
    set.segments = {{{-19, -40, 1000}, {13, 50, -3}}, {{-40, 3, 0}, {40, 6, 0}}};
    set.direction = {0, 0, -3};
    set.depth = depth;
    const std::vector<uint8_t> crossed = Blades(set, mesh).CrossedEdges(incidence.edges);
    int count = 0;
    for (size_t e = 0; e < incidence.edges.size(); ++e) {
      const auto [a, b] = incidence.edges[e];
      const Eigen::Vector3d first(mesh.rest_positions[static_cast<size_t>(a)].data());
      const Eigen::Vector3d second(mesh.rest_positions[static_cast<size_t>(b)].data());
      bool expected = false;
      for (const BladeSegment& blade : set.segments) {
        const Eigen::Vector3d p(blade.start.data()), q(blade.end.data());
        const Eigen::Vector3d normal = (q - p).cross(Eigen::Vector3d(0, 0, 1));
        const double share = normal.dot(p - first) / normal.dot(second - first);
        const double z = first[2] + share * (second[2] - first[2]);
        expected =
            expected || (CrossesByBruteForce(ToWhole(blade.start), ToWhole(blade.end), {0, 0, -3},
                                             ToWhole({first[0], first[1], first[2]}),
                                             ToWhole({second[0], second[1], second[2]})) &&
                         24 - z <= depth);
      }
      ASSERT_EQ(crossed[e] != 0, expected) << depth << ": " << a << "-" << b;
      count += expected;
    }
    EXPECT_GT(count, 10);
  }
}

// A motion that doubles represent: axes change places or sign, then a shift.
struct ExactMotion {
  std::array<size_t, 3> from;
  std::array<double, 3> sign;
  Vec3 shift;

  Vec3 Turn(const Vec3& v) const {
    return {sign[0] * v[from[0]], sign[1] * v[from[1]], sign[2] * v[from[2]]};
  }
  Vec3 Move(const Vec3& v) const {
    const Vec3 turned = Turn(v);
    return {turned[0] + shift[0], turned[1] + shift[1], turned[2] + shift[2]};
  }
};
const ExactMotion kMotions[] = {
    {{1, 0, 2}, {1, -1, 1}, {256, -64, 8.5}},
    {{0, 2, 1}, {1, -1, 1}, {0, 0, 0.25}},
    {{2, 0, 1}, {1, 1, 1}, {-1024, 32, 3}},
    {{0, 1, 2}, {-1, -1, 1}, {0.125, 16, 16}},
};

TEST(Blades, MarkTheSameEdgesWhenTheyMoveAndTurnWithTheBody) {
  for (uint64_t seed = 0; seed < 12; ++seed) {
    const TetMesh mesh = WholeMesh(seed % 2 == 0 ? 0 : 3, seed);
    const Incidence incidence = BuildIncidence(mesh);
    Draws draws(seed);
    BladeSet set;
    set.direction = {draws.Whole(2), draws.Whole(2), -3};
    set.depth = 21.3;
    for (int k = 0; k < 8; ++k) set.segments.push_back({draws.Point(32), draws.Point(32), {2, 3}});
    const Blades blades(set, mesh);
    const auto crossed = blades.CrossedEdges(incidence.edges);
    const auto outside = blades.DistancesOutside(6);
    EXPECT_GT(std::count(crossed.begin(), crossed.end(), 1), 20);
    for (const ExactMotion& motion : kMotions) {
      TetMesh moved = mesh;
      for (Vec3& point : moved.rest_positions) point = motion.Move(point);
      BladeSet with_it = set;
      with_it.direction = motion.Turn(set.direction);
      for (BladeSegment& segment : with_it.segments) {
        segment.start = motion.Move(segment.start);
        segment.end = motion.Move(segment.end);
      }
      const Blades other(with_it, moved);
      EXPECT_EQ(other.CrossedEdges(incidence.edges), crossed) << seed;
      const auto distances = other.DistancesOutside(6);
      for (size_t node = 0; node < outside.size(); ++node) {
        if (std::isinf(outside[node])) {
          EXPECT_GT(distances[node], 6 - 1e-9);
        } else {
          EXPECT_NEAR(distances[node], outside[node], 1e-9);
        }
      }
    }
  }
}

TEST(Blades, ThroughNodesCutOneLayerOfEdges) {
  const TetMesh mesh = KuhnBox({4, 3, 3}, {4, 3, 3});
  const Incidence incidence = BuildIncidence(mesh);
  BladeSet set;
  set.segments = {{{2, -1, 0}, {2, 9, 0}}};
  const auto crossed = Blades(set, mesh).CrossedEdges(incidence.edges);
  for (size_t e = 0; e < incidence.edges.size(); ++e) {
    const double x = mesh.rest_positions[static_cast<size_t>(incidence.edges[e][0])][0];
    const double y = mesh.rest_positions[static_cast<size_t>(incidence.edges[e][1])][0];
    // Seen along -z with y ahead, the left is -x: what only touches from there is not crossed.
    EXPECT_EQ(crossed[e] != 0, std::min(x, y) == 2 && std::max(x, y) == 3);
  }
}

TEST(Blades, DistancesAreThoseToSegmentsAcrossAndBelowThem) {
  const TetMesh mesh = WholeMesh(3, 5);
  BladeSet set;
  set.segments = {{{-20, -10, 3}, {15, 12, -70}, {4, 7}}, {{15, 12, 0}, {15, 12, 5}, {7, 7}}};
  set.direction = {0, 0, -1};
  set.depth = 20;
  const SurfaceDepth depth(mesh, set.direction);
  const std::vector<double> outside = Blades(set, mesh).DistancesOutside(9);
  int inside = 0, near = 0;
  for (size_t node = 0; node < outside.size(); ++node) {
    const Vec3& at = mesh.rest_positions[node];
    double best = INFINITY;
    for (int k = 0; k <= 10000; ++k) {
      const double s = k / 10000.0;
      best = std::min(
          best, std::max(0.0, std::hypot(at[0] + 20 - 35 * s, at[1] + 10 - 22 * s) - (4 + 3 * s)));
    }
    // With a slope of radius, the point of least distance is not quite the closest of the line.
    best = std::hypot(best, std::max(0.0, depth.At(at) - 20));
    if (best < 8.5) {
      EXPECT_NEAR(outside[node], best, 0.15) << node;
    } else if (best > 9.5) {
      EXPECT_TRUE(std::isinf(outside[node])) << node;
    }
    inside += outside[node] == 0;
    near += outside[node] > 0 && outside[node] <= 9;
  }
  EXPECT_GT(inside, 3);
  EXPECT_GT(near, 10);
}

TEST(Blades, HoldNodesInTheGroovesOfTheirCurves) {
  const TetMesh mesh = WholeMesh(3, 8);
  for (const double depth : {std::numeric_limits<double>::infinity(), 17.3}) {
    BladeSet set;
    set.depth = depth;
    Draws draws(5);
    std::vector<int32_t> curve_of;
    for (int k = 0; k < 60; ++k) {  // two to a curve; some are dots, some without width
      const Vec3 start = draws.Point(50), end = k % 3 == 0 ? start : draws.Point(50);
      const double radius = k % 5 == 0 ? 0 : 1 + k % 7;
      set.segments.push_back({start, end, {radius, radius}});
      curve_of.push_back(k / 2);
    }
    const std::vector<uint8_t> holds = Blades(set, mesh).HoldingCurves(curve_of, 30);
    int count = 0;
    for (size_t c = 0; c < 30; ++c) {
      BladeSet alone = set;
      alone.segments.assign(set.segments.begin() + 2 * static_cast<long>(c),
                            set.segments.begin() + 2 * static_cast<long>(c) + 2);
      std::erase_if(alone.segments, [](const auto& segment) { return segment.radii[0] == 0; });
      const std::vector<double> outside = Blades(alone, mesh).DistancesOutside(0);
      const bool expected = std::count(outside.begin(), outside.end(), 0) > 0;
      EXPECT_EQ(holds[c] != 0, expected) << c;
      count += expected;
    }
    EXPECT_GT(count, 5);
    EXPECT_LT(count, 30);
  }
}

TEST(SurfaceDepth, IsThatOfTheFirstFaceOnTheWay) {
  const TetMesh mesh = WholeMesh(3, 2);
  std::vector<int32_t> nodes(mesh.rest_positions.size());
  std::iota(nodes.begin(), nodes.end(), 0);
  const std::vector<BoundaryFace> faces = FindBoundaryFaces(mesh, nodes);
  const Vec3 direction = {0.3, -0.2, -1.1};
  const Eigen::Vector3d unit = Eigen::Vector3d(direction.data()).normalized();
  const SurfaceDepth depth(mesh, direction);
  Draws draws(3);
  for (int k = 0; k < 300; ++k) {
    const Vec3 point = {draws.Whole(40) + 0.37, draws.Whole(40) + 0.11, draws.Whole(30) + 0.23};
    double expected = 0;
    for (const BoundaryFace& face : faces) {
      const auto corner = [&](size_t i) {
        return Eigen::Vector3d(mesh.rest_positions[static_cast<size_t>(face.nodes[i])].data());
      };
      Eigen::Matrix3d sides;
      sides << corner(1) - corner(0), corner(2) - corner(0), unit;
      const Eigen::Vector3d at = sides.inverse() * (Eigen::Vector3d(point.data()) - corner(0));
      if (at[0] >= 0 && at[1] >= 0 && at[0] + at[1] <= 1) expected = std::max(expected, at[2]);
    }
    EXPECT_NEAR(depth.At(point), expected, 1e-9) << k;
  }
}

TEST(ProjectedSide, SeesWhatRoundingHides) {
  // The third point is off the line by the last bit of coordinates of very different sizes.
  const Vec3 direction = {0, 0, 1};
  const double tiny = 0x1.0p-80;
  const Vec3 a = {0x1.0p-40, 0, 7}, b = {1, 1, -3};
  const Vec3 on = {0.5 + 0x1.0p-41, 0.5, 1e6};
  EXPECT_EQ(ProjectedSide(direction, a, b, on), 0);
  const int over = ProjectedSide(direction, {a[0], tiny, a[2]}, b, on);
  EXPECT_NE(over, 0);
  EXPECT_EQ(ProjectedSide(direction, {a[0], -tiny, a[2]}, b, on), -over);
  EXPECT_EQ(ProjectedSide(direction, b, {a[0], tiny, a[2]}, on), -over);
}

}  // namespace
}  // namespace cleave
