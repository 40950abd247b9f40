#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "client/io/bake/bake_codec.h"
#include "client/io/bake/up_axis.h"
#include "client/io/export/number_text.h"
#include "core/base/bytes.h"
#include "core/base/status.h"

namespace cleave {
namespace {

constexpr uint64_t kMostBytes = std::numeric_limits<uint32_t>::max();
constexpr uint64_t kVectorBytes = 12;

// glTF's numbers.
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kVertices = 34962;
constexpr int kIndices = 34963;

// The longest text that AppendNumber gives a float.
constexpr absl::string_view kLongestFloat = "-1.17549435e-38";

struct Bounds {
  std::array<float, 3> low{};
  std::array<float, 3> high{};
};

// What is drawn in one material: vertices of its own, as a range of all of them.
struct Primitive {
  size_t material = 0;
  size_t first_vertex = 0;
  size_t vertices = 0;
  size_t first_index = 0;
  std::vector<uint32_t> indices;
};

float Linear(float coded) {
  return coded <= 0.04045f ? coded / 12.92f : std::pow((coded + 0.055f) / 1.055f, 2.4f);
}

class Glb : public BakeCodec {
 public:
  explicit Glb(const BakeContext& context) : context_(context) {
    FindPrimitives();
    rest_bounds_.resize(primitives_.size());
    for (size_t p = 0; p < primitives_.size(); ++p) {
      rest_bounds_[p] = BoundsOf(primitives_[p], [&](size_t point) { return Rest(point); });
    }
    target_bounds_.resize(primitives_.size() * static_cast<size_t>(frames()));
    times_.resize(static_cast<size_t>(frames()));
    if (BinaryBytes() <= kMostBytes) json_bytes_ = (Json(true).size() + 3) / 4 * 4;
  }

  uint64_t TotalBytes() const { return 12 + 8 + json_bytes_ + 8 + BinaryBytes(); }
  uint64_t target_bytes() const { return vertices() * TargetStride(); }

  std::string Begin() const override {
    std::string out = HeadWith(std::string(json_bytes_, ' '));
    ByteWriter writer(out);
    for (const Primitive& primitive : primitives_) {
      for (const uint32_t index : primitive.indices) writer.Put(index);
    }
    for (const auto& [point, axis] : vertices_) {
      for (const float value : Rest(point)) writer.Put(value);
    }
    for (const auto& [point, axis] : vertices_) {
      const auto [u, v] = RestUv(context_.surface.topology.points[point].rest, axis);
      writer.Put(static_cast<float>(u));
      writer.Put(static_cast<float>(1 - v));  // glTF's v points down the picture
    }
    for (const auto& [point, axis] : vertices_) {
      writer.Put(static_cast<float>(context_.surface.point_pieces[point]));
    }
    return out;
  }

  absl::Status Note(int64_t, const BakeFrame& frame) override {
    const auto i = static_cast<size_t>(frame.index);
    const BakeTiming& timing = context_.timing;
    times_[i] = static_cast<float>(timing.playback_rate.has_value()
                                       ? static_cast<double>(frame.frame - timing.first_frame) /
                                             *timing.playback_rate
                                       : frame.time - timing.first_time);
    if (i > 0 && !(times_[i] > times_[i - 1])) {
      return absl::InvalidArgumentError(
          absl::StrCat("time: frame ", frame.frame, " is shown at ", times_[i],
                       " s, not after the frame before; glTF needs times that grow"));
    }
    for (size_t p = 0; p < primitives_.size(); ++p) {
      target_bounds_[i * primitives_.size() + p] =
          BoundsOf(primitives_[p], [&](size_t point) { return Displacement(frame.points, point); });
    }
    return absl::OkStatus();
  }

  void Encode(int64_t, const BakeFrame& frame, std::string& out) const override {
    ByteWriter writer(out);
    for (const auto& [point, axis] : vertices_) {
      for (const float value : Displacement(frame.points, point)) writer.Put(value);
    }
    if (!context_.velocities) return;
    for (const auto& [point, axis] : vertices_) {
      for (const double value : frame.velocities[point]) writer.Put(static_cast<float>(value));
    }
  }

  std::string End() const override {
    std::string out;
    ByteWriter writer(out);
    for (const float time : times_) writer.Put(time);
    for (int64_t frame = 0; frame < frames(); ++frame) {
      for (int64_t target = 0; target < frames(); ++target) {
        writer.Put(frame == target ? 1.0f : 0.0f);
      }
    }
    return out;
  }

  std::string Head() const override {
    std::string json = Json(false);
    json.resize(json_bytes_, ' ');
    return HeadWith(json);
  }

 private:
  int64_t frames() const { return context_.timing.count; }
  uint64_t vertices() const { return vertices_.size(); }
  uint64_t TargetStride() const { return context_.velocities ? 2 * kVectorBytes : kVectorBytes; }

  // A vertex is a point as one material shows it from one direction of texture.
  void FindPrimitives() {
    const SurfaceTopology& topology = context_.surface.topology;
    std::map<size_t, std::vector<size_t>> by_material;
    for (size_t i = 0; i < topology.triangles.size(); ++i) {
      by_material[context_.materials.IndexOf(context_.surface.triangle_regions[i],
                                             topology.inside[i] != 0)]
          .push_back(i);
    }
    for (const auto& [material, triangles] : by_material) {
      Primitive primitive{material, vertices_.size(), 0, index_count_, {}};
      std::map<std::pair<size_t, size_t>, uint32_t> places;
      for (const size_t triangle : triangles) {
        const auto& [a, b, c] = topology.triangles[triangle];
        const auto rest = [&](int32_t p) { return topology.points[static_cast<size_t>(p)].rest; };
        const size_t axis = FacedAxis(rest(a), rest(b), rest(c));
        for (const int32_t point : topology.triangles[triangle]) {
          const std::pair vertex{static_cast<size_t>(point), axis};
          const auto [place, is_new] =
              places.try_emplace(vertex, static_cast<uint32_t>(places.size()));
          if (is_new) vertices_.push_back(vertex);
          primitive.indices.push_back(place->second);
        }
      }
      primitive.vertices = places.size();
      index_count_ += primitive.indices.size();
      primitives_.push_back(std::move(primitive));
    }
  }

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
  Bounds BoundsOf(const Primitive& primitive, const F& value) const {
    constexpr float kLarge = std::numeric_limits<float>::infinity();
    Bounds bounds{{kLarge, kLarge, kLarge}, {-kLarge, -kLarge, -kLarge}};
    for (size_t i = 0; i < primitive.vertices; ++i) {
      const std::array<float, 3> at = value(vertices_[primitive.first_vertex + i].first);
      for (size_t k = 0; k < 3; ++k) {
        bounds.low[k] = std::min(bounds.low[k], at[k]);
        bounds.high[k] = std::max(bounds.high[k], at[k]);
      }
    }
    return bounds;
  }

  uint64_t RestOffset() const { return 4 * index_count_; }
  uint64_t UvOffset() const { return RestOffset() + kVectorBytes * vertices(); }
  uint64_t PieceOffset() const { return UvOffset() + 8 * vertices(); }
  uint64_t TargetOffset() const { return PieceOffset() + 4 * vertices(); }
  uint64_t TimeOffset() const {
    return TargetOffset() + static_cast<uint64_t>(frames()) * target_bytes();
  }
  uint64_t BinaryBytes() const {
    const auto count = static_cast<uint64_t>(frames());
    return TimeOffset() + 4 * count + 4 * count * count;
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
    writer.Put(static_cast<uint32_t>(BinaryBytes()));
    out.append("BIN\0", 4);
    return out;
  }

  // The scene's description. Bounds and times that are not known yet are as long as they may get.
  std::string Json(bool longest) const {
    std::string out = absl::StrCat(
        R"({"asset":{"version":"2.0","generator":"Cleave","extras":{"made_from":")",
        context_.comment, R"("}},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":)", Name(),
        R"(,"mesh":0,"rotation":[)");
    bool first = true;
    for (const double value : RotationToY(context_.up)) {
      if (!std::exchange(first, false)) out += ',';
      AppendNumber(value, out);
    }
    absl::StrAppend(&out, R"(],"extras":{"pieces":)", context_.surface.pieces.size(),
                    R"(,"first_frame":)", context_.timing.first_frame, "}}],");
    AddMaterials(out);
    AddMesh(out);
    absl::StrAppend(
        &out, R"("animations":[{"name":)", Name(),
        R"(,"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}],"samplers":[{"input":)",
        TimeAccessor(), R"(,"output":)", TimeAccessor() + 1, R"(,"interpolation":"LINEAR"}]}],)");
    AddAccessors(longest, out);
    AddViews(out);
    absl::StrAppend(&out, R"("buffers":[{"byteLength":)", BinaryBytes(), "}]}");
    return out;
  }

  // The object's name as JSON.
  std::string Name() const {
    std::string out = "\"";
    for (const char letter : context_.name) {
      const bool plain =
          static_cast<unsigned char>(letter) >= 0x20 && letter != '"' && letter != '\\';
      out += plain ? letter : '_';
    }
    return out + '"';
  }

  void AddMaterials(std::string& out) const {
    out += R"("materials":[)";
    for (size_t p = 0; p < primitives_.size(); ++p) {
      const SurfaceMaterial& material = context_.materials.list()[primitives_[p].material];
      absl::StrAppend(&out, p == 0 ? "" : ",", R"({"name":")", material.name,
                      R"(","pbrMetallicRoughness":{"baseColorFactor":[)");
      for (const float channel : material.color) {
        AppendNumber(Linear(channel), out);
        out += ',';
      }
      absl::StrAppend(&out, R"(1],"metallicFactor":0,"roughnessFactor":0.8},"extras":{"region":)",
                      material.region, R"(,"inside":)", material.inside ? "true" : "false", "}}");
    }
    out += "],";
  }

  // Accessors of a primitive: indices, rest, texture, piece, and what velocities are added to; then
  // those of its targets.
  size_t FirstTarget() const { return context_.velocities ? 5 : 4; }
  size_t AccessorsEach() const {
    return FirstTarget() + static_cast<size_t>(frames()) * (context_.velocities ? 2 : 1);
  }
  size_t TimeAccessor() const { return primitives_.size() * AccessorsEach(); }

  void AddMesh(std::string& out) const {
    absl::StrAppend(&out, R"("meshes":[{"name":)", Name(), R"(,"primitives":[)");
    for (size_t p = 0; p < primitives_.size(); ++p) {
      const size_t accessor = p * AccessorsEach();
      absl::StrAppend(&out, p == 0 ? "" : ",", R"({"material":)", p, R"(,"indices":)", accessor,
                      R"(,"attributes":{"POSITION":)", accessor + 1, R"(,"_REST":)", accessor + 1,
                      R"(,"TEXCOORD_0":)", accessor + 2, R"(,"_PIECE":)", accessor + 3);
      if (context_.velocities) absl::StrAppend(&out, R"(,"_VELOCITY":)", accessor + 4);
      out += R"(},"targets":[)";
      for (size_t frame = 0; frame < static_cast<size_t>(frames()); ++frame) {
        const size_t target = accessor + FirstTarget() + frame * (context_.velocities ? 2 : 1);
        absl::StrAppend(&out, frame == 0 ? "" : ",", R"({"POSITION":)", target);
        if (context_.velocities) absl::StrAppend(&out, R"(,"_VELOCITY":)", target + 1);
        out += '}';
      }
      out += "]}";
    }
    out += R"(],"weights":[)";
    for (int64_t frame = 0; frame < frames(); ++frame) out += frame == 0 ? "0" : ",0";
    out += "]}],";
  }

  static void AddAccessor(int view, uint64_t offset, uint64_t count, int component,
                          absl::string_view type, std::string& out) {
    absl::StrAppend(&out, out.back() == '[' ? "" : ",", R"({"bufferView":)", view,
                    R"(,"byteOffset":)", offset, R"(,"componentType":)", component, R"(,"count":)",
                    count, R"(,"type":")", type, "\"");
  }
  template <size_t N>
  static void AddBounds(const std::array<float, N>& low, const std::array<float, N>& high,
                        bool longest, std::string& out) {
    for (const auto* bound : {&low, &high}) {
      out += bound == &low ? R"(,"min":[)" : R"(,"max":[)";
      for (size_t k = 0; k < N; ++k) {
        if (k > 0) out += ',';
        if (longest) {
          absl::StrAppend(&out, kLongestFloat);
        } else {
          AppendNumber((*bound)[k], out);
        }
      }
      out += ']';
    }
  }

  void AddAccessors(bool longest, std::string& out) const {
    out += R"("accessors":[)";
    for (size_t p = 0; p < primitives_.size(); ++p) {
      const Primitive& primitive = primitives_[p];
      AddAccessor(0, 4 * primitive.first_index, primitive.indices.size(), kUnsignedInt, "SCALAR",
                  out);
      out += '}';
      const uint64_t first = primitive.first_vertex;
      AddAccessor(1, kVectorBytes * first, primitive.vertices, kFloat, "VEC3", out);
      AddBounds(rest_bounds_[p].low, rest_bounds_[p].high, false, out);
      out += '}';
      AddAccessor(2, 8 * first, primitive.vertices, kFloat, "VEC2", out);
      out += '}';
      AddAccessor(3, 4 * first, primitive.vertices, kFloat, "SCALAR", out);
      out += '}';
      if (context_.velocities) {  // without a view it is all zeros
        absl::StrAppend(&out, R"(,{"componentType":)", kFloat, R"(,"count":)", primitive.vertices,
                        R"(,"type":"VEC3"})");
      }
      for (uint64_t frame = 0; frame < static_cast<uint64_t>(frames()); ++frame) {
        const uint64_t offset = frame * target_bytes() + kVectorBytes * first;
        AddAccessor(4, offset, primitive.vertices, kFloat, "VEC3", out);
        const Bounds& bounds = target_bounds_[frame * primitives_.size() + p];
        AddBounds(bounds.low, bounds.high, longest, out);
        out += '}';
        if (!context_.velocities) continue;
        AddAccessor(4, offset + kVectorBytes * vertices(), primitive.vertices, kFloat, "VEC3", out);
        out += '}';
      }
    }
    const auto count = static_cast<uint64_t>(frames());
    AddAccessor(5, 0, count, kFloat, "SCALAR", out);
    AddBounds<1>({times_.front()}, {times_.back()}, longest, out);
    out += '}';
    AddAccessor(5, 4 * count, count * count, kFloat, "SCALAR", out);
    out += "}],";
  }

  void AddViews(std::string& out) const {
    struct View {
      uint64_t begin, end;
      int stride, target;
    };
    const std::array<View, 6> views = {{{0, RestOffset(), 0, kIndices},
                                        {RestOffset(), UvOffset(), 12, kVertices},
                                        {UvOffset(), PieceOffset(), 8, kVertices},
                                        {PieceOffset(), TargetOffset(), 4, kVertices},
                                        {TargetOffset(), TimeOffset(), 12, kVertices},
                                        {TimeOffset(), BinaryBytes(), 0, 0}}};
    out += R"("bufferViews":[)";
    for (const View& view : views) {
      absl::StrAppend(&out, view.begin == 0 ? "" : ",", R"({"buffer":0,"byteOffset":)", view.begin,
                      R"(,"byteLength":)", view.end - view.begin);
      if (view.stride != 0) absl::StrAppend(&out, R"(,"byteStride":)", view.stride);
      if (view.target != 0) absl::StrAppend(&out, R"(,"target":)", view.target);
      out += '}';
    }
    out += "],";
  }

  const BakeContext& context_;
  std::vector<Primitive> primitives_;
  std::vector<std::pair<size_t, size_t>> vertices_;  // a point, and the axis of its texture
  size_t index_count_ = 0;
  std::vector<Bounds> rest_bounds_;    // a primitive each
  std::vector<Bounds> target_bounds_;  // a frame each, and in it a primitive
  std::vector<float> times_;           // s
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
