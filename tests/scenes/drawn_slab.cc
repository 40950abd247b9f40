#include "tests/scenes/drawn_slab.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "absl/strings/string_view.h"
#include "client/io/impurity/picture_file.h"
#include "core/base/status.h"
#include "core/impurity/drawing.h"
#include "core/mesh/procedural.h"
#include "spiral_png.h"
#include "tests/scenes/scene_parts.h"

namespace cleave {
namespace {

constexpr double kSide = 1;          // m
constexpr double kThickness = 0.05;  // m
constexpr double kGrip = 0.06;       // m at each end
constexpr double kPull = 0.08;       // m either end
constexpr double kSeconds = 1;
constexpr int64_t kFrames = 20;

using Point = std::array<double, 2>;

absl::StatusOr<std::vector<DrawnCurve>> Spiral() {
  const absl::string_view bytes(reinterpret_cast<const char*>(kSpiralPng), sizeof(kSpiralPng));
  CLEAVE_ASSIGN_OR_RETURN(const GreyRaster raster, ParsePicture(bytes));
  return TraceDrawing(raster, ImageDrawing{});
}

// The drawing as it lies on the slab, m: pieces no longer than `length`.
struct Stretch {
  Point from, to;
};
std::vector<Stretch> Laid(const std::vector<DrawnCurve>& curves, double length) {
  std::vector<Stretch> stretches;
  for (const DrawnCurve& curve : curves) {
    for (size_t i = 1; i < curve.points.size(); ++i) {
      const Point& a = curve.points[i - 1];
      const Point& b = curve.points[i];
      const double parts = std::ceil(kSide * std::hypot(b[0] - a[0], b[1] - a[1]) / length);
      const auto at = [&](double part) -> Point {
        const double u = part / parts;
        return {kSide * (a[0] + u * (b[0] - a[0])), kSide * (a[1] + u * (b[1] - a[1]))};
      };
      for (double part = 0; part < parts; ++part) stretches.push_back({at(part), at(part + 1)});
    }
  }
  return stretches;
}

double Distance(const Point& p, const Stretch& stretch) {
  const double x = stretch.to[0] - stretch.from[0], y = stretch.to[1] - stretch.from[1];
  const double square = x * x + y * y;
  const double along =
      square > 0 ? ((p[0] - stretch.from[0]) * x + (p[1] - stretch.from[1]) * y) / square : 0;
  const double u = std::clamp(along, 0.0, 1.0);
  return std::hypot(p[0] - stretch.from[0] - u * x, p[1] - stretch.from[1] - u * y);
}

}  // namespace

absl::StatusOr<Demonstration> MakeDrawnSlab(const Setting& setting) {
  Demonstration made;
  made.cell_size = 0.039 * setting.coarseness;
  BoxMesh box;
  box.origin = {-kSide / 2, -kSide / 2, -kThickness / 2};
  box.size = {kSide, kSide, kThickness};
  box.resolution = {setting.layout, made.cell_size, 0.2, setting.seed};
  CLEAVE_ASSIGN_OR_RETURN(made.mesh, BuildMesh(box));
  made.rest_length = kSide - 2 * kGrip;

  Scene& scene = made.scene;
  scene.name = "drawn slab";
  scene.seed = setting.seed;
  Material ductile;
  ductile.name = "ductile";
  ductile.youngs_modulus = 1e7;
  ductile.poisson_ratio = 0.35;
  ductile.density = 1000;
  ductile.tensile_strength = 6.5e5;
  ductile.plasticity = Plasticity{.yield_stress = 5e5, .hardening = 1e6};
  scene.materials.push_back(ductile);
  Impurities impurities;
  impurities.noise = 0.05;
  if (setting.variant != "plain") {
    ImpurityLayer layer;
    layer.name = "spiral";
    SegmentPattern pattern;
    CLEAVE_ASSIGN_OR_RETURN(pattern.curves, Spiral());
    pattern.scale = kSide;
    pattern.rotation = setting.variant == "turned" ? std::numbers::pi / 2 : 0;
    layer.source = std::move(pattern);
    layer.potency = 2;
    layer.weakening = 0.25;
    impurities.layers.push_back(std::move(layer));
  }
  scene.impurities = impurities;
  if (setting.variant == "shuffled") DealOut(scene, MarkedNodes(scene, made.mesh), setting.seed);
  GripEnds(made, kSide, kGrip);
  AddMotion(scene, "left end", {true, true, true}, PullBy({-kPull, 0, 0}, kSeconds));
  made.pull_motion =
      AddMotion(scene, "right end", {true, true, true}, PullBy({kPull, 0, 0}, kSeconds));
  Reinforce(scene, kSide / 2 - kGrip, 0.05);
  SetPace(scene, kSeconds, kFrames);
  made.frames_after_separation = 3;
  return made;
}

Metrics MeasureDrawnSlab(const Demonstration& demonstration, const Incidence& incidence,
                         const Run& run) {
  const auto curves = Spiral();
  if (!curves.ok()) return {};
  const double cell = demonstration.cell_size;
  const std::vector<Stretch> drawing = Laid(*curves, 0.25 * cell);
  const auto midpoint = [&](int32_t edge) -> Point {
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    const Vec3& p = demonstration.mesh.rest_positions[static_cast<size_t>(a)];
    const Vec3& q = demonstration.mesh.rest_positions[static_cast<size_t>(b)];
    return {(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
  };
  const auto near = [&](const Point& p) {
    return std::any_of(drawing.begin(), drawing.end(),
                       [&](const Stretch& each) { return Distance(p, each) <= cell; });
  };
  // What lies within a grip is moved as one and cannot break: it is no part of what a crack that
  // takes no notice of the drawing would be spread over.
  std::vector<uint8_t> gripped(demonstration.mesh.rest_positions.size(), 0);
  for (const int32_t node : demonstration.grip) gripped[static_cast<size_t>(node)] = 1;
  for (const int32_t node : demonstration.pulled) gripped[static_cast<size_t>(node)] = 2;
  double all = 0, all_near = 0, broken_near = 0;
  const auto edges = static_cast<int32_t>(incidence.edges.size());
  for (int32_t edge = 0; edge < edges; ++edge) {
    const auto& [a, b] = incidence.edges[static_cast<size_t>(edge)];
    const uint8_t grip = gripped[static_cast<size_t>(a)];
    if (grip != 0 && grip == gripped[static_cast<size_t>(b)]) continue;
    all += 1;
    all_near += near(midpoint(edge)) ? 1 : 0;
  }
  std::vector<Point> broken;
  for (const int32_t edge : run.frames.back().broken_edges) {
    broken.push_back(midpoint(edge));
    broken_near += near(broken.back()) ? 1 : 0;
  }
  double length = 0, broken_length = 0;
  for (const Stretch& each : drawing) {
    const double size = std::hypot(each.to[0] - each.from[0], each.to[1] - each.from[1]);
    length += size;
    if (std::any_of(broken.begin(), broken.end(),
                    [&](const Point& p) { return Distance(p, each) <= cell; }))
      broken_length += size;
  }
  Metrics metrics;
  metrics["near_base"] = all_near / all;
  metrics["near_drawing"] = broken.empty() ? 0 : broken_near / static_cast<double>(broken.size());
  metrics["drawing_lift"] = metrics["near_drawing"] / metrics["near_base"];
  metrics["drawing_broken"] = broken_length / length;
  return metrics;
}

std::vector<Criterion> DrawnSlabCriteria() {
  const auto follows = [](const std::string& variant) -> std::vector<Condition> {
    return {{"share of broken edges within a cell of the drawing", Of(variant, "near_drawing"),
             Relation::kAtLeast, 0.8},
            {"share of the drawing that is broken", Of(variant, "drawing_broken"),
             Relation::kAtLeast, 0.5}};
  };
  const auto lifted = [](const std::string& variant) -> Condition {
    return {"lift of edges within a cell of the drawing", Of(variant, "drawing_lift"),
            Relation::kAtLeast, 4};
  };
  return {
      {"It breaks along the drawing", {"drawn"}, follows("drawn")},
      // Of a coarse body a quarter lies within a cell of the drawing: no lift could be above 4.
      {.text = "It breaks there much more than elsewhere",
       .variants = {"drawn"},
       .conditions = {lifted("drawn")},
       .full_size = true},
      {"With the drawing turned it does not break along where it was",
       {"turned"},
       follows("turned"),
       true,
       kAll},
      {"Without a drawing it does not", {"plain"}, follows("plain"), true, kAll},
      // In full only, as short tests have two controls.
      {.text = "With the drawing's impurities dealt out to other nodes it does not",
       .variants = {"shuffled"},
       .conditions = follows("shuffled"),
       .control = true,
       .share = kAll,
       .full_size = true},
      {"Without a drawing it takes no notice of where it would be",
       {"plain"},
       {{"share of broken edges within a cell of the drawing, beyond that of all that can break",
         Difference(Of("plain", "near_drawing"), Of("plain", "near_base")), Relation::kAtMost,
         0.1}}},
  };
}

}  // namespace cleave
