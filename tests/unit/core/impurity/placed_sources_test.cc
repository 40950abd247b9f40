// Sources that artists place: they are where they are put, whichever way body and source lie.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/base/counter_rng.h"
#include "core/impurity/bake.h"
#include "core/impurity/drawing.h"
#include "core/mesh/incidence.h"
#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

// A lattice whose nodes are off by up to `share` of a cell along each axis.
TetMesh Jittered(const std::array<int, 3>& cells, const Vec3& size, double share) {
  TetMesh mesh = KuhnBox(cells, size);
  uint64_t next = 0;
  for (Vec3& point : mesh.rest_positions) {
    for (size_t axis = 0; axis < 3; ++axis) {
      const double draw = UniformDraw(7, RandomStream::kMeshJitter, next++, 0);
      point[axis] += share * size[axis] / cells[axis] * (2 * draw - 1);
    }
  }
  return mesh;
}

struct Motion3 {
  Eigen::Matrix3d turn;
  Eigen::Vector3d shift;

  Vec3 Turn(const Vec3& v) const { return Of(turn * Eigen::Vector3d(v.data())); }
  Vec3 Move(const Vec3& v) const { return Of(turn * Eigen::Vector3d(v.data()) + shift); }

  static Vec3 Of(const Eigen::Vector3d& v) { return {v[0], v[1], v[2]}; }
};

// Moves a source with the body.
struct Mover {
  const Motion3& motion;

  ImpuritySource operator()(std::monostate) const { return {}; }
  ImpuritySource operator()(const NodeValues& values) const { return values; }
  ImpuritySource operator()(const NoiseField& noise) const { return noise; }
  ImpuritySource operator()(BandField bands) const {
    bands.center = motion.Move(bands.center);
    bands.axis = motion.Turn(bands.axis);
    return bands;
  }
  ImpuritySource operator()(const PocketField& pockets) const { return pockets; }
  ImpuritySource operator()(Strokes strokes) const {
    for (Polyline& curve : strokes.curves)
      for (Vec3& point : curve.points) point = motion.Move(point);
    strokes.direction = motion.Turn(strokes.direction);
    return strokes;
  }
  ImpuritySource operator()(SegmentPattern pattern) const {
    pattern.origin = motion.Move(pattern.origin);
    pattern.direction = motion.Turn(pattern.direction);
    pattern.up = motion.Turn(pattern.up);
    return pattern;
  }
  ImpuritySource operator()(SurfacePaint paint) const {
    for (Vec3& vertex : paint.vertices) vertex = motion.Move(vertex);
    return paint;
  }
};

TEST(PlacedSources, MarkTheSameWhenTheyMoveAndTurnWithTheBody) {
  const TetMesh mesh = Jittered({7, 6, 5}, {1.4, 1.2, 1}, 0.2);
  const Incidence incidence = BuildIncidence(mesh);
  const Strokes strokes = {
      {{{{0.1, -0.3, 5}, {0.73, 0.61, 2}, {1.31, 0.4, 0}}}, {{{0.2, 1.3, 0}, {1.21, 0.9, 0}}}},
      {0.3, 0.2, -1},
      0.63,
      0.07};
  SegmentPattern pattern;
  pattern.curves = {{{{-0.5, 0.1}, {0.5, -0.2}, {0.1, 0.45}}, {}},
                    {{{-0.3, -0.4}, {0.4, 0.3}}, {0.1, 0.02}}};
  pattern.origin = {0.71, 0.63, 3};
  pattern.direction = {0.2, -0.1, -1};
  pattern.up = {0.3, 1, 0.4};
  pattern.rotation = 0.4;
  pattern.scale = 0.9;
  SurfacePaint paint;
  paint.vertices = {{-0.1, -0.2, 0.9}, {1.6, 0.1, 1.1}, {0.4, 1.5, 0.8}};
  paint.triangles = {{0, 1, 2}};
  paint.shares = {0.1, 0.7, 1};
  paint.depth = 0.21;
  SurfacePaint own;
  for (const Vec3& point : mesh.rest_positions) own.shares.push_back(point[0] > 0.7 ? 0.8 : 0);
  own.depth = 0.11;
  NodeValues values;
  for (const Vec3& point : mesh.rest_positions) values.shares.push_back(point[1] > 0.5 ? 0.3 : 0);
  const Vec3 center = {0.3, 0.4, 0.5}, axis = {1, 2, -0.7};
  const std::vector<ImpuritySource> sources = {
      strokes,
      pattern,
      BandField{BandShape::kPlanes, center, axis, 0.31, 0.23, 0.71},
      BandField{BandShape::kCylinders, center, axis, 0.4, 0.2},
      BandField{BandShape::kSpheres, center, axis, 0.5, 0.3},
      PocketField{6, 0.22},
      paint,
      own,
      values};
  const auto turned = [](double angle, const Eigen::Vector3d& about) {
    return Eigen::AngleAxisd(angle, about.normalized()).toRotationMatrix();
  };
  Eigen::Matrix3d axes, flip;  // which doubles represent
  axes << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  flip << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  const std::vector<Motion3> motions = {{axes, {16, -2, 0.5}},
                                        {flip, {-0.25, 8, 4}},
                                        {turned(0.83, {1, 2, -0.5}), {0.3, -1.7, 2.9}},
                                        {turned(2.9, {-1, 0.2, 0.1}), {-11.3, 4.1, 7.7}}};
  for (const ImpuritySource& source : sources) {
    Scene scene;
    scene.seed = 3;
    scene.impurities.emplace();
    ImpurityLayer& layer = scene.impurities->layers.emplace_back();
    layer.source = source;
    layer.potency = 4;
    layer.weakening = 0.5;
    if (!std::holds_alternative<NodeValues>(source)) layer.falloff = 0.13;
    const BakedImpurities at_home = BakeImpurities(scene, mesh, incidence.edges);
    const auto touched =
        std::count(at_home.touched_edges.begin(), at_home.touched_edges.end(), uint8_t{1});
    EXPECT_GT(touched, 20) << source.index();
    EXPECT_LT(touched, incidence.edge_count()) << source.index();
    for (const Motion3& motion : motions) {
      TetMesh moved = mesh;
      for (Vec3& point : moved.rest_positions) point = motion.Move(point);
      layer.source = std::visit(Mover{motion}, source);
      const BakedImpurities away = BakeImpurities(scene, moved, incidence.edges);
      EXPECT_EQ(away.touched_edges, at_home.touched_edges) << source.index();
      for (size_t node = 0; node < moved.rest_positions.size(); ++node)
        ASSERT_NEAR(away.potencies[node], at_home.potencies[node], 1e-9) << source.index();
      for (size_t edge = 0; edge < incidence.edges.size(); ++edge)
        ASSERT_NEAR(away.edge_factors[edge], at_home.edge_factors[edge], 1e-9) << source.index();
    }
  }
}

// A ring with a stroke through it, 24 pixels wide.
GreyRaster Sign() {
  GreyRaster raster{240, 240, {}};
  for (int y = 0; y < raster.height; ++y) {
    for (int x = 0; x < raster.width; ++x) {
      const double dx = x - 119.5, dy = y - 119.5;
      const bool ring = std::abs(std::hypot(dx, dy) - 80) <= 12;
      const bool stroke = std::abs(dx + 0.5 * dy) * std::cos(std::atan(0.5)) <= 12;
      raster.values.push_back(ring || (stroke && std::hypot(dx, dy) < 80) ? 0.1F : 0.9F);
    }
  }
  return raster;
}

// Of the nodes that the pattern of a picture makes impure and those that lie where it is drawn.
double Overlap(const GreyRaster& raster, bool keep_width, double rotation) {
  ImageDrawing image;
  image.keep_width = keep_width;
  auto curves = TraceDrawing(raster, image);
  EXPECT_TRUE(curves.ok()) << curves.status();
  // Twelve cells across the line of 24 pixels.
  const int cells = raster.width / 2;
  const TetMesh mesh = Jittered({cells, cells, 1}, {1, 1, 1.0 / cells}, 0.2);
  Scene scene;
  scene.impurities.emplace();
  ImpurityLayer& layer = scene.impurities->layers.emplace_back();
  SegmentPattern pattern;
  pattern.curves = *curves;
  pattern.origin = {0.5, 0.5, 0};
  pattern.rotation = rotation;
  layer.source = pattern;
  layer.potency = 1;
  const BakedImpurities baked = BakeImpurities(scene, mesh, BuildIncidence(mesh).edges);
  int64_t both = 0, either = 0;
  for (size_t node = 0; node < baked.potencies.size(); ++node) {
    const double x = mesh.rest_positions[node][0] - 0.5, y = mesh.rest_positions[node][1] - 0.5;
    const double c = std::cos(rotation), s = std::sin(rotation);
    const double u = c * x + s * y, v = c * y - s * x;  // in the drawing
    const int column = static_cast<int>(std::floor((u + 0.5) * raster.width));
    const int row = static_cast<int>(std::floor((0.5 - v) * raster.height));
    const bool within = column >= 0 && column < raster.width && row >= 0 && row < raster.height;
    const bool drawn = within && raster.at(column, row) < 0.5F;
    const bool marked = baked.potencies[node] > 0;
    both += drawn && marked;
    either += drawn || marked;
  }
  return static_cast<double>(both) / static_cast<double>(either);
}

TEST(PlacedSources, MarkWhatAPictureShowsWhereItsLinesAreTwelveCellsWide) {
  const GreyRaster sign = Sign();
  for (const double rotation : {0.0, 0.7}) EXPECT_GE(Overlap(sign, true, rotation), 0.8);
  // The middle of the lines alone is another drawing.
  EXPECT_LT(Overlap(sign, false, 0), 0.4);
}

}  // namespace
}  // namespace cleave
