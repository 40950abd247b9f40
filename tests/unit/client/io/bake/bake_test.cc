#include "client/io/bake/bake.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/status.h"
#include "tests/unit/client/io/bake/bake_fixture.h"

namespace cleave {
namespace {

using ::cleave::testing::BakeTest;
using ::cleave::testing::BarFrame;
using ::cleave::testing::BreakingBar;
using ::cleave::testing::kFrames;
using ::testing::HasSubstr;

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
