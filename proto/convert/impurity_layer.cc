#include "proto/convert/impurity_layer.h"

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "core/scene/checker.h"
#include "core/scene/limits.h"
#include "proto/convert/field_reader.h"

namespace cleave {
namespace {

class LayerReader {
 public:
  LayerReader(std::string field, const FieldReader& read) : field_(std::move(field)), read_(read) {}

  ImpuritySource Source(const v1::ImpurityLayer& message) {
    switch (message.source_case()) {
      case v1::ImpurityLayer::kNodeValues:
        return NodeValues{Values(message.node_values().shares()), message.node_values().file(),
                          message.node_values().array()};
      case v1::ImpurityLayer::kNoise:
        return NoiseField{read_.AfterUnspecified<NoiseDistribution>(
                              At("noise.distribution"), message.noise().distribution(), 2),
                          message.noise().correlation_length()};
      case v1::ImpurityLayer::kBands:
        return Bands(message.bands());
      case v1::ImpurityLayer::kPockets:
        return PocketField{message.pockets().count(), message.pockets().radius()};
      case v1::ImpurityLayer::kStrokes:
        return StrokesOf(message.strokes());
      case v1::ImpurityLayer::kPattern:
        return Pattern(message.pattern());
      case v1::ImpurityLayer::kPaint:
        return Paint(message.paint());
      case v1::ImpurityLayer::SOURCE_NOT_SET:
        break;
    }
    return std::monostate{};
  }

 private:
  std::string At(absl::string_view name) const { return absl::StrCat(field_, ".", name); }

  static std::vector<double> Values(const Numbers& numbers) {
    return {numbers.begin(), numbers.end()};
  }

  BandField Bands(const v1::BandField& message) {
    BandField bands;
    bands.shape = read_.AfterUnspecified<BandShape>(At("bands.shape"), message.shape(), 3);
    bands.center = read_.Vector(At("bands.center"), message.center(), bands.center);
    bands.axis = read_.Vector(At("bands.axis"), message.axis(), bands.axis);
    bands.position = message.position();
    bands.width = message.width();
    if (message.has_spacing()) bands.spacing = message.spacing();
    return bands;
  }

  Strokes StrokesOf(const v1::Strokes& message) {
    Strokes strokes;
    for (int c = 0; c < message.curves_size(); ++c) {
      strokes.curves.push_back({read_.Groups<3>(At(absl::StrCat("strokes.curves[", c, "].points")),
                                                message.curves(c).points())});
    }
    strokes.direction =
        read_.Vector(At("strokes.direction"), message.direction(), strokes.direction);
    if (message.has_depth()) strokes.depth = message.depth();
    strokes.radius = message.radius();
    return strokes;
  }

  SegmentPattern Pattern(const v1::SegmentPattern& message) {
    SegmentPattern pattern;
    for (int c = 0; c < message.curves_size(); ++c) {
      pattern.curves.push_back({read_.Groups<2>(At(absl::StrCat("pattern.curves[", c, "].points")),
                                                message.curves(c).points()),
                                Values(message.curves(c).half_widths())});
    }
    if (message.has_image()) pattern.image = ImageFromMessage(message.image());
    pattern.origin = read_.Vector(At("pattern.origin"), message.origin(), pattern.origin);
    pattern.direction =
        read_.Vector(At("pattern.direction"), message.direction(), pattern.direction);
    pattern.up = read_.Vector(At("pattern.up"), message.up(), pattern.up);
    pattern.rotation = message.rotation();
    if (message.has_scale()) pattern.scale = message.scale();
    if (message.has_depth()) pattern.depth = message.depth();
    return pattern;
  }

  SurfacePaint Paint(const v1::SurfacePaint& message) {
    SurfacePaint paint;
    paint.shares = Values(message.shares());
    paint.vertices = read_.Groups<3>(At("paint.vertices"), message.vertices());
    if (message.has_unit_scale()) {
      Checker(read_.faults())
          .Above(At("paint.unit_scale"), message.unit_scale(), 0, limits::kMaxUnitScale);
      for (Vec3& vertex : paint.vertices)
        for (double& coordinate : vertex) coordinate *= message.unit_scale();
    }
    paint.triangles = read_.Groups<3>(At("paint.triangles"), message.triangles());
    paint.depth = message.depth();
    paint.file = message.file();
    paint.array = message.array();
    if (message.has_texture()) paint.texture = Texture(message.texture());
    return paint;
  }

  SurfaceTexture Texture(const v1::SurfaceTexture& message) {
    SurfaceTexture texture;
    texture.width = message.width();
    texture.height = message.height();
    texture.values.assign(message.values().begin(), message.values().end());
    texture.uvs = read_.Groups<6>(At("paint.texture.uvs"), message.uvs());
    texture.wrap = read_.AfterUnspecified<TextureWrap>(At("paint.texture.wrap"), message.wrap(), 3);
    texture.invert = message.invert();
    texture.file = message.file();
    texture.channel =
        read_.AfterUnspecified<TextureChannel>(At("paint.texture.channel"), message.channel(), 5);
    return texture;
  }

  const std::string field_;
  const FieldReader& read_;
};

void Write(const Vec3& vector, Numbers* numbers) { numbers->Add(vector.begin(), vector.end()); }

struct WriteImpuritySource {
  v1::ImpurityLayer& message;

  void operator()(std::monostate) const {}
  void operator()(const NodeValues& values) const {
    v1::NodeValues& to = *message.mutable_node_values();
    to.mutable_shares()->Add(values.shares.begin(), values.shares.end());
    to.set_file(values.file);
    to.set_array(values.array);
  }
  void operator()(const NoiseField& noise) const {
    message.mutable_noise()->set_distribution(
        static_cast<v1::NoiseDistribution>(static_cast<int>(noise.distribution) + 1));
    message.mutable_noise()->set_correlation_length(noise.correlation_length);
  }
  void operator()(const BandField& bands) const {
    v1::BandField& to = *message.mutable_bands();
    to.set_shape(static_cast<v1::BandShape>(static_cast<int>(bands.shape) + 1));
    Write(bands.center, to.mutable_center());
    Write(bands.axis, to.mutable_axis());
    to.set_position(bands.position);
    to.set_width(bands.width);
    if (bands.spacing) to.set_spacing(*bands.spacing);
  }
  void operator()(const PocketField& pockets) const {
    message.mutable_pockets()->set_count(pockets.count);
    message.mutable_pockets()->set_radius(pockets.radius);
  }
  void operator()(const Strokes& strokes) const {
    v1::Strokes& to = *message.mutable_strokes();
    for (const Polyline& curve : strokes.curves) {
      v1::Polyline& line = *to.add_curves();
      for (const Vec3& point : curve.points) Write(point, line.mutable_points());
    }
    Write(strokes.direction, to.mutable_direction());
    if (strokes.depth) to.set_depth(*strokes.depth);
    to.set_radius(strokes.radius);
  }
  void operator()(const SegmentPattern& pattern) const {
    v1::SegmentPattern& to = *message.mutable_pattern();
    WriteCurves(pattern.curves, *to.mutable_curves());
    if (pattern.image) {
      v1::ImageDrawing& image = *to.mutable_image();
      image.set_file(pattern.image->file);
      image.set_threshold(pattern.image->threshold);
      image.set_bright(pattern.image->bright);
      image.set_keep_width(pattern.image->keep_width);
      image.set_tolerance(pattern.image->tolerance);
    }
    Write(pattern.origin, to.mutable_origin());
    Write(pattern.direction, to.mutable_direction());
    Write(pattern.up, to.mutable_up());
    to.set_rotation(pattern.rotation);
    to.set_scale(pattern.scale);
    if (pattern.depth) to.set_depth(*pattern.depth);
  }
  void operator()(const SurfacePaint& paint) const {
    v1::SurfacePaint& to = *message.mutable_paint();
    to.mutable_shares()->Add(paint.shares.begin(), paint.shares.end());
    for (const Vec3& vertex : paint.vertices) Write(vertex, to.mutable_vertices());
    for (const auto& triangle : paint.triangles)
      to.mutable_triangles()->Add(triangle.begin(), triangle.end());
    to.set_depth(paint.depth);
    to.set_file(paint.file);
    to.set_array(paint.array);
    if (!paint.texture) return;
    v1::SurfaceTexture& texture = *to.mutable_texture();
    texture.set_width(paint.texture->width);
    texture.set_height(paint.texture->height);
    texture.set_values(std::string(paint.texture->values.begin(), paint.texture->values.end()));
    for (const auto& corners : paint.texture->uvs)
      texture.mutable_uvs()->Add(corners.begin(), corners.end());
    texture.set_wrap(static_cast<v1::TextureWrap>(static_cast<int>(paint.texture->wrap) + 1));
    texture.set_invert(paint.texture->invert);
    texture.set_file(paint.texture->file);
    texture.set_channel(
        static_cast<v1::TextureChannel>(static_cast<int>(paint.texture->channel) + 1));
  }
};

}  // namespace

ImpurityLayer LayerFromMessage(const v1::ImpurityLayer& message, const std::string& field,
                               Faults& faults) {
  const FieldReader fields(faults);
  LayerReader read(field, fields);
  ImpurityLayer layer;
  layer.name = message.name();
  layer.source = read.Source(message);
  layer.node_set = message.node_set();
  if (message.has_potency()) layer.potency = message.potency();
  if (message.has_weakening()) layer.weakening = message.weakening();
  layer.blend = fields.AfterUnspecified<Blend>(field + ".blend", message.blend(), 3);
  layer.falloff = message.falloff();
  layer.falloff_shape =
      fields.AfterUnspecified<FalloffShape>(field + ".falloff_shape", message.falloff_shape(), 2);
  if (message.has_seed()) layer.seed = message.seed();
  return layer;
}

void WriteLayer(const ImpurityLayer& layer, v1::ImpurityLayer& message) {
  message.set_name(layer.name);
  std::visit(WriteImpuritySource{message}, layer.source);
  message.set_node_set(layer.node_set);
  if (layer.potency) message.set_potency(*layer.potency);
  if (layer.weakening) message.set_weakening(*layer.weakening);
  message.set_blend(static_cast<v1::Blend>(static_cast<int>(layer.blend) + 1));
  message.set_falloff(layer.falloff);
  message.set_falloff_shape(
      static_cast<v1::FalloffShape>(static_cast<int>(layer.falloff_shape) + 1));
  if (layer.seed) message.set_seed(*layer.seed);
}

ImageDrawing ImageFromMessage(const v1::ImageDrawing& message) {
  ImageDrawing image;
  image.file = message.file();
  if (message.has_threshold()) image.threshold = message.threshold();
  image.bright = message.bright();
  image.keep_width = message.keep_width();
  if (message.has_tolerance()) image.tolerance = message.tolerance();
  return image;
}

void WriteCurves(const std::vector<DrawnCurve>& curves,
                 google::protobuf::RepeatedPtrField<v1::DrawnCurve>& message) {
  for (const DrawnCurve& curve : curves) {
    v1::DrawnCurve& line = *message.Add();
    for (const auto& point : curve.points) line.mutable_points()->Add(point.begin(), point.end());
    line.mutable_half_widths()->Add(curve.half_widths.begin(), curve.half_widths.end());
  }
}

}  // namespace cleave
