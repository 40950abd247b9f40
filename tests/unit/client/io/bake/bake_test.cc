#include "client/io/bake/bake.h"

#include <gmock/gmock.h>
#include <google/protobuf/struct.pb.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "client/io/bake/baked_surface.h"
#include "core/base/bytes.h"
#include "core/base/status.h"
#include "tests/unit/client/io/bake/breaking_bar.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using ::cleave::testing::BarFrame;
using ::cleave::testing::BarMesh;
using ::cleave::testing::BreakingBar;
using ::cleave::testing::PiecesOfBar;
using ::testing::HasSubstr;
using Json = google::protobuf::Value;

constexpr int64_t kFrames = 6;

float BigEndianFloat(absl::string_view bytes, size_t at) {
  uint32_t bits = 0;
  for (size_t i = 0; i < 4; ++i) bits = bits << 8 | static_cast<uint8_t>(bytes[at + i]);
  float value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

template <typename T>
T At(absl::string_view bytes, size_t at) {
  T value{};
  std::memcpy(&value, bytes.substr(at).data(), sizeof(T));
  return value;
}

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

class BakeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.folder = directory_.path();
    options_.name = "bar";
    BakedMotion motion(mesh_, incidence_, surface_, last_.broken_edges);
    for (int64_t i = 0; i < kFrames; ++i) {
      ASSERT_TRUE(motion.Advance(BarFrame(mesh_, i)).ok());
      points_.push_back(motion.points());
      velocities_.push_back(motion.velocities());
    }
  }
  std::string Bytes(const std::string& name) const {
    std::ifstream file(options_.folder + "/" + name, std::ios::binary);
    std::stringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
  }
  BakeResult Write(BakeFormat format) {
    options_.format = format;
    const auto result = WriteBake(mesh_, BreakingBar(mesh_, kFrames), options_, nullptr);
    EXPECT_TRUE(result.ok()) << result.status();
    return result.ok() ? *result : BakeResult{};
  }
  size_t PointCount() const { return surface_.topology.points.size(); }

  const TetMesh mesh_ = BarMesh();
  const Incidence incidence_ = BuildIncidence(mesh_);
  const Frame last_ = BarFrame(mesh_, kFrames - 1);
  const BakedSurface surface_ = BakeSurface(mesh_, incidence_, PiecesOfBar(mesh_, incidence_, 6),
                                            last_.broken_edges, nullptr);
  std::vector<std::vector<Vec3>> points_;  // a frame each, as BakedMotion has them
  std::vector<std::vector<Vec3>> velocities_;
  const TemporaryDirectory directory_;
  BakeOptions options_;
};

TEST_F(BakeTest, Pc2HasTheObjsVerticesInEveryFrame) {
  options_.velocities = true;
  const BakeResult result = Write(BakeFormat::kPc2);
  EXPECT_EQ(result.path, options_.folder + "/bar.pc2");
  EXPECT_EQ(result.written, kFrames);
  size_t vertices = 0;
  for (const absl::string_view line : absl::StrSplit(Bytes("bar.obj"), '\n')) {
    if (!absl::StartsWith(line, "v ")) continue;
    std::stringstream text{std::string(line.substr(2))};
    for (size_t k = 0; k < 3; ++k) {
      float value = 0;
      text >> value;
      ASSERT_EQ(value, static_cast<float>(surface_.topology.points[vertices].rest[k]));
    }
    ++vertices;
  }
  EXPECT_EQ(vertices, PointCount());
  for (const bool velocities : {false, true}) {
    const std::string bytes = Bytes(velocities ? "bar.velocity.pc2" : "bar.pc2");
    ASSERT_EQ(bytes.size(), 32 + 12 * PointCount() * kFrames);
    EXPECT_EQ(bytes.substr(0, 12), std::string("POINTCACHE2\0", 12));
    EXPECT_EQ(At<int32_t>(bytes, 12), 1);
    EXPECT_EQ(At<int32_t>(bytes, 16), static_cast<int32_t>(PointCount()));
    EXPECT_EQ(At<float>(bytes, 20), 10.0f);  // the first frame's number
    EXPECT_EQ(At<float>(bytes, 24), 1.0f);
    EXPECT_EQ(At<int32_t>(bytes, 28), kFrames);
    size_t at = 32;
    for (const auto& frame : velocities ? velocities_ : points_) {
      for (const Vec3& vector : frame) {
        for (const double value : vector) {
          ASSERT_EQ(At<float>(bytes, at), static_cast<float>(value));
          at += 4;
        }
      }
    }
  }
  EXPECT_THAT(Bytes("bar.pc2.json"), HasSubstr("\"piece\": 1, \"smallest_node\": 0"));
}

TEST_F(BakeTest, MddIsBigEndianAndTellsWhenFramesAreShown) {
  options_.playback_rate = 24;
  Write(BakeFormat::kMdd);
  const std::string bytes = Bytes("bar.mdd");
  ASSERT_EQ(bytes.size(), 8 + 4 * kFrames + 12 * PointCount() * kFrames);
  EXPECT_EQ(bytes.substr(0, 4), std::string("\0\0\0\6", 4));
  EXPECT_EQ(static_cast<uint8_t>(bytes[7]), PointCount() & 255);
  size_t at = 8;
  for (int64_t i = 0; i < kFrames; ++i, at += 4) {
    EXPECT_NEAR(BigEndianFloat(bytes, at), static_cast<double>(i) / 24, 1e-7);
  }
  for (const auto& frame : points_) {
    for (const Vec3& vector : frame) {
      for (const double value : vector) {
        ASSERT_EQ(BigEndianFloat(bytes, at), static_cast<float>(value));
        at += 4;
      }
    }
  }
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

TEST_F(BakeTest, UsdaHasASampleAFrameOfPointsAndVelocities) {
  options_.playback_rate = 5;  // half as fast as simulated
  Write(BakeFormat::kUsda);
  const std::string text = Bytes("bar.usda");
  EXPECT_TRUE(absl::StartsWith(text, "#usda 1.0\n"));
  EXPECT_THAT(text, HasSubstr("upAxis = \"Z\""));
  EXPECT_THAT(text, HasSubstr("timeCodesPerSecond = 5\n"));
  EXPECT_THAT(text, HasSubstr("startTimeCode = 10\n    endTimeCode = 15\n"));
  EXPECT_THAT(text, HasSubstr("rel material:binding = </bar/inside_3>"));
  for (const auto& [open, close] : {std::pair{'(', ')'}, {'[', ']'}, {'{', '}'}}) {
    EXPECT_EQ(std::count(text.begin(), text.end(), open),
              std::count(text.begin(), text.end(), close));
  }
  for (const bool velocities : {false, true}) {
    const size_t begin = text.find(velocities ? "vector3f[] velocities.timeSamples = {"
                                              : "point3f[] points.timeSamples = {");
    ASSERT_NE(begin, std::string::npos);
    const std::vector<std::string> lines =
        absl::StrSplit(text.substr(begin, text.find('}', begin) - begin), '\n');
    ASSERT_EQ(lines.size(), kFrames + 2);  // its head, and what is before the brace
    for (size_t i = 0; i < kFrames; ++i) {
      std::string line = lines[i + 1];
      EXPECT_THAT(line, HasSubstr(absl::StrCat(" ", 10 + i, ": [")));
      line = line.substr(line.find('['));
      for (char& letter : line) {
        if (absl::StrContains("[](),", absl::string_view(&letter, 1))) letter = ' ';
      }
      std::stringstream numbers(line);
      for (const Vec3& vector : velocities ? velocities_[i] : points_[i]) {
        for (const double value : vector) {
          double read = 0;
          ASSERT_TRUE(numbers >> read);
          ASSERT_NEAR(read, velocities ? 0.5 * value : value, 1e-6);
        }
      }
      double more = 0;
      EXPECT_FALSE(numbers >> more);
    }
  }
}

TEST_F(BakeTest, ACutBakeGoesOnToTheSameBytes) {
  const std::vector<std::pair<BakeFormat, std::string>> formats = {{BakeFormat::kPc2, "bar.pc2"},
                                                                   {BakeFormat::kMdd, "bar.mdd"},
                                                                   {BakeFormat::kGlb, "bar.glb"},
                                                                   {BakeFormat::kUsda, "bar.usda"}};
  for (const auto& [format, name] : formats) {
    Write(format);
    const std::string whole = Bytes(name);
    std::filesystem::remove_all(options_.folder);
    const int64_t units = format == BakeFormat::kUsda ? 2 * kFrames : kFrames;
    for (const int64_t at : {int64_t{1}, int64_t{3}, units - 1}) {
      const auto stopped = WriteBake(mesh_, BreakingBar(mesh_), options_,
                                     [&, naming = true](int64_t done, int64_t) mutable {
                                       if (naming) return naming = done < kFrames, true;
                                       return done < at;
                                     });
      EXPECT_EQ(stopped.status().code(), absl::StatusCode::kCancelled);
      EXPECT_FALSE(std::filesystem::exists(options_.folder + "/" + name));
      // What a kill leaves behind the mark does not count.
      std::ofstream(options_.folder + "/" + name + ".part", std::ios::app) << "half a frame";
      const BakeResult resumed = Write(format);
      EXPECT_EQ(resumed.kept, format == BakeFormat::kUsda ? at / 2 : at) << name;
      EXPECT_EQ(resumed.kept + resumed.written, kFrames);
      EXPECT_TRUE(Bytes(name) == whole) << name << " cut at " << at;
      EXPECT_FALSE(std::filesystem::exists(options_.folder + "/" + name + ".part"));
      EXPECT_FALSE(std::filesystem::exists(options_.folder + "/" + name + ".part.json"));
      EXPECT_EQ(Write(format).kept, kFrames) << name;
      std::filesystem::remove_all(options_.folder);
    }
  }
}

// A node keeps the turn that it had when its last tet came apart: that of a frame which a bake may
// leave out.
TEST_F(BakeTest, AFrameIsTheSameWhicheverFramesAreLeftOut) {
  constexpr int64_t kLast = 4;
  const auto turned = [this](int64_t number) {
    Frame frame = BarFrame(mesh_, kFrames - 1);
    frame.frame = number;
    frame.time = 0.1 * static_cast<double>(number);
    frame.positions = mesh_.rest_positions;
    for (int64_t turn = 0; turn < number; ++turn) {
      for (Vec3& position : frame.positions) position = {position[0], -position[2], position[1]};
    }
    frame.broken_edges.clear();
    if (number < 3) return frame;
    const auto edges = incidence_.node_edges[0];
    frame.broken_edges.assign(edges.begin(), edges.end());
    std::sort(frame.broken_edges.begin(), frame.broken_edges.end());
    return frame;
  };
  FrameSource all;
  all.count = kLast + 1;
  all.read = turned;
  FrameSource ends;  // of the same run
  ends.count = 2;
  ends.read = [&](int64_t position) { return turned(position * kLast); };
  ends.pass_by = [&](int64_t position, const FrameSource::Visit& visit) -> absl::Status {
    for (int64_t number = 1; position == 1 && number < kLast; ++number)
      CLEAVE_RETURN_IF_ERROR(visit(turned(number)));
    return absl::OkStatus();
  };
  options_.velocities = true;
  options_.format = BakeFormat::kPc2;
  const auto last_of = [&](const FrameSource& frames, const std::string& name) {
    const auto result = WriteBake(mesh_, frames, options_, nullptr);
    EXPECT_TRUE(result.ok()) << result.status();
    const std::string bytes = Bytes(name);
    return bytes.substr(bytes.size() - (bytes.size() - 32) / static_cast<size_t>(frames.count));
  };
  for (const std::string name : {"bar.pc2", "bar.velocity.pc2"}) {
    SCOPED_TRACE(name);
    const std::string whole = last_of(all, name);
    EXPECT_EQ(whole.size() % 12, 0u);
    EXPECT_TRUE(last_of(ends, name) == whole);  // not EXPECT_EQ, which would print them
  }
}

TEST_F(BakeTest, FilesOfOtherDataOrDamagedOnesAreWrittenAnew) {
  Write(BakeFormat::kPc2);
  const std::string whole = Bytes("bar.pc2");
  // Another frame in the middle.
  FrameSource other = BreakingBar(mesh_, kFrames);
  other.read = [this](int64_t position) -> absl::StatusOr<Frame> {
    Frame frame = BarFrame(mesh_, position);
    if (position == 3) frame.positions[0][1] += 0.01;
    return frame;
  };
  const auto changed = WriteBake(mesh_, other, options_, nullptr);
  ASSERT_TRUE(changed.ok());
  EXPECT_EQ(changed->kept, 0);
  EXPECT_FALSE(Bytes("bar.pc2") == whole);
  Write(BakeFormat::kPc2);
  std::filesystem::resize_file(options_.folder + "/bar.pc2", 100);
  EXPECT_EQ(Write(BakeFormat::kPc2).kept, 0);
  EXPECT_TRUE(Bytes("bar.pc2") == whole);
  // A mark without its part, and one that is no mark.
  std::filesystem::remove(options_.folder + "/bar.pc2");
  std::ofstream(options_.folder + "/bar.pc2.json") << "{\"started_from\": \"";
  EXPECT_EQ(Write(BakeFormat::kPc2).kept, 0);
  EXPECT_TRUE(Bytes("bar.pc2") == whole);
}

TEST_F(BakeTest, WhatCannotBeBakedIsNamed) {
  const auto message = [&](const FrameSource& frames) {
    const auto result = WriteBake(mesh_, frames, options_, nullptr);
    EXPECT_FALSE(result.ok());
    return std::string(result.status().message());
  };
  EXPECT_THAT(message(FrameSource{}), HasSubstr("frames: there are none to bake"));
  options_.name = "a/b";
  options_.playback_rate = 0;
  options_.up = {0, 0, 0};
  const std::string all = message(BreakingBar(mesh_));
  EXPECT_THAT(all, HasSubstr("name: \"a/b\" is not a file name"));
  EXPECT_THAT(all, HasSubstr("playback_rate: 0 frames/s is outside"));
  EXPECT_THAT(all, HasSubstr("up: must be finite and not zero"));

  options_.name = "bar";
  options_.playback_rate.reset();
  options_.up = {0, 0, 1};
  options_.format = BakeFormat::kGlb;
  FrameSource many = BreakingBar(mesh_, 40000);  // 40000^2 weights alone are above
  EXPECT_THAT(message(many), HasSubstr("above the 4294967295"));
  EXPECT_FALSE(std::filesystem::exists(options_.folder + "/bar.glb.part"));
  FrameSource standing = BreakingBar(mesh_, 3);
  standing.read = [this](int64_t position) -> absl::StatusOr<Frame> {
    Frame frame = BarFrame(mesh_, position);
    frame.time = 1;
    return frame;
  };
  EXPECT_THAT(message(standing), HasSubstr("time: frame 11 is shown at 0 s"));

  const std::string blocked = options_.folder + "/file";
  std::ofstream(blocked) << "not a folder";
  options_.folder = blocked;
  EXPECT_THAT(message(BreakingBar(mesh_)), HasSubstr(blocked));
}

}  // namespace
}  // namespace cleave
