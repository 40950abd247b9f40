#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "client/io/bake/bake_codec.h"
#include "client/io/bake/up_axis.h"
#include "client/io/export/number_text.h"
#include "core/base/status.h"

namespace cleave {
namespace {

struct Extent {
  Vec3 low{};
  Vec3 high{};
};

void AppendTuple(const Vec3& vector, std::string& out) {
  out += '(';
  AppendFloats(vector, ", ", out);
  out += ')';
}

// "[a, b, ...]", each item by `append(i, out)`.
template <typename F>
void AppendList(size_t count, const F& append, std::string& out) {
  out += '[';
  for (size_t i = 0; i < count; ++i) {
    if (i > 0) out += ", ";
    append(i);
  }
  out += ']';
}

// A name, not empty, as USD takes it for an identifier.
std::string Identifier(const std::string& name) {
  std::string plain = name;
  for (char& letter : plain) {
    if (!absl::ascii_isalnum(static_cast<unsigned char>(letter))) letter = '_';
  }
  const bool has_start = !absl::ascii_isdigit(static_cast<unsigned char>(plain[0]));
  return has_start ? plain : absl::StrCat("_", plain);
}

class Usda : public BakeCodec {
 public:
  explicit Usda(const BakeContext& context)
      : context_(context),
        name_(Identifier(context.name)),
        extents_(static_cast<size_t>(context.timing.count)) {}

  // One for positions, one for velocities: an attribute's samples stand together.
  int64_t passes() const override { return 2; }

  std::string Begin() const override {
    const BakeTiming& timing = context_.timing;
    const Vec3& up = context_.up;
    const bool z_up = up[0] == 0 && up[1] == 0 && up[2] > 0;
    std::string out = absl::StrCat(
        "#usda 1.0\n(\n    doc = \"", context_.comment, "\"\n    defaultPrim = \"", name_,
        "\"\n    metersPerUnit = 1\n    upAxis = \"", z_up ? "Z" : "Y",
        "\"\n    startTimeCode = ", timing.first_frame, "\n    endTimeCode = ", timing.last_frame);
    for (const absl::string_view rate : {"timeCodesPerSecond", "framesPerSecond"}) {
      absl::StrAppend(&out, "\n    ", rate, " = ");
      AppendNumber(timing.rate(), out);
    }
    absl::StrAppend(&out, "\n)\n\ndef Xform \"", name_, "\"\n{\n");
    if (!z_up && !(up[0] == 0 && up[2] == 0 && up[1] > 0)) AppendOrientation(out);
    AppendMaterials(out);
    AppendMesh(out);
    out += "        point3f[] points.timeSamples = {\n";
    return out;
  }

  absl::Status Note(int64_t, const BakeFrame& frame) override {
    Extent& extent = extents_[static_cast<size_t>(frame.index)];
    extent = {frame.points.front(), frame.points.front()};
    for (const Vec3& point : frame.points) {
      for (size_t k = 0; k < 3; ++k) {
        extent.low[k] = std::min(extent.low[k], point[k]);
        extent.high[k] = std::max(extent.high[k], point[k]);
      }
    }
    return absl::OkStatus();
  }

  void Encode(int64_t pass, const BakeFrame& frame, std::string& out) const override {
    if (pass == 1 && frame.index == 0) {
      out += "        }\n        vector3f[] velocities.timeSamples = {\n";
    }
    absl::StrAppend(&out, "            ", frame.frame, ": ");
    const std::vector<Vec3>& vectors = pass == 0 ? frame.points : frame.velocities;
    // USD's velocities are those of what is shown.
    const double pace = pass == 0 ? 1 : context_.timing.rate() / context_.timing.simulated_rate();
    const auto append = [&](size_t i) {
      const Vec3& v = vectors[i];
      AppendTuple({pace * v[0], pace * v[1], pace * v[2]}, out);
    };
    AppendList(vectors.size(), append, out);
    out += ",\n";
  }

  std::string End() const override {
    std::string out = "        }\n        float3[] extent.timeSamples = {\n";
    for (size_t i = 0; i < extents_.size(); ++i) {
      const double number = static_cast<double>(context_.timing.first_frame) +
                            static_cast<double>(i) * context_.timing.stride();
      out += "            ";
      AppendNumber(number, out);
      out += ": [";
      AppendTuple(extents_[i].low, out);
      out += ", ";
      AppendTuple(extents_[i].high, out);
      out += "],\n";
    }
    out += "        }\n";
    AppendSubsets(out);
    out += "    }\n}\n";
    return out;
  }

 private:
  void AppendOrientation(std::string& out) const {
    const auto [x, y, z, w] = RotationToY(context_.up);
    out += "    quatd xformOp:orient = (";
    bool first = true;
    for (const double value : {w, x, y, z}) {
      if (!std::exchange(first, false)) out += ", ";
      AppendNumber(value, out);
    }
    out += ")\n    uniform token[] xformOpOrder = [\"xformOp:orient\"]\n\n";
  }

  void AppendMaterials(std::string& out) const {
    for (const SurfaceMaterial& material : context_.materials.list()) {
      const std::string path = absl::StrCat("/", name_, "/", material.name);
      absl::StrAppend(&out, "    def Material \"", material.name,
                      "\"\n    {\n        token outputs:surface.connect = <", path,
                      "/Surface.outputs:surface>\n        def Shader \"Surface\"\n        {\n"
                      "            uniform token info:id = \"UsdPreviewSurface\"\n"
                      "            color3f inputs:diffuseColor = ");
      AppendTuple({material.color[0], material.color[1], material.color[2]}, out);
      out +=
          "\n            float inputs:roughness = 0.8\n            token outputs:surface\n"
          "        }\n    }\n\n";
    }
  }

  void AppendMesh(std::string& out) const {
    const SurfaceTopology& topology = context_.surface.topology;
    const size_t triangles = topology.triangles.size();
    out +=
        "    def Mesh \"Surface\" (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n"
        "    {\n        uniform token subdivisionScheme = \"none\"\n"
        "        uniform token orientation = \"rightHanded\"\n        int[] faceVertexCounts = ";
    AppendList(
        triangles, [&](size_t) { out += '3'; }, out);
    out += "\n        int[] faceVertexIndices = ";
    const auto corner = [&](size_t i) { return topology.triangles[i / 3][i % 3]; };
    AppendList(
        3 * triangles, [&](size_t i) { AppendNumber(corner(i), out); }, out);
    out += "\n        int[] primvars:piece = ";
    const auto piece = [&](size_t i) { AppendNumber(context_.surface.triangle_pieces[i], out); };
    AppendList(triangles, piece, out);
    out +=
        " (\n            interpolation = \"uniform\"\n        )\n        int[] primvars:inside = ";
    AppendList(
        triangles, [&](size_t i) { out += topology.inside[i] != 0 ? '1' : '0'; }, out);
    out +=
        " (\n            interpolation = \"uniform\"\n        )\n        int[] primvars:region = ";
    const auto region = [&](size_t i) { AppendNumber(context_.surface.triangle_regions[i], out); };
    AppendList(triangles, region, out);
    out +=
        " (\n            interpolation = \"uniform\"\n        )\n"
        "        point3f[] primvars:rest = ";
    const auto rest = [&](size_t i) { AppendTuple(topology.points[i].rest, out); };
    AppendList(topology.points.size(), rest, out);
    out +=
        " (\n            interpolation = \"vertex\"\n        )\n        texCoord2f[] primvars:st "
        "= ";
    const auto texture = [&](size_t i) {
      const auto [u, v] = context_.surface.UvAt(i / 3, i % 3);
      out += '(';
      AppendNumber(u, out);
      out += ", ";
      AppendNumber(v, out);
      out += ')';
    };
    AppendList(3 * triangles, texture, out);
    out += " (\n            interpolation = \"faceVarying\"\n        )\n";
  }

  void AppendSubsets(std::string& out) const {
    const SurfaceTopology& topology = context_.surface.topology;
    std::vector<std::vector<size_t>> faces(context_.materials.list().size());
    for (size_t i = 0; i < topology.triangles.size(); ++i) {
      faces[context_.materials.IndexOf(context_.surface.triangle_regions[i],
                                       topology.inside[i] != 0)]
          .push_back(i);
    }
    out += "        uniform token subsetFamily:materialBind:familyType = \"partition\"\n";
    for (size_t m = 0; m < faces.size(); ++m) {
      if (faces[m].empty()) continue;
      const std::string& name = context_.materials.list()[m].name;
      absl::StrAppend(&out, "        def GeomSubset \"", name,
                      "\" (\n            prepend apiSchemas = [\"MaterialBindingAPI\"]\n        )\n"
                      "        {\n            uniform token elementType = \"face\"\n"
                      "            uniform token familyName = \"materialBind\"\n"
                      "            int[] indices = ");
      AppendList(
          faces[m].size(), [&](size_t i) { AppendNumber(faces[m][i], out); }, out);
      absl::StrAppend(&out, "\n            rel material:binding = </", name_, "/", name,
                      ">\n        }\n");
    }
  }

  const BakeContext& context_;
  const std::string name_;
  std::vector<Extent> extents_;  // m, a frame each
};

}  // namespace

absl::StatusOr<std::unique_ptr<BakeCodec>> MakeUsda(const BakeContext& context) {
  return std::unique_ptr<BakeCodec>(std::make_unique<Usda>(context));
}

}  // namespace cleave
