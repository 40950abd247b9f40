#include "client/io/preview/preview.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <webp/demux.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "client/io/preview/motion_survey.h"
#include "core/mesh/incidence.h"
#include "core/mesh/procedural.h"

namespace cleave {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TetMesh Bar() {
  BoxMesh box;
  box.size = {0.4, 0.1, 0.1};
  box.resolution.layout = MeshLayout::kJitteredLattice;
  box.resolution.cell_size = 0.05;
  return *BuildMesh(box);
}

// Twenty frames; from the eleventh on the right half is broken off and moves away.
FrameSource BreakingBar(const TetMesh& mesh) {
  FrameSource source;
  source.count = 20;
  source.read = [&mesh](int64_t position) -> absl::StatusOr<Frame> {
    Frame frame;
    frame.frame = position;
    frame.time = 0.01 * static_cast<double>(position);
    frame.positions = mesh.rest_positions;
    if (position < 10) return frame;
    const auto right = [&](int32_t node) {
      return mesh.rest_positions[static_cast<size_t>(node)][0] > 0.21;
    };
    for (size_t node = 0; node < frame.positions.size(); ++node) {
      if (right(static_cast<int32_t>(node))) {
        frame.positions[node][0] += 0.02 * static_cast<double>(position - 9);
      }
    }
    const Incidence incidence = BuildIncidence(mesh);
    for (size_t edge = 0; edge < incidence.edges.size(); ++edge) {
      if (right(incidence.edges[edge][0]) != right(incidence.edges[edge][1])) {
        frame.broken_edges.push_back(static_cast<int32_t>(edge));
      }
    }
    return frame;
  };
  return source;
}

PreviewOptions Small() {
  PreviewOptions options;
  options.width = 160;
  options.samples = 1;
  return options;
}

// Pixels that are clearly coloured: body, not ground or text.
int Colored(const Image& image) {
  int count = 0;
  for (size_t i = 0; i < image.rgb.size(); i += 3) {
    const auto [low, high] = std::minmax({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]});
    count += high - low > 50 ? 1 : 0;
  }
  return count;
}

TEST(Preview, StillShowsTheBodyWholeInAPictureThatFits) {
  const TetMesh mesh = Bar();
  const auto image = RenderStill(mesh, BreakingBar(mesh), 0, Small());
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->width, 160);
  EXPECT_LT(image->height, 140);  // a bar is wide
  EXPECT_GT(Colored(*image), image->width * image->height / 40);
  for (int x = 0; x < image->width; ++x) {
    const uint8_t* c = image->at(x, image->height - 1);
    EXPECT_LT(std::abs(c[0] - c[2]), 30);
  }
}

TEST(Preview, ContactSheetIsAGridOfTilesUnderItsTitle) {
  const TetMesh mesh = Bar();
  PreviewOptions options = Small();
  options.height = 90;
  options.title = "Bar";
  int64_t calls = 0;
  const auto image = RenderContactSheet(mesh, BreakingBar(mesh), {.tiles = 6, .columns = 3},
                                        options, [&](int64_t done, int64_t total) {
                                          EXPECT_EQ(done, ++calls);
                                          EXPECT_EQ(total, 6);
                                          return true;
                                        });
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(calls, 6);
  EXPECT_GE(image->width, 3 * 160);
  EXPECT_LE(image->width, 3 * 160 + 20);
  EXPECT_GE(image->height, 2 * 90 + 10);
  EXPECT_LE(image->height, 2 * 90 + 60);
}

TEST(Preview, AnimationHasAPictureAFrameAndHoldsTheLast) {
  const TetMesh mesh = Bar();
  const auto bytes =
      RenderAnimation(mesh, BreakingBar(mesh), {.frames_per_second = 20}, Small(), nullptr);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const WebPData data{reinterpret_cast<const uint8_t*>(bytes->data()), bytes->size()};
  WebPAnimDecoder* decoder = WebPAnimDecoderNew(&data, nullptr);
  ASSERT_NE(decoder, nullptr);
  WebPAnimInfo info;
  WebPAnimDecoderGetInfo(decoder, &info);
  EXPECT_EQ(info.canvas_width, 160u);
  int end = 0;
  uint8_t* pixels = nullptr;
  while (WebPAnimDecoderHasMoreFrames(decoder) != 0) {
    ASSERT_NE(WebPAnimDecoderGetNext(decoder, &pixels, &end), 0);
  }
  EXPECT_EQ(end, 20 * 50 + 1000);
  // Pictures that equal the one before are shown longer instead of repeated.
  EXPECT_GE(info.frame_count, 11u);
  EXPECT_LE(info.frame_count, 20u);
  WebPAnimDecoderDelete(decoder);
}

TEST(Preview, StrainsPiecesAndThreadCountsGiveTheSameBytesEveryTime) {
  const TetMesh mesh = Bar();
  for (const ColorBy color_by : {ColorBy::kStrain, ColorBy::kPiece, ColorBy::kRegion}) {
    PreviewOptions options = Small();
    options.color_by = color_by;
    std::vector<uint8_t> one;
    {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
      one = RenderStill(mesh, BreakingBar(mesh), 15, options)->rgb;
    }
    EXPECT_EQ(one, RenderStill(mesh, BreakingBar(mesh), 15, options)->rgb);
  }
}

TEST(Preview, ATurntableGoesOnceRoundOneFrame) {
  const TetMesh mesh = Bar();
  const TurntableOptions turntable{.pictures = 6, .frames_per_second = 10, .tiles = 4};
  int64_t calls = 0;
  int reads = 0;
  FrameSource counted = BreakingBar(mesh);
  counted.read = [&reads, read = counted.read](int64_t position) {
    ++reads;
    return read(position);
  };
  const auto bytes =
      RenderTurntable(mesh, counted, 19, turntable, Small(), [&](int64_t done, int64_t total) {
        EXPECT_EQ(done, ++calls);
        EXPECT_EQ(total, 6);
        return true;
      });
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  EXPECT_EQ(reads, 2);  // to look where it goes, and to draw, however many pictures
  const WebPData data{reinterpret_cast<const uint8_t*>(bytes->data()), bytes->size()};
  WebPAnimDecoder* decoder = WebPAnimDecoderNew(&data, nullptr);
  ASSERT_NE(decoder, nullptr);
  WebPAnimInfo info;
  WebPAnimDecoderGetInfo(decoder, &info);
  EXPECT_EQ(info.frame_count, 6u);
  int end = 0;
  uint8_t* pixels = nullptr;
  std::vector<std::vector<uint8_t>> pictures;
  while (WebPAnimDecoderHasMoreFrames(decoder) != 0) {
    ASSERT_NE(WebPAnimDecoderGetNext(decoder, &pixels, &end), 0);
    pictures.emplace_back(pixels, pixels + 4 * info.canvas_width * info.canvas_height);
  }
  EXPECT_EQ(end, 600);
  for (size_t i = 1; i < pictures.size(); ++i) EXPECT_NE(pictures[i], pictures[0]);
  WebPAnimDecoderDelete(decoder);
  const auto sheet = RenderTurntableSheet(mesh, BreakingBar(mesh), 19, turntable, Small(), nullptr);
  ASSERT_TRUE(sheet.ok()) << sheet.status();
  EXPECT_GE(sheet->width, 2 * 160);
}

TEST(Preview, ColoursTellDamageAndImpurity) {
  const TetMesh mesh = Bar();
  const FrameSource frames = BreakingBar(mesh);
  PreviewOptions options = Small();
  options.color_by = ColorBy::kDamage;
  const auto whole = RenderStill(mesh, frames, 0, options);
  const auto broken = RenderStill(mesh, frames, 19, options);
  ASSERT_TRUE(whole.ok() && broken.ok()) << whole.status() << broken.status();
  // Green of the middle of the map shows where edges broke alone; the legend's is in both.
  const auto green = [](const Image& image) {
    int count = 0;
    for (size_t i = 0; i < image.rgb.size(); i += 3) {
      count += image.rgb[i + 1] > image.rgb[i] + 30 ? 1 : 0;
    }
    return count;
  };
  EXPECT_GT(green(*broken), green(*whole));

  options.color_by = ColorBy::kImpurity;
  EXPECT_THAT(std::string(RenderStill(mesh, frames, 0, options).status().message()),
              HasSubstr("color_by: there are no impurities"));
  options.node_potencies = {1, 2};
  EXPECT_THAT(std::string(RenderStill(mesh, frames, 0, options).status().message()),
              HasSubstr("node_potencies: has 2 items"));
  options.node_potencies.clear();
  for (const Vec3& rest : mesh.rest_positions) {
    options.node_potencies.push_back(rest[0] > 0.2 ? 3 : 0);
  }
  const auto impure = RenderStill(mesh, frames, 0, options);
  ASSERT_TRUE(impure.ok()) << impure.status();
  int magenta = 0;
  int yellow = 0;
  for (size_t i = 0; i < impure->rgb.size(); i += 3) {
    magenta += impure->rgb[i] > 100 && impure->rgb[i + 1] < 60 ? 1 : 0;
    yellow += impure->rgb[i + 1] > 100 && impure->rgb[i + 2] < 90 ? 1 : 0;
  }
  EXPECT_GT(magenta, 100);
  EXPECT_GT(yellow, 100);
}

TEST(Preview, BadInputIsAStatus) {
  const TetMesh mesh = Bar();
  const FrameSource frames = BreakingBar(mesh);
  FrameSource none;
  EXPECT_FALSE(RenderContactSheet(mesh, none, {}, Small(), nullptr).ok());
  EXPECT_FALSE(RenderAnimation(mesh, none, {}, Small(), nullptr).ok());
  EXPECT_FALSE(RenderStill(mesh, frames, 20, Small()).ok());
  const auto turning = RenderTurntable(
      mesh, frames, 0, {.pictures = 1, .frames_per_second = 0, .tiles = 1}, Small(), nullptr);
  for (const char* field : {"pictures: 1", "tiles: 1", "frames_per_second: 0"}) {
    EXPECT_THAT(std::string(turning.status().message()), HasSubstr(field));
  }
  EXPECT_FALSE(RenderTurntableSheet(mesh, frames, 20, {}, Small(), nullptr).ok());
  PreviewOptions options = Small();
  options.width = 3;
  options.samples = 100;
  EXPECT_FALSE(RenderStill(mesh, frames, 0, options).ok());
  options = Small();
  options.width = 8000;
  EXPECT_FALSE(
      RenderContactSheet(mesh, frames, {.tiles = 20, .columns = 5}, options, nullptr).ok());
  EXPECT_FALSE(RenderContactSheet(mesh, frames, {.tiles = 0}, Small(), nullptr).ok());
  FrameSource bad = frames;
  bad.read = [&](int64_t position) -> absl::StatusOr<Frame> {
    auto frame = frames.read(position);
    frame->positions[0][0] = std::numeric_limits<double>::quiet_NaN();
    return frame;
  };
  EXPECT_EQ(RenderStill(mesh, bad, 0, Small()).status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(RenderContactSheet(mesh, frames, {}, Small(), [](int64_t, int64_t) { return false; })
                .status()
                .code(),
            absl::StatusCode::kCancelled);
}

TEST(MotionSurvey, LooksAtFirstAndLastAndLeavesCrumbsOut) {
  const TetMesh mesh = Bar();
  FrameSource frames = BreakingBar(mesh);
  const auto read = frames.read;
  const Incidence incidence = BuildIncidence(mesh);
  // Node 0 flies off alone.
  frames.read = [&](int64_t position) -> absl::StatusOr<Frame> {
    auto frame = read(position);
    if (position < 19) return frame;
    frame->positions[0] = {100, 100, 100};
    const auto edges = incidence.node_edges[0];
    frame->broken_edges.insert(frame->broken_edges.end(), edges.begin(), edges.end());
    std::sort(frame->broken_edges.begin(), frame->broken_edges.end());
    return frame;
  };
  TetMesh many = mesh;
  const auto survey = SurveyMotion(many, frames, 7);
  ASSERT_TRUE(survey.ok()) << survey.status();
  EXPECT_THAT(survey->positions, ElementsAre(0, 3, 6, 9, 12, 15, 19));
  EXPECT_EQ(survey->broken_edges[3], 0);
  double farthest = 0;
  for (const Vec3& point : survey->points) farthest = std::max(farthest, point[0]);
  EXPECT_LT(farthest, 1);
}

TEST(ChooseFrames, FollowsTheBreakAndKeepsBothEnds) {
  MotionSurvey survey;
  for (int64_t i = 0; i <= 100; ++i) {
    survey.positions.push_back(i);
    survey.times.push_back(static_cast<double>(i));
    survey.broken_edges.push_back(std::clamp<int64_t>(i - 40, 0, 10) * 50);
  }
  const std::vector<int64_t> chosen = ChooseFrames(survey, 11);
  ASSERT_EQ(chosen.size(), 11u);
  EXPECT_EQ(chosen.front(), 0);
  EXPECT_EQ(chosen.back(), 100);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  EXPECT_GE(
      std::count_if(chosen.begin(), chosen.end(), [](int64_t i) { return i > 40 && i <= 50; }), 5);
  EXPECT_EQ(ChooseFrames(survey, 101).size(), 101u);
  EXPECT_EQ(ChooseFrames(survey, 500).size(), 101u);
  EXPECT_THAT(ChooseFrames(survey, 1), ElementsAre(100));
}

TEST(Preview, PiecesHaveTheColoursThatAllFramesGiveThem) {
  // Little of the bar breaks off in frame 1, half of it in frame 2 off the other end: what
  // has its name from both frames has another where the first is left out.
  const TetMesh mesh = Bar();
  const Incidence incidence = BuildIncidence(mesh);
  const auto frame_of = [&](int64_t position) {
    Frame frame;
    frame.frame = position;
    frame.time = 0.01 * static_cast<double>(position);
    frame.positions = mesh.rest_positions;
    const auto part = [&](int32_t node) {
      const double x = mesh.rest_positions[static_cast<size_t>(node)][0];
      return (position >= 1 && x < 0.075 ? 1 : 0) + (position >= 2 && x > 0.21 ? 2 : 0);
    };
    for (size_t edge = 0; edge < incidence.edges.size(); ++edge) {
      if (part(incidence.edges[edge][0]) != part(incidence.edges[edge][1]))
        frame.broken_edges.push_back(static_cast<int32_t>(edge));
    }
    return frame;
  };
  FrameSource all;
  all.count = 3;
  all.read = [&](int64_t position) -> absl::StatusOr<Frame> { return frame_of(position); };
  FrameSource ends;
  ends.count = 2;
  ends.read = [&](int64_t position) -> absl::StatusOr<Frame> { return frame_of(2 * position); };
  PreviewOptions options = Small();
  options.color_by = ColorBy::kPiece;
  const auto expected = RenderStill(mesh, all, 2, options);
  ASSERT_TRUE(expected.ok()) << expected.status();
  const auto without = RenderStill(mesh, ends, 1, options);
  ASSERT_TRUE(without.ok()) << without.status();
  EXPECT_NE(without->rgb, expected->rgb);
  ends.pass_by = [&](int64_t position, const FrameSource::Visit& visit) {
    return position == 1 ? visit(frame_of(1)) : absl::OkStatus();
  };
  const auto with = RenderStill(mesh, ends, 1, options);
  ASSERT_TRUE(with.ok()) << with.status();
  EXPECT_EQ(with->rgb, expected->rgb);
}

}  // namespace
}  // namespace cleave
