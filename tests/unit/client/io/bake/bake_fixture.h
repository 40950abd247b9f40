#ifndef CLEAVE_TESTS_UNIT_CLIENT_IO_BAKE_BAKE_FIXTURE_H_
#define CLEAVE_TESTS_UNIT_CLIENT_IO_BAKE_BAKE_FIXTURE_H_

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "absl/strings/string_view.h"
#include "client/io/bake/bake.h"
#include "client/io/bake/baked_surface.h"
#include "tests/unit/client/io/bake/breaking_bar.h"
#include "tests/unit/temporary_directory.h"

namespace cleave::testing {

inline constexpr int64_t kFrames = 6;

// The number that stands there in a little-endian file.
template <typename T>
T At(absl::string_view bytes, size_t at) {
  T value{};
  std::memcpy(&value, bytes.substr(at).data(), sizeof(T));
  return value;
}

// Bakes of a bar that breaks, as files, beside what BakedMotion has for them.
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

}  // namespace cleave::testing

#endif  // CLEAVE_TESTS_UNIT_CLIENT_IO_BAKE_BAKE_FIXTURE_H_
