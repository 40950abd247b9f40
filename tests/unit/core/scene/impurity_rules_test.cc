#include "core/scene/impurity_rules.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "tests/unit/core/mesh/kuhn_mesh.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TetMesh Cube() { return KuhnBox({2, 2, 2}, {1, 1, 1}); }

Strokes Across() {
  Strokes strokes;
  strokes.curves = {{{{0.4, -1, 0}, {0.4, 2, 0}}}};
  return strokes;
}
SegmentPattern Cross() {
  SegmentPattern pattern;
  pattern.curves = {{{{-1, 0}, {1, 0}}, {}}, {{{0, -1}, {0, 1}}, {0.1, 0.1}}};
  pattern.origin = {0.4, 0.4, 0};
  return pattern;
}
SurfacePaint Painted() {
  SurfacePaint paint;
  paint.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  paint.triangles = {{0, 1, 2}};
  paint.shares = {0, 0.5, 1};
  paint.depth = 0.1;
  return paint;
}

SurfacePaint Textured() {
  SurfacePaint paint = Painted();
  paint.shares.clear();
  paint.texture.emplace();
  paint.texture->width = 2;
  paint.texture->height = 1;
  paint.texture->values = {0, 255};
  paint.texture->uvs = {{0, 0, 1, 0, 1, 1}};
  return paint;
}

ImpurityLayer Layer(ImpuritySource source) {
  ImpurityLayer layer;
  layer.source = std::move(source);
  layer.potency = 1;
  return layer;
}

// In a scene with the set "left", all nodes of a side of the body.
Faults Check(const ImpurityLayer& layer) {
  Scene scene;
  scene.node_sets = {{"left", {BoxSelector{{0, 0, 0}, {0, 1, 1}}}}};
  scene.impurities.emplace();
  scene.impurities->layers = {Layer(NoiseField{}), layer};
  Faults faults;
  CheckImpurities(*scene.impurities, {"left"}, faults);
  CheckImpuritiesOfMesh(scene, Cube(), faults);
  return faults;
}
ImpurityLayer OfTheLeft(ImpurityLayer layer) {
  layer.node_set = "left";
  return layer;
}
ImpurityLayer WeakeningOnly(ImpurityLayer layer) {
  layer.potency.reset();
  layer.weakening = 0.5;
  return layer;
}

TEST(ImpurityRules, AcceptEverySource) {
  for (const ImpuritySource& source :
       {ImpuritySource(NodeValues{std::vector<double>(27, 0.5)}), ImpuritySource(NoiseField{}),
        ImpuritySource(BandField{.width = 0.1}), ImpuritySource(PocketField{3, 0.4}),
        ImpuritySource(Across()), ImpuritySource(Cross()), ImpuritySource(Painted()),
        ImpuritySource(Textured())}) {
    const Faults faults = Check(Layer(source));
    EXPECT_TRUE(faults.ok()) << source.index() << ": " << faults.ToStatus();
    EXPECT_EQ(faults.warning_count(), 0);
  }
}

template <typename Source>
ImpurityLayer Spoilt(Source source, const std::function<void(Source&)>& spoil) {
  spoil(source);
  return Layer(source);
}
ImpurityLayer Spoilt(const std::function<void(ImpurityLayer&)>& spoil) {
  ImpurityLayer layer = Layer(Across());
  spoil(layer);
  return layer;
}

TEST(ImpurityRules, NameTheFieldOfEveryKindOfFault) {
  const std::vector<std::pair<std::string, ImpurityLayer>> cases = {
      {"", Layer(std::monostate{})},
      {"", Spoilt([](auto& l) { l.potency.reset(); })},
      {".potency", Spoilt([](auto& l) { l.potency = kNan; })},
      {".potency", Spoilt([](auto& l) { l.potency = 101; })},
      {".weakening", Spoilt([](auto& l) { l.weakening = -1; })},
      {".weakening", Spoilt([](auto& l) {
         l.source = NoiseField{};
         l.weakening = 0.5;
       })},
      {".falloff", Spoilt([](auto& l) { l.falloff = -1; })},
      {".falloff", Spoilt([](auto& l) {
         l.source = NoiseField{};
         l.falloff = 1;
       })},
      {".node_set", Spoilt([](auto& l) { l.node_set = "right"; })},
      {".node_values.shares", Layer(NodeValues{})},
      {".node_values.shares", Layer(NodeValues{{0, 1, 0}})},  // of another mesh
      {".node_values.shares[1]",
       Spoilt<NodeValues>({std::vector<double>(27, 0.5)}, [](auto& v) { v.shares[1] = kNan; })},
      {".node_values.file", Layer(NodeValues{{}, "worn.vtu", ""})},
      {".noise.correlation_length", Layer(NoiseField{.correlation_length = -1})},
      {".bands.width", Layer(BandField{})},
      {".bands.width", Layer(BandField{.width = 2, .spacing = 1})},
      {".bands.axis", Layer(BandField{.axis = {0, 0, 0}, .width = 1})},
      {".pockets.count", Layer(PocketField{0, 1})},
      {".pockets.radius", Layer(PocketField{1, kNan})},
      {".strokes.curves", Layer(Strokes{})},
      {".strokes.curves[0].points",
       Spoilt<Strokes>(Across(), [](auto& s) { s.curves[0].points.pop_back(); })},
      {".strokes.curves[0].points[1][2]",
       Spoilt<Strokes>(Across(), [](auto& s) { s.curves[0].points[1][2] = kNan; })},
      {".strokes.direction", Spoilt<Strokes>(Across(),
                                             [](auto& s) {
                                               s.direction = {0, 0, 0};
                                             })},
      {".strokes.depth", Spoilt<Strokes>(Across(), [](auto& s) { s.depth = 0; })},
      {".strokes.radius", Spoilt<Strokes>(Across(), [](auto& s) { s.radius = -1; })},
      {".strokes.curves[1]",  // misses
       Spoilt<Strokes>(Across(),
                       [](auto& s) {
                         s.curves.push_back({{{2, 0, 0}, {2, 1, 0}}});
                       })},
      {".pattern.curves", Layer(SegmentPattern{})},
      {".pattern.curves[1].half_widths",
       Spoilt<SegmentPattern>(Cross(), [](auto& p) { p.curves[1].half_widths.pop_back(); })},
      {".pattern.curves[0].points[1][0]",
       Spoilt<SegmentPattern>(Cross(), [](auto& p) { p.curves[0].points[1][0] = kNan; })},
      {".pattern.scale", Spoilt<SegmentPattern>(Cross(), [](auto& p) { p.scale = 0; })},
      {".pattern.up", Spoilt<SegmentPattern>(Cross(),
                                             [](auto& p) {
                                               p.up = {0, 0, 2};
                                             })},
      {".pattern.rotation", Spoilt<SegmentPattern>(Cross(), [](auto& p) { p.rotation = kNan; })},
      {".pattern.image.file",
       Spoilt<SegmentPattern>(Cross(), [](auto& p) { p.image = {.file = "star.png"}; })},
      {".pattern",  // misses
       Spoilt<SegmentPattern>(Cross(),
                              [](auto& p) {
                                p.origin = {9, 9, 0};
                              })},
      {".paint.depth", Spoilt<SurfacePaint>(Painted(), [](auto& p) { p.depth = 0; })},
      {".paint.shares", Spoilt<SurfacePaint>(Painted(), [](auto& p) { p.shares.pop_back(); })},
      {".paint.triangles", Spoilt<SurfacePaint>(Painted(), [](auto& p) { p.triangles.clear(); })},
      {".paint.triangles[0]",
       Spoilt<SurfacePaint>(Painted(), [](auto& p) { p.triangles[0][2] = 3; })},
      {".paint.shares",  // without a surface of its own, for another mesh
       Spoilt<SurfacePaint>(Painted(),
                            [](auto& p) {
                              p.vertices.clear();
                              p.triangles.clear();
                            })},
      {".paint",  // a hundred times as large, all round the body
       Spoilt<SurfacePaint>(Painted(),
                            [](auto& p) {
                              p.vertices = {{-50, -50, -50}, {150, -50, -50}, {-50, 150, 50}};
                            })},
      {".paint.shares", Spoilt<SurfacePaint>(Textured(),
                                             [](auto& p) {
                                               p.shares = {0, 1, 0};
                                             })},
      {".paint.texture.uvs",
       Spoilt<SurfacePaint>(Textured(), [](auto& p) { p.texture->uvs = {}; })},
      {".paint.texture.uvs[0]",
       Spoilt<SurfacePaint>(Textured(),
                            [](auto& p) { p.texture->uvs[0][5] = static_cast<float>(kNan); })},
      {".paint.texture.uvs[0]",
       Spoilt<SurfacePaint>(Textured(), [](auto& p) { p.texture->uvs[0][0] = -2e4f; })},
      {".paint.texture.file",
       Spoilt<SurfacePaint>(Textured(), [](auto& p) { p.texture->file = "worn.png"; })},
      {".paint.texture.channel",
       Spoilt<SurfacePaint>(Textured(),
                            [](auto& p) { p.texture->channel = TextureChannel::kAlpha; })},
      {".paint.texture.values",
       Spoilt<SurfacePaint>(Textured(), [](auto& p) { p.texture->values.pop_back(); })},
      {".paint.texture.width", Spoilt<SurfacePaint>(Textured(),
                                                    [](auto& p) {
                                                      p.texture->width = 0;
                                                      p.texture->values.clear();
                                                    })},
      {".paint.texture", Spoilt<SurfacePaint>(Textured(),
                                              [](auto& p) {
                                                p.texture->width = 65'536;
                                                p.texture->height = 65'536;
                                              })},
      {".paint",  // misses
       Spoilt<SurfacePaint>(Painted(),
                            [](auto& p) {
                              for (Vec3& vertex : p.vertices) vertex[2] = -3;
                            })},
      {".bands", Layer(BandField{.position = 3, .width = 0.1})},     // misses
      {".bands", Layer(BandField{.position = 0.25, .width = 0.1})},  // between two layers of nodes
      {".pockets", Layer(PocketField{2, 1e-6})},                     // smaller than cells
      // One node, and no edge.
      {".bands", WeakeningOnly(Layer(BandField{
                     .shape = BandShape::kSpheres, .center = {0.5, 0.5, 0.5}, .width = 0.1}))},
      {".node_set", OfTheLeft(Layer(BandField{.axis = {1, 0, 0}, .position = 1, .width = 0.1}))},
      {".node_set", OfTheLeft(WeakeningOnly(Layer(Across())))},  // one end of each edge
      {".node_set", OfTheLeft(Spoilt<Strokes>(Across(),
                                              [](auto& s) {
                                                s.curves = {{{{0.7, -1, 0}, {0.7, 2, 0}}}};
                                              }))},
      {".node_set", OfTheLeft(Spoilt<SegmentPattern>(Cross(),
                                                     [](auto& p) {
                                                       p.curves.erase(p.curves.begin());
                                                       p.origin = {0.8, 0.4, 0};
                                                     }))},
      {".node_set", OfTheLeft(Spoilt<SurfacePaint>(Painted(),
                                                   [](auto& p) {
                                                     p.vertices = {{1, 0, 0}, {1, 1, 0}, {1, 0, 1}};
                                                   }))},
  };
  for (const auto& [field, layer] : cases) {
    const Faults faults = Check(layer);
    ASSERT_EQ(faults.errors().size(), 1u) << field << ": " << faults.ToStatus();
    EXPECT_EQ(faults.errors()[0].field, "impurities.layers[1]" + field) << faults.ToStatus();
  }
}

TEST(ImpurityRules, AcceptLayersThatReachTheirSet) {
  ImpurityLayer near = Layer(Across());  // crosses no edge of the set, but falls off there
  std::get<Strokes>(near.source).curves = {{{{0.7, -1, 0}, {0.7, 2, 0}}}};
  near.falloff = 0.8;
  Strokes strokes = Across();
  strokes.curves = {{{{0.2, -1, 0}, {0.2, 2, 0}}}};
  SurfacePaint own;  // on the body's own surface
  own.shares.assign(27, 1);
  own.depth = 0.01;
  BandField bands{.axis = {1, 0, 0}, .position = 0, .width = 0.1};
  for (const ImpurityLayer& layer :
       {near, Layer(Across()), Layer(Cross()), Layer(strokes), Layer(own), Layer(bands),
        WeakeningOnly(Layer(bands)), Layer(PocketField{50, 0.5}), Layer(NoiseField{}),
        Layer(Painted())}) {
    const Faults faults = Check(OfTheLeft(layer));
    EXPECT_TRUE(faults.ok()) << layer.source.index() << ": " << faults.ToStatus();
  }
}

TEST(ImpurityRules, AcceptGroovesThatAreWiderThanTheirCurves) {
  Strokes dot = Across();  // within a cell: a punch
  dot.curves[0].points = {{0.4, 0.4, 0}, {0.4, 0.4, 0}};
  Strokes beside = Across();
  beside.curves[0].points = {{-0.1, -1, 0}, {-0.1, 2, 0}};
  for (Strokes strokes : {dot, beside}) {
    EXPECT_FALSE(Check(Layer(strokes)).ok());
    strokes.radius = 0.05;  // reaches no node
    EXPECT_FALSE(Check(Layer(strokes)).ok());
    strokes.radius = 0.2;
    const Faults faults = Check(Layer(strokes));
    EXPECT_TRUE(faults.ok()) << faults.ToStatus();
  }
  SegmentPattern pattern = Cross();
  pattern.origin = {-0.2, 0.4, 0};
  pattern.curves = {{{{0, -1}, {0, 1}}, {0.1, 0.1}}};
  EXPECT_FALSE(Check(Layer(pattern)).ok());
  pattern.curves[0].half_widths = {0.3, 0.3};
  EXPECT_TRUE(Check(Layer(pattern)).ok());
  // One node, and no edge.
  dot.curves[0].points = {{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}};
  dot.direction = {1, 0.3, 0.2};
  dot.radius = 0.05;
  EXPECT_TRUE(Check(Layer(dot)).ok());
  const Faults faults = Check(WeakeningOnly(Layer(dot)));
  ASSERT_EQ(faults.errors().size(), 1u);
  EXPECT_EQ(faults.errors()[0].field, "impurities.layers[1].strokes");
}

TEST(ImpurityRules, WarnOfValuesThatAreAllZero) {
  SurfacePaint black = Textured(), white = black, painted = Painted();
  black.texture->values = {0, 0};
  white.texture->values = {255, 255};
  white.texture->invert = true;
  painted.shares = {0, 0, 0};
  const std::vector<std::pair<std::string, ImpuritySource>> cases = {
      {".node_values.shares", NodeValues{std::vector<double>(27, 0)}},
      {".paint.shares", painted},
      {".paint.texture", black},
      {".paint.texture", white}};
  for (const auto& [field, source] : cases) {
    const Faults faults = Check(Layer(source));
    EXPECT_TRUE(faults.ok()) << faults.ToStatus();
    ASSERT_EQ(faults.warnings().size(), 1u) << field;
    EXPECT_EQ(faults.warnings()[0].field, "impurities.layers[1]" + field);
    EXPECT_THAT(faults.warnings()[0].description, HasSubstr("does nothing"));
  }
}

TEST(ImpurityRules, SayThatAStrokeMisses) {
  Strokes strokes = Across();
  strokes.curves[0].points = {{2, 0, 0}, {2, 1, 0}};
  EXPECT_THAT(Check(Layer(strokes)).ToStatus().message(), HasSubstr("misses the body"));
}

}  // namespace
}  // namespace cleave
