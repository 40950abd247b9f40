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

Faults Check(const ImpurityLayer& layer) {
  Impurities impurities;
  impurities.layers = {Layer(NoiseField{}), layer};
  Faults faults;
  CheckImpurities(impurities, {"left"}, faults);
  CheckImpuritiesOfMesh(impurities, Cube(), faults);
  return faults;
}

TEST(ImpurityRules, AcceptEverySource) {
  for (const ImpuritySource& source :
       {ImpuritySource(NodeValues{std::vector<double>(27, 0.5)}), ImpuritySource(NoiseField{}),
        ImpuritySource(BandField{.width = 0.1}), ImpuritySource(PocketField{3, 0.1}),
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
  };
  for (const auto& [field, layer] : cases) {
    const Faults faults = Check(layer);
    ASSERT_EQ(faults.errors().size(), 1u) << field << ": " << faults.ToStatus();
    EXPECT_EQ(faults.errors()[0].field, "impurities.layers[1]" + field) << faults.ToStatus();
  }
}

TEST(ImpurityRules, SayThatAStrokeMisses) {
  Strokes strokes = Across();
  strokes.curves[0].points = {{2, 0, 0}, {2, 1, 0}};
  EXPECT_THAT(Check(Layer(strokes)).ToStatus().message(), HasSubstr("misses the body"));
}

}  // namespace
}  // namespace cleave
