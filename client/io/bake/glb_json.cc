#include "client/io/bake/glb_json.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "client/io/bake/up_axis.h"
#include "client/io/export/number_text.h"

namespace cleave {
namespace {

// glTF's numbers.
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kVertices = 34962;
constexpr int kIndices = 34963;

// The longest text that AppendNumber gives a float.
constexpr absl::string_view kLongestFloat = "-1.17549435e-38";

float Linear(float coded) {
  return coded <= 0.04045f ? coded / 12.92f : std::pow((coded + 0.055f) / 1.055f, 2.4f);
}

class GlbJson {
 public:
  GlbJson(const BakeContext& context, const GlbLayout& layout, const GlbValues& values)
      : context_(context), layout_(layout), values_(values) {}

  std::string Write(bool longest) const {
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
    absl::StrAppend(&out, R"("buffers":[{"byteLength":)", layout_.bytes(), "}]}");
    return out;
  }

 private:
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
    for (size_t p = 0; p < layout_.primitives().size(); ++p) {
      const SurfaceMaterial& material = context_.materials.list()[layout_.primitives()[p].material];
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

  // Accessors of a primitive: indices, rest, normals, texture, piece, and what velocities are added
  // to; then those of its targets.
  size_t FirstTarget() const { return context_.velocities ? 6 : 5; }
  size_t AccessorsEach() const { return FirstTarget() + layout_.frames() * layout_.vectors_each(); }
  size_t TimeAccessor() const { return layout_.primitives().size() * AccessorsEach(); }

  void AddMesh(std::string& out) const {
    absl::StrAppend(&out, R"("meshes":[{"name":)", Name(), R"(,"primitives":[)");
    for (size_t p = 0; p < layout_.primitives().size(); ++p) {
      const size_t accessor = p * AccessorsEach();
      absl::StrAppend(&out, p == 0 ? "" : ",", R"({"material":)", p, R"(,"indices":)", accessor,
                      R"(,"attributes":{"POSITION":)", accessor + 1, R"(,"_REST":)", accessor + 1,
                      R"(,"NORMAL":)", accessor + 2, R"(,"TEXCOORD_0":)", accessor + 3,
                      R"(,"_PIECE":)", accessor + 4);
      if (context_.velocities) absl::StrAppend(&out, R"(,"_VELOCITY":)", accessor + 5);
      out += R"(},"targets":[)";
      for (size_t frame = 0; frame < layout_.frames(); ++frame) {
        const size_t target = accessor + FirstTarget() + frame * layout_.vectors_each();
        absl::StrAppend(&out, frame == 0 ? "" : ",", R"({"POSITION":)", target, R"(,"NORMAL":)",
                        target + 1);
        if (context_.velocities) absl::StrAppend(&out, R"(,"_VELOCITY":)", target + 2);
        out += '}';
      }
      out += "]}";
    }
    out += R"(],"weights":[)";
    for (uint64_t frame = 0; frame < layout_.frames(); ++frame) out += frame == 0 ? "0" : ",0";
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
    for (size_t p = 0; p < layout_.primitives().size(); ++p) {
      const GlbPrimitive& primitive = layout_.primitives()[p];
      AddAccessor(0, 4 * primitive.first_index, primitive.indices.size(), kUnsignedInt, "SCALAR",
                  out);
      out += '}';
      const uint64_t first = primitive.first_vertex;
      AddAccessor(1, kGlbVectorBytes * first, primitive.vertices, kFloat, "VEC3", out);
      AddBounds(values_.rest[p].low, values_.rest[p].high, false, out);
      out += '}';
      AddAccessor(2, kGlbVectorBytes * first, primitive.vertices, kFloat, "VEC3", out);
      out += '}';
      AddAccessor(3, 8 * first, primitive.vertices, kFloat, "VEC2", out);
      out += '}';
      AddAccessor(4, 4 * first, primitive.vertices, kFloat, "SCALAR", out);
      out += '}';
      if (context_.velocities) {  // without a view it is all zeros
        absl::StrAppend(&out, R"(,{"componentType":)", kFloat, R"(,"count":)", primitive.vertices,
                        R"(,"type":"VEC3"})");
      }
      for (uint64_t frame = 0; frame < layout_.frames(); ++frame) {
        const uint64_t offset = frame * layout_.target_bytes() + kGlbVectorBytes * first;
        AddAccessor(5, offset, primitive.vertices, kFloat, "VEC3", out);
        const GlbBounds& bounds = values_.targets[frame * layout_.primitives().size() + p];
        AddBounds(bounds.low, bounds.high, longest, out);
        out += '}';
        for (uint64_t vector = 1; vector < layout_.vectors_each(); ++vector) {
          AddAccessor(5, offset + vector * layout_.vector_bytes(), primitive.vertices, kFloat,
                      "VEC3", out);
          out += '}';
        }
      }
    }
    const auto count = layout_.frames();
    AddAccessor(6, 0, count, kFloat, "SCALAR", out);
    AddBounds<1>({values_.times.front()}, {values_.times.back()}, longest, out);
    out += '}';
    AddAccessor(6, 4 * count, count * count, kFloat, "SCALAR", out);
    out += "}],";
  }

  void AddViews(std::string& out) const {
    struct View {
      uint64_t begin, end;
      int stride, target;
    };
    const std::array<View, 7> views = {
        {{0, layout_.RestOffset(), 0, kIndices},
         {layout_.RestOffset(), layout_.NormalOffset(), 12, kVertices},
         {layout_.NormalOffset(), layout_.UvOffset(), 12, kVertices},
         {layout_.UvOffset(), layout_.PieceOffset(), 8, kVertices},
         {layout_.PieceOffset(), layout_.TargetOffset(), 4, kVertices},
         {layout_.TargetOffset(), layout_.TimeOffset(), 12, kVertices},
         {layout_.TimeOffset(), layout_.bytes(), 0, 0}}};
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
  const GlbLayout& layout_;
  const GlbValues& values_;
};

}  // namespace

std::string EncodeGlbJson(const BakeContext& context, const GlbLayout& layout,
                          const GlbValues& values, bool longest) {
  return GlbJson(context, layout, values).Write(longest);
}

}  // namespace cleave
