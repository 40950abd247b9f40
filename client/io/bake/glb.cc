#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "client/io/bake/bake_codec.h"
#include "client/io/bake/glb_json.h"
#include "client/io/bake/glb_layout.h"
#include "core/base/bytes.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr uint64_t kMostBytes = std::numeric_limits<uint32_t>::max();

class Glb : public BakeCodec {
 public:
  explicit Glb(const BakeContext& context) : context_(context), layout_(context) {
    std::vector<Vec3> rest_points;
    for (const SurfacePoint& point : context.surface.topology.points)
      rest_points.push_back(point.rest);
    layout_.normals().Find(rest_points, rest_normals_);
    values_.rest.resize(primitives().size());
    for (size_t p = 0; p < primitives().size(); ++p) {
      values_.rest[p] = BoundsOf(primitives()[p], [&](size_t point) { return Rest(point); });
    }
    values_.targets.resize(primitives().size() * static_cast<size_t>(frames()));
    values_.times.resize(static_cast<size_t>(frames()));
    if (layout_.bytes() <= kMostBytes)
      json_bytes_ = (EncodeGlbJson(context_, layout_, values_, true).size() + 3) / 4 * 4;
  }

  uint64_t TotalBytes() const { return 12 + 8 + json_bytes_ + 8 + layout_.bytes(); }
  uint64_t target_bytes() const { return layout_.target_bytes(); }

  std::string Begin() const override {
    std::string out = HeadWith(std::string(json_bytes_, ' '));
    ByteWriter writer(out);
    for (const GlbPrimitive& primitive : primitives()) {
      for (const uint32_t index : primitive.indices) writer.Put(index);
    }
    for (const GlbVertex& vertex : layout_.vertices()) {
      for (const float value : Rest(vertex.point)) writer.Put(value);
    }
    for (const GlbVertex& vertex : layout_.vertices()) {
      for (const float value : rest_normals_[vertex.normal]) writer.Put(value);
    }
    for (const GlbVertex& vertex : layout_.vertices()) {
      writer.Put(vertex.uv[0]);
      writer.Put(1 - vertex.uv[1]);  // glTF's v points down the picture
    }
    for (const GlbVertex& vertex : layout_.vertices()) {
      writer.Put(static_cast<float>(context_.surface.point_pieces[vertex.point]));
    }
    return out;
  }

  absl::Status Note(int64_t, const BakeFrame& frame) override {
    const auto i = static_cast<size_t>(frame.index);
    const BakeTiming& timing = context_.timing;
    values_.times[i] = static_cast<float>(
        timing.playback_rate.has_value()
            ? static_cast<double>(frame.frame - timing.first_frame) / *timing.playback_rate
            : frame.time - timing.first_time);
    if (i > 0 && !(values_.times[i] > values_.times[i - 1])) {
      return absl::InvalidArgumentError(
          absl::StrCat("time: frame ", frame.frame, " is shown at ", values_.times[i],
                       " s, not after the frame before; glTF needs times that grow"));
    }
    for (size_t p = 0; p < primitives().size(); ++p) {
      values_.targets[i * primitives().size() + p] = BoundsOf(
          primitives()[p], [&](size_t point) { return Displacement(frame.points, point); });
    }
    return absl::OkStatus();
  }

  void Encode(int64_t, const BakeFrame& frame, std::string& out) const override {
    ByteWriter writer(out);
    for (const GlbVertex& vertex : layout_.vertices()) {
      for (const float value : Displacement(frame.points, vertex.point)) writer.Put(value);
    }
    std::vector<std::array<float, 3>> normals;
    layout_.normals().Find(frame.points, normals);
    for (const GlbVertex& vertex : layout_.vertices()) {
      for (size_t k = 0; k < 3; ++k)
        writer.Put(normals[vertex.normal][k] - rest_normals_[vertex.normal][k]);
    }
    if (!context_.velocities) return;
    for (const GlbVertex& vertex : layout_.vertices()) {
      for (const double value : frame.velocities[vertex.point])
        writer.Put(static_cast<float>(value));
    }
  }

  std::string End() const override {
    std::string out;
    ByteWriter writer(out);
    for (const float time : values_.times) writer.Put(time);
    for (int64_t frame = 0; frame < frames(); ++frame) {
      for (int64_t target = 0; target < frames(); ++target) {
        writer.Put(frame == target ? 1.0f : 0.0f);
      }
    }
    return out;
  }

  std::string Head() const override {
    std::string json = EncodeGlbJson(context_, layout_, values_, false);
    json.resize(json_bytes_, ' ');
    return HeadWith(json);
  }

 private:
  int64_t frames() const { return context_.timing.count; }
  const std::vector<GlbPrimitive>& primitives() const { return layout_.primitives(); }

  std::array<float, 3> Rest(size_t point) const {
    const Vec3& rest = context_.surface.topology.points[point].rest;
    return {static_cast<float>(rest[0]), static_cast<float>(rest[1]), static_cast<float>(rest[2])};
  }
  // From the rest position as the file has it, so that the sum is as near as floats allow.
  std::array<float, 3> Displacement(const std::vector<Vec3>& points, size_t point) const {
    const std::array<float, 3> rest = Rest(point);
    std::array<float, 3> moved{};
    for (size_t k = 0; k < 3; ++k) {
      moved[k] = static_cast<float>(points[point][k] - static_cast<double>(rest[k]));
    }
    return moved;
  }
  template <typename F>
  GlbBounds BoundsOf(const GlbPrimitive& primitive, const F& value) const {
    constexpr float kLarge = std::numeric_limits<float>::infinity();
    GlbBounds bounds{{kLarge, kLarge, kLarge}, {-kLarge, -kLarge, -kLarge}};
    for (size_t i = 0; i < primitive.vertices; ++i) {
      const std::array<float, 3> at = value(layout_.vertices()[primitive.first_vertex + i].point);
      for (size_t k = 0; k < 3; ++k) {
        bounds.low[k] = std::min(bounds.low[k], at[k]);
        bounds.high[k] = std::max(bounds.high[k], at[k]);
      }
    }
    return bounds;
  }

  // Everything before the binary data.
  std::string HeadWith(absl::string_view json) const {
    std::string out = "glTF";
    ByteWriter writer(out);
    writer.Put<uint32_t>(2);
    writer.Put(static_cast<uint32_t>(TotalBytes()));
    writer.Put(static_cast<uint32_t>(json.size()));
    out += "JSON";
    writer.PutBytes(json);
    writer.Put(static_cast<uint32_t>(layout_.bytes()));
    out.append("BIN\0", 4);
    return out;
  }

  const BakeContext& context_;
  const GlbLayout layout_;
  std::vector<std::array<float, 3>> rest_normals_;  // of NormalGroups
  GlbValues values_;
  size_t json_bytes_ = 0;
};

}  // namespace

absl::StatusOr<std::unique_ptr<BakeCodec>> MakeGlb(const BakeContext& context) {
  auto glb = std::make_unique<Glb>(context);
  if (glb->TotalBytes() > kMostBytes) {
    return absl::InvalidArgumentError(absl::StrCat(
        context.timing.count, " frames of ", glb->target_bytes(), " bytes make a GLB of ",
        glb->TotalBytes(), " bytes, above the ", kMostBytes,
        " that its header can tell: take fewer frames (--stride, --last) or a point cache"));
  }
  return std::unique_ptr<BakeCodec>(std::move(glb));
}

}  // namespace cleave
