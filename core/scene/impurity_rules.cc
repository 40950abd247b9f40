#include "core/scene/impurity_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/scene/checker.h"
#include "core/scene/impurity_reach.h"
#include "core/scene/limits.h"

namespace cleave {
namespace {

constexpr absl::string_view kNothing = "is 0 everywhere: the layer does nothing";

struct ImpuritySourceRules {
  std::string layer;
  Faults& faults;
  Checker check;

  std::string At(absl::string_view field) const { return absl::StrCat(layer, ".", field); }

  void Shares(const std::string& field, const std::vector<double>& shares) {
    if (shares.empty())
      faults.Error(field, "is empty; a share for every node or vertex is required");
    if (!check.List(field, shares.size(), limits::kMaxNodes)) return;
    for (size_t k = 0; k < shares.size(); ++k) check.Within(cleave::At(field, k), shares[k], 0, 1);
    if (!shares.empty() &&
        std::all_of(shares.begin(), shares.end(), [](double x) { return x == 0; }))
      faults.Warning(field, kNothing);
  }
  void Depth(const std::string& field, const std::optional<double>& depth) {
    if (depth) check.Above(field, *depth, 0, limits::kMaxLength);
  }
  // A file that a client should have read.
  bool Unread(const std::string& field, const std::string& file) {
    if (file.empty()) return false;
    faults.Error(field, absl::StrCat("\"", file.substr(0, limits::kMaxNameBytes),
                                     "\" is a path of the client, which reads it and sends what "
                                     "is in it"));
    return true;
  }

  void operator()(std::monostate) {
    faults.Error(layer,
                 "names no source; one of node_values, noise, bands, pockets, strokes, pattern, "
                 "paint is required");
  }
  void operator()(const NodeValues& values) {
    if (!Unread(At("node_values.file"), values.file))
      Shares(At("node_values.shares"), values.shares);
  }
  void operator()(const NoiseField& noise) {
    check.Within(At("noise.correlation_length"), noise.correlation_length, 0, limits::kMaxLength);
  }
  void operator()(const BandField& bands) {
    check.Coordinates(At("bands.center"), bands.center);
    check.Direction(At("bands.axis"), bands.axis);
    check.Within(At("bands.position"), bands.position, -limits::kMaxLength, limits::kMaxLength);
    check.Above(At("bands.width"), bands.width, 0, limits::kMaxLength);
    if (bands.spacing) check.Above(At("bands.spacing"), *bands.spacing, 0, limits::kMaxLength);
    if (bands.spacing && bands.width >= *bands.spacing) {
      faults.Error(At("bands.width"),
                   absl::StrCat(bands.width, " is not below the spacing, ", *bands.spacing,
                                ": bands would fill everything"));
    }
  }
  void operator()(const PocketField& pockets) {
    check.Count(At("pockets.count"), pockets.count, 1, limits::kMaxPockets);
    check.Above(At("pockets.radius"), pockets.radius, 0, limits::kMaxLength);
  }
  void operator()(const Strokes& strokes) {
    check.Direction(At("strokes.direction"), strokes.direction);
    Depth(At("strokes.depth"), strokes.depth);
    check.Within(At("strokes.radius"), strokes.radius, 0, limits::kMaxLength);
    const std::string curves = At("strokes.curves");
    if (strokes.curves.empty()) faults.Error(curves, "is empty; a stroke is required");
    size_t points = 0;
    for (const Polyline& curve : strokes.curves) points += curve.points.size();
    if (!check.List(curves + "[*].points", points, limits::kMaxBladePoints)) return;
    for (size_t c = 0; c < strokes.curves.size(); ++c) {
      const std::string field = cleave::At(curves, c, "points");
      const std::vector<Vec3>& line = strokes.curves[c].points;
      if (line.size() < 2)
        faults.Error(field, absl::StrCat("has ", line.size(), " points; two or more are required"));
      for (size_t k = 0; k < line.size(); ++k) check.Coordinates(cleave::At(field, k), line[k]);
    }
  }
  void operator()(const SegmentPattern& pattern) {
    check.Coordinates(At("pattern.origin"), pattern.origin);
    check.Direction(At("pattern.direction"), pattern.direction);
    check.Direction(At("pattern.up"), pattern.up);
    CheckUp(pattern);
    if (!std::isfinite(pattern.rotation)) {
      faults.Error(At("pattern.rotation"),
                   absl::StrCat(pattern.rotation, " is not a finite number"));
    }
    check.Above(At("pattern.scale"), pattern.scale, 0, limits::kMaxLength);
    Depth(At("pattern.depth"), pattern.depth);
    if (pattern.image) {
      Unread(At("pattern.image.file"), pattern.image->file);
      if (pattern.image->file.empty()) faults.Error(At("pattern.image.file"), "is empty");
      return;
    }
    const std::string curves = At("pattern.curves");
    if (pattern.curves.empty()) faults.Error(curves, "is empty; nothing is drawn");
    size_t points = 0;
    for (const DrawnCurve& curve : pattern.curves) points += curve.points.size();
    if (!check.List(curves + "[*].points", points, limits::kMaxBladePoints)) return;
    for (size_t c = 0; c < pattern.curves.size(); ++c)
      Curve(cleave::At(curves, c), pattern.curves[c]);
  }
  void CheckUp(const SegmentPattern& pattern) {
    const Vec3& d = pattern.direction;
    const Vec3& u = pattern.up;
    const double across =
        std::hypot(d[1] * u[2] - d[2] * u[1], d[2] * u[0] - d[0] * u[2], d[0] * u[1] - d[1] * u[0]);
    // Nearer than this to the direction, rounding would turn the drawing.
    if (across <= 1e-6 * std::hypot(d[0], d[1], d[2]) * std::hypot(u[0], u[1], u[2]))
      faults.Error(At("pattern.up"), "is parallel to the direction: the drawing has no upright");
  }
  void Curve(const std::string& field, const DrawnCurve& curve) {
    if (curve.points.size() < 2) {
      faults.Error(field + ".points",
                   absl::StrCat("has ", curve.points.size(), " points; two or more are required"));
    }
    for (size_t k = 0; k < curve.points.size(); ++k) {
      for (size_t axis = 0; axis < 2; ++axis) {
        check.Within(absl::StrCat(cleave::At(field + ".points", k), "[", axis, "]"),
                     curve.points[k][axis], -limits::kMaxDrawingUnit, limits::kMaxDrawingUnit);
      }
    }
    if (!curve.half_widths.empty() && curve.half_widths.size() != curve.points.size()) {
      faults.Error(field + ".half_widths",
                   absl::StrCat("has ", curve.half_widths.size(), " widths for ",
                                curve.points.size(), " points; as many or none are required"));
    }
    for (size_t k = 0; k < curve.half_widths.size(); ++k) {
      check.Within(cleave::At(field + ".half_widths", k), curve.half_widths[k], 0,
                   limits::kMaxDrawingUnit);
    }
  }
  void operator()(const SurfacePaint& paint) {
    check.Above(At("paint.depth"), paint.depth, 0, limits::kMaxLength);
    if (Unread(At("paint.file"), paint.file)) return;
    if (paint.texture) {
      Texture(paint, *paint.texture);
    } else {
      Shares(At("paint.shares"), paint.shares);
    }
    if (paint.vertices.empty() != paint.triangles.empty()) {
      faults.Error(At("paint.triangles"),
                   "a painted surface has vertices and triangles; the mesh's own has neither");
      return;
    }
    if (paint.vertices.empty()) return;
    if (!check.List(At("paint.triangles"), paint.triangles.size(), limits::kMaxPaintTriangles) ||
        !check.List(At("paint.vertices"), paint.vertices.size(), 3 * limits::kMaxPaintTriangles))
      return;
    if (!paint.texture && paint.shares.size() != paint.vertices.size()) {
      faults.Error(At("paint.shares"),
                   absl::StrCat("has ", paint.shares.size(), " shares; the surface has ",
                                paint.vertices.size(), " vertices"));
    }
    for (size_t k = 0; k < paint.vertices.size(); ++k)
      check.Coordinates(cleave::At(At("paint.vertices"), k), paint.vertices[k]);
    const auto count = static_cast<int64_t>(paint.vertices.size());
    for (size_t k = 0; k < paint.triangles.size(); ++k) {
      for (const int32_t vertex : paint.triangles[k])
        check.Count(cleave::At(At("paint.triangles"), k), vertex, 0, count - 1);
    }
  }
  void Texture(const SurfacePaint& paint, const SurfaceTexture& texture) {
    const std::string field = At("paint.texture");
    if (!paint.shares.empty())
      faults.Error(At("paint.shares"), "stand beside a texture; give one of both");
    if (paint.vertices.empty()) {
      faults.Error(At("paint.vertices"),
                   "is empty; a texture needs a surface, whose triangles have its coordinates");
    }
    if (texture.uvs.size() != paint.triangles.size()) {
      faults.Error(field + ".uvs",
                   absl::StrCat("has coordinates of ", texture.uvs.size(),
                                " triangles; the surface has ", paint.triangles.size()));
    }
    for (size_t k = 0; k < texture.uvs.size(); ++k) {
      for (const float coordinate : texture.uvs[k])
        check.Within(cleave::At(field + ".uvs", k), coordinate, -limits::kMaxTextureCoordinate,
                     limits::kMaxTextureCoordinate);
    }
    if (Unread(field + ".file", texture.file)) return;
    if (texture.channel != TextureChannel::kLuminance)
      faults.Error(field + ".channel", "is of a file, and there is none");
    check.Count(field + ".width", texture.width, 1, limits::kMaxTextureSide);
    check.Count(field + ".height", texture.height, 1, limits::kMaxTextureSide);
    const int64_t texels = int64_t{texture.width} * texture.height;
    if (texels > limits::kMaxTexels) {
      faults.Error(field, absl::StrCat("has ", texels, " texels; at most ", limits::kMaxTexels,
                                       " are allowed"));
    } else if (static_cast<int64_t>(texture.values.size()) != texels) {
      faults.Error(field + ".values",
                   absl::StrCat("has ", texture.values.size(), " bytes; ", texture.width, " x ",
                                texture.height, " texels have ", texels));
    }
    const uint8_t none = texture.invert ? 255 : 0;
    if (!texture.values.empty() && std::all_of(texture.values.begin(), texture.values.end(),
                                               [none](uint8_t value) { return value == none; }))
      faults.Warning(field, kNothing);
  }
};

void CheckLayer(const std::string& field, const ImpurityLayer& layer,
                const std::set<std::string>& names, Faults& faults, Checker& check) {
  check.Name(field + ".name", layer.name, false);
  if (!layer.node_set.empty()) CheckSetName(field + ".node_set", layer.node_set, names, faults);
  std::visit(ImpuritySourceRules{field, faults, check}, layer.source);
  if (layer.potency) check.Within(field + ".potency", *layer.potency, 0, limits::kMaxPotency);
  if (layer.weakening && !(*layer.weakening >= 0)) {
    faults.Error(field + ".weakening", absl::StrCat(*layer.weakening, " is outside [0, inf]"));
  }
  if (!layer.potency && !layer.weakening)
    faults.Error(field, "does nothing; a potency, a weakening or both are required");
  check.Within(field + ".falloff", layer.falloff, 0, limits::kMaxLength);
  const bool random = std::holds_alternative<NoiseField>(layer.source);
  if (layer.falloff > 0 && (random || std::holds_alternative<NodeValues>(layer.source))) {
    faults.Error(field + ".falloff",
                 "this source gives every node its value; there is nothing to fall off from");
  }
  if (layer.weakening && random) {
    faults.Error(field + ".weakening",
                 "noise gives nodes random potencies and marks no edges; set its potency");
  }
}

}  // namespace

void CheckTracing(const std::string& prefix, const ImageDrawing& image, Faults& faults) {
  Checker check(faults);
  check.Between(prefix + "threshold", image.threshold, 0, 1);
  check.Within(prefix + "tolerance", image.tolerance, 0, limits::kMaxTracingTolerance);
}

void CheckImpurities(const Impurities& impurities, const std::set<std::string>& names,
                     Faults& faults) {
  Checker check(faults);
  check.Within("impurities.potency", impurities.potency, 0, limits::kMaxPotency);
  check.Within("impurities.noise", impurities.noise, 0, limits::kMaxPotencyNoise);
  check.Above("impurities.steepness", impurities.steepness, 0, limits::kMaxSteepness);
  check.Above("impurities.pure_offset", impurities.pure_offset, 0, limits::kMaxPureOffset);
  if (impurities.degree_weight.has_value())
    check.Within("impurities.degree_weight", *impurities.degree_weight, 0, 1);
  if (check.List("impurities.map", impurities.map.size(), limits::kMaxNodes)) {
    for (size_t k = 0; k < impurities.map.size(); ++k)
      check.Within(At("impurities.map", k), impurities.map[k], 0, 1);
  }
  if (!impurities.map.empty() && !impurities.patches.empty())
    faults.Error("impurities.patches", "the map has a share for every node already");
  if (check.List("impurities.patches", impurities.patches.size())) {
    for (size_t k = 0; k < impurities.patches.size(); ++k) {
      const PotencyPatch& patch = impurities.patches[k];
      CheckSetName(At("impurities.patches", k, "node_set"), patch.node_set, names, faults);
      check.Within(At("impurities.patches", k, "share"), patch.share, 0, 1);
    }
  }
  if (!check.List("impurities.layers", impurities.layers.size(), limits::kMaxImpurityLayers))
    return;
  for (size_t k = 0; k < impurities.layers.size(); ++k)
    CheckLayer(At("impurities.layers", k), impurities.layers[k], names, faults, check);
}

void CheckImpuritiesOfMesh(const Scene& scene, const TetMesh& mesh, Faults& faults) {
  const Impurities& impurities = *scene.impurities;
  // An empty array is absent, or CheckImpurities has named it.
  const auto check_count = [&](const std::string& field, size_t count) {
    if (count == 0 || static_cast<int64_t>(count) == mesh.node_count()) return;
    faults.Error(
        field, absl::StrCat("has ", count, " shares; the mesh has ", mesh.node_count(), " nodes"));
  };
  check_count("impurities.map", impurities.map.size());
  std::set<std::string> names;
  for (const NodeSet& set : scene.node_sets) names.insert(set.name);
  std::vector<std::array<int32_t, 2>> edges;
  for (size_t k = 0; k < impurities.layers.size(); ++k) {
    const ImpurityLayer& layer = impurities.layers[k];
    const std::string field = At("impurities.layers", k);
    if (const auto* values = std::get_if<NodeValues>(&layer.source))
      check_count(field + ".node_values.shares", values->shares.size());
    const auto* paint = std::get_if<SurfacePaint>(&layer.source);
    if (paint != nullptr && paint->vertices.empty())
      check_count(field + ".paint.shares", paint->shares.size());
    Faults own;
    Checker check(own);
    CheckLayer(field, layer, names, own, check);
    if (!own.ok()) continue;
    if (edges.empty()) edges = EdgesOfTets(mesh);
    CheckReach(scene, k, mesh, edges, faults);
  }
}

}  // namespace cleave
