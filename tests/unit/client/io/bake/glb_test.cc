// Bakes as binary glTF.

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/unit/client/io/bake/bake_fixture.h"

namespace cleave {
namespace {

using ::cleave::testing::At;
using ::cleave::testing::BakeTest;
using ::cleave::testing::kFrames;

using Json = google::protobuf::Value;

const Json& Get(const Json& object, const std::string& name) {
  return object.struct_value().fields().at(name);
}
const Json& Get(const Json& list, size_t i) {
  return list.list_value().values(static_cast<int>(i));
}
size_t Integer(const Json& value) { return static_cast<size_t>(value.number_value()); }

// A binary glTF file taken apart as the standard has it.
struct Gltf {
  Json json;
  std::string binary;

  const Json& Accessor(size_t i) const { return Get(Get(json, "accessors"), i); }
  // All numbers of a float or index accessor.
  std::vector<double> Values(size_t i) const {
    const Json& accessor = Accessor(i);
    const size_t components = Get(accessor, "type").string_value() == "VEC3"   ? 3
                              : Get(accessor, "type").string_value() == "VEC2" ? 2
                                                                               : 1;
    std::vector<double> values(Integer(Get(accessor, "count")) * components, 0.0);
    if (accessor.struct_value().fields().count("bufferView") == 0) return values;
    const Json& view = Get(Get(json, "bufferViews"), Integer(Get(accessor, "bufferView")));
    const size_t in_view = Integer(Get(accessor, "byteOffset"));
    EXPECT_LE(in_view + 4 * values.size(), Integer(Get(view, "byteLength")));
    const size_t begin = Integer(Get(view, "byteOffset")) + in_view;
    for (size_t k = 0; k < values.size(); ++k) {
      values[k] = Integer(Get(accessor, "componentType")) == 5126
                      ? At<float>(binary, begin + 4 * k)
                      : At<uint32_t>(binary, begin + 4 * k);
    }
    if (accessor.struct_value().fields().count("min") != 0) ExpectBounds(accessor, values);
    return values;
  }

 private:
  static void ExpectBounds(const Json& accessor, const std::vector<double>& values) {
    const auto n = static_cast<size_t>(Get(accessor, "min").list_value().values_size());
    for (size_t k = 0; k < n; ++k) {
      double low = values[k];
      double high = values[k];
      for (size_t i = k; i < values.size(); i += n) {
        low = std::min(low, values[i]);
        high = std::max(high, values[i]);
      }
      EXPECT_EQ(static_cast<float>(Get(Get(accessor, "min"), k).number_value()), low);
      EXPECT_EQ(static_cast<float>(Get(Get(accessor, "max"), k).number_value()), high);
    }
  }
};

Gltf ParseGlb(const std::string& bytes) {
  Gltf gltf;
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(At<uint32_t>(bytes, 4), 2u);
  EXPECT_EQ(At<uint32_t>(bytes, 8), bytes.size());
  const auto json_size = At<uint32_t>(bytes, 12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(json_size % 4, 0u);
  EXPECT_TRUE(
      google::protobuf::util::JsonStringToMessage(bytes.substr(20, json_size), &gltf.json).ok());
  EXPECT_EQ(At<uint32_t>(bytes, 20 + json_size), bytes.size() - 28 - json_size);
  EXPECT_EQ(bytes.substr(24 + json_size, 4), std::string("BIN\0", 4));
  gltf.binary = bytes.substr(28 + json_size);
  return gltf;
}

TEST_F(BakeTest, GlbIsAMorphTargetAFrameAndAPrimitiveAMaterial) {
  options_.velocities = true;
  Write(BakeFormat::kGlb);
  const Gltf gltf = ParseGlb(Bytes("bar.glb"));
  const Json& primitives = Get(Get(Get(gltf.json, "meshes"), size_t{0}), "primitives");
  std::vector<std::string> materials;
  size_t triangles = 0;
  for (const Json& primitive : primitives.list_value().values()) {
    const Json& material = Get(Get(gltf.json, "materials"), Integer(Get(primitive, "material")));
    materials.push_back(Get(material, "name").string_value());
    const bool inside = Get(Get(material, "extras"), "inside").bool_value();
    const auto indices = gltf.Values(Integer(Get(primitive, "indices")));
    triangles += indices.size() / 3;
    const Json& attributes = Get(primitive, "attributes");
    const auto rest = gltf.Values(Integer(Get(attributes, "POSITION")));
    EXPECT_EQ(gltf.Values(Integer(Get(attributes, "_REST"))), rest);
    EXPECT_EQ(gltf.Values(Integer(Get(attributes, "TEXCOORD_0"))).size(), 2 * rest.size() / 3);
    const auto pieces = gltf.Values(Integer(Get(attributes, "_PIECE")));
    for (const double index : indices) EXPECT_LT(index, static_cast<double>(rest.size()) / 3);
    const Json& targets = Get(primitive, "targets");
    ASSERT_EQ(targets.list_value().values_size(), kFrames);
    // Each vertex is a point of its piece that some face of its kind has, in every frame.
    std::vector<std::vector<double>> moved;
    std::vector<std::vector<double>> velocities;
    for (size_t i = 0; i < kFrames; ++i) {
      moved.push_back(gltf.Values(Integer(Get(Get(targets, i), "POSITION"))));
      velocities.push_back(gltf.Values(Integer(Get(Get(targets, i), "_VELOCITY"))));
    }
    for (const double zero : gltf.Values(Integer(Get(attributes, "_VELOCITY")))) {
      EXPECT_EQ(zero, 0);
    }
    for (size_t vertex = 0; 3 * vertex < rest.size(); ++vertex) {
      bool found = false;
      for (size_t t = 0; t < surface_.topology.triangles.size() && !found; ++t) {
        if ((surface_.topology.inside[t] != 0) != inside) continue;
        for (const int32_t id : surface_.topology.triangles[t]) {
          const auto point = static_cast<size_t>(id);
          bool same = surface_.point_pieces[point] == static_cast<int32_t>(pieces[vertex]);
          for (size_t i = 0; i < kFrames && same; ++i) {
            for (size_t k = 0; k < 3; ++k) {
              const double shown = rest[3 * vertex + k] + moved[i][3 * vertex + k];
              same = same && std::abs(shown - points_[i][point][k]) < 2e-7 &&
                     velocities[i][3 * vertex + k] ==
                         static_cast<double>(static_cast<float>(velocities_[i][point][k]));
            }
          }
          found = found || same;
        }
      }
      ASSERT_TRUE(found) << vertex;
    }
  }
  EXPECT_THAT(materials, ::testing::ElementsAre("outside_3", "inside_3", "outside_crust"));
  EXPECT_EQ(triangles, surface_.topology.triangles.size());
}

TEST_F(BakeTest, GlbHasNormalsThatTurnWithTheSurfaceInEveryFrame) {
  Write(BakeFormat::kGlb);
  const Gltf gltf = ParseGlb(Bytes("bar.glb"));
  const Json& primitives = Get(Get(Get(gltf.json, "meshes"), size_t{0}), "primitives");
  double largest_turn = 0;
  for (const Json& primitive : primitives.list_value().values()) {
    const auto indices = gltf.Values(Integer(Get(primitive, "indices")));
    const Json& attributes = Get(primitive, "attributes");
    const auto rest = gltf.Values(Integer(Get(attributes, "POSITION")));
    const auto normals = gltf.Values(Integer(Get(attributes, "NORMAL")));
    for (size_t i = 0; i < kFrames; ++i) {
      const Json& target = Get(Get(primitive, "targets"), i);
      const auto moved = gltf.Values(Integer(Get(target, "POSITION")));
      const auto turns = gltf.Values(Integer(Get(target, "NORMAL")));
      const auto at = [](const std::vector<double>& base, const std::vector<double>& more,
                         double vertex) {
        const auto v = 3 * static_cast<size_t>(vertex);
        return Eigen::Vector3d(base[v] + more[v], base[v + 1] + more[v + 1],
                               base[v + 2] + more[v + 2]);
      };
      for (size_t t = 0; t < indices.size(); t += 3) {
        const Eigen::Vector3d origin = at(rest, moved, indices[t]);
        const Eigen::Vector3d face = (at(rest, moved, indices[t + 1]) - origin)
                                         .cross(at(rest, moved, indices[t + 2]) - origin)
                                         .normalized();
        for (size_t k = 0; k < 3; ++k) {
          const Eigen::Vector3d normal = at(normals, turns, indices[t + k]);
          ASSERT_NEAR(normal.norm(), 1, 1e-5);
          // Within about the crease angle of every face that it shades.
          ASSERT_GT(normal.dot(face), 0.7);
          for (size_t axis = 0; axis < 3; ++axis)
            largest_turn = std::max(
                largest_turn, std::abs(turns[3 * static_cast<size_t>(indices[t + k]) + axis]));
        }
      }
    }
  }
  EXPECT_GT(largest_turn, 0.1);  // the bar bends
}

TEST_F(BakeTest, GlbPlaysFrameAfterFrameWithTheScenesUpAsY) {
  options_.playback_rate = 10;
  options_.up = {0, 0, 2};
  Write(BakeFormat::kGlb);
  const Gltf gltf = ParseGlb(Bytes("bar.glb"));
  const Json& animation = Get(Get(gltf.json, "animations"), size_t{0});
  const Json& sampler = Get(Get(animation, "samplers"), size_t{0});
  const auto times = gltf.Values(Integer(Get(sampler, "input")));
  const auto weights = gltf.Values(Integer(Get(sampler, "output")));
  ASSERT_EQ(times.size(), kFrames);
  ASSERT_EQ(weights.size(), kFrames * kFrames);
  for (size_t i = 0; i < kFrames; ++i) {
    EXPECT_NEAR(times[i], 0.1 * static_cast<double>(i), 1e-7);
    for (size_t k = 0; k < kFrames; ++k) EXPECT_EQ(weights[kFrames * i + k], i == k ? 1 : 0);
  }
  const Json& rotation = Get(Get(Get(gltf.json, "nodes"), size_t{0}), "rotation");
  const double half = std::sqrt(0.5);
  EXPECT_NEAR(Get(rotation, size_t{0}).number_value(), -half, 1e-12);
  EXPECT_NEAR(Get(rotation, size_t{1}).number_value(), 0, 1e-12);
  EXPECT_NEAR(Get(rotation, size_t{2}).number_value(), 0, 1e-12);
  EXPECT_NEAR(Get(rotation, size_t{3}).number_value(), half, 1e-12);
}

}  // namespace
}  // namespace cleave
