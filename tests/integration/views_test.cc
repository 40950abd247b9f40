// Viewers look at a region, or at surfaces alone.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/cpp/client.h"
#include "client/cpp/frame_stream.h"
#include "client/cpp/mesh_transfer.h"
#include "core/mesh/incidence.h"
#include "tests/integration/frame_streams.h"
#include "tests/integration/test_server.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;

v1::RegionOfInterest WithNode(int32_t node) {
  v1::RegionOfInterest region;
  region.add_nodes(node);
  return region;
}

FrameStreamOptions Looking(std::optional<Rung> rung, const v1::RegionOfInterest& region) {
  FrameStreamOptions options = Asking(rung);
  options.region = region;
  return options;
}

// As Asking, with what positions are decoded with.
FrameStreamOptions Decoding(Client& client) {
  FrameStreamOptions options = Asking(std::nullopt);
  absl::StatusOr<TetMesh> mesh =
      DownloadMesh(client, client.GetSession(options.session)->scene().mesh().asset(), {});
  EXPECT_TRUE(mesh.ok()) << mesh.status();
  if (!mesh.ok()) return options;
  options.edges = BuildIncidence(*mesh).edges;
  options.rest_positions = std::move(mesh->rest_positions);
  options.tets = std::move(mesh->tets);
  return options;
}

TEST(ViewsTest, ARegionIsAsAccurateAsAskedAndOtherPiecesAreCoarser) {
  constexpr int64_t kLast = 150;  // by then the bar is broken
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  v1::CreateSessionRequest request;
  request.set_session_id("bar");
  *request.mutable_scene() = BreakingBar(kLast);
  request.set_rung(v1::RUNG_FINE);
  ASSERT_TRUE(client->CreateSession(request).ok());
  RunToEnd(*client, "bar");
  FrameStreamOptions options = Decoding(*client);
  FrameStream kept(*client, options);
  options.rung = Rung::kStandard;
  options.region = WithNode(0);
  FrameStream seen(*client, options);
  ASSERT_TRUE(kept.Open().ok());
  ASSERT_TRUE(seen.Open().ok());
  EXPECT_EQ(seen.rung(), Rung::kStandard);
  EXPECT_NEAR(seen.outside_tolerance(), 10 * seen.tolerance(), 1e-12);
  int coarse = 0;
  std::optional<FramePosition> position;
  std::vector<std::string> later;
  for (int64_t frame = 0; frame <= kLast; ++frame) {
    ASSERT_TRUE((*kept.Next()).has_value());
    const absl::StatusOr<std::optional<StreamedFrame>> next = seen.Next();
    ASSERT_TRUE(next.ok() && next->has_value()) << next.status() << server.log();
    if (frame == 100) position = seen.position();
    if (frame > 100) later.push_back((*next)->bytes);
    const std::vector<double> tolerances = seen.decoder()->Tolerances();
    ASSERT_LE(tolerances[0] + kept.tolerance(), 1.0001 * seen.tolerance());
    for (size_t node = 0; node < tolerances.size(); ++node) {
      coarse += tolerances[node] > tolerances[0] ? 1 : 0;
      ASSERT_LE(tolerances[node] + kept.tolerance(), 1.0001 * seen.outside_tolerance());
      for (size_t axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(seen.decoder()->frame().positions[node][axis],
                    kept.decoder()->frame().positions[node][axis], tolerances[node]);
      }
    }
  }
  EXPECT_GT(coarse, 0);
  EXPECT_FALSE((*seen.Next()).has_value());

  // Five regions that are looked at are one too many; one that was is not.
  std::vector<std::unique_ptr<FrameStream>> others;
  for (int32_t node = 1; node < 5; ++node) {
    FrameStreamOptions looking = Looking({}, WithNode(node));
    looking.follow = true;
    others.push_back(std::make_unique<FrameStream>(*client, looking));
    const absl::Status opened = others.back()->Open();
    EXPECT_TRUE(opened.ok()) << opened;
  }
  FrameStream fifth(*client, Looking({}, WithNode(5)));
  const absl::Status refused = fifth.Open();
  EXPECT_TRUE(absl::IsResourceExhausted(refused)) << refused;
  EXPECT_THAT(std::string(refused.message()), HasSubstr("4 regions already"));

  // Who comes back, even to a server that was killed, goes on where it was with the same bytes.
  server.Kill();
  server.Start();
  FrameStreamOptions resumed = Looking(Rung::kStandard, WithNode(0));
  resumed.resume = position;
  FrameStream back(*client, resumed);
  EXPECT_EQ(TakeAll(back), later);
}

TEST(ViewsTest, ASurfaceViewIsSharedAndTellsWhatSurfacesNeed) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  CreateLossless(*client);
  RunToEnd(*client, "bar");
  FrameStreamOptions options = Decoding(*client);
  FrameStream kept(*client, options);
  options.surface = true;
  FrameStream finest(*client, options);
  options.rung = Rung::kStandard;
  FrameStream seen(*client, options);
  ASSERT_TRUE(kept.Open().ok());
  ASSERT_TRUE(finest.Open().ok());
  ASSERT_TRUE(seen.Open().ok());
  EXPECT_EQ(finest.rung(), Rung::kFine);
  EXPECT_EQ(seen.rung(), Rung::kStandard);
  for (int64_t frame = 0; frame <= kFrames; ++frame) {
    ASSERT_TRUE((*kept.Next()).has_value());
    const absl::StatusOr<std::optional<StreamedFrame>> next = seen.Next();
    ASSERT_TRUE(next.ok() && next->has_value()) << next.status() << server.log();
    const Frame& truth = kept.decoder()->frame();
    const Frame& shown = seen.decoder()->frame();
    ASSERT_EQ(shown.broken_edges, truth.broken_edges);
    size_t visible = 0;
    for (size_t node = 0; node < shown.positions.size(); ++node) {
      if (shown.visible[node] == 0) continue;
      ++visible;
      for (size_t axis = 0; axis < 3; ++axis) {
        ASSERT_NEAR(shown.positions[node][axis], truth.positions[node][axis], seen.tolerance());
      }
    }
    ASSERT_GT(visible, 0u);
  }
  EXPECT_TRUE(std::filesystem::exists(server.session_directory("bar") + "/rungs/surface-standard"));
  // Of a session that keeps standard there is a preview, and nothing finer.
  FrameStreamOptions other = Asking(Rung::kLossless);
  other.surface = true;
  FrameStream refused(*client, other);
  EXPECT_THAT(std::string(refused.Open().message()),
              HasSubstr("in the surface view is finer than"));
}

TEST(ViewsTest, RegionsThatCannotBeAreRefusedWithEveryFault) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  Create(*client, "bar", BreakingBar(kFrames));
  WaitFor(*client, "bar", Rests);
  const auto refusal = [&](std::optional<Rung> rung, const v1::RegionOfInterest& region) {
    FrameStream stream(*client, Looking(rung, region));
    return std::string(stream.Open().message());
  };
  EXPECT_THAT(refusal(std::nullopt, {}), HasSubstr("region: has neither nodes nor a box"));
  v1::RegionOfInterest region = WithNode(1 << 30);
  region.set_outside_tolerance(0);
  const std::string faults = refusal(std::nullopt, region);
  EXPECT_THAT(faults, HasSubstr("region.nodes[0]: 1073741824 is outside [0, "));
  EXPECT_THAT(faults, HasSubstr("region.outside_tolerance: 0 m is outside ["));
  EXPECT_THAT(refusal(Rung::kStandard, WithNode(0)), HasSubstr("below twice"));
  region = WithNode(0);
  for (int i = 0; i < 3; ++i) region.mutable_box()->add_min(1);
  EXPECT_THAT(refusal(std::nullopt, region), HasSubstr("region.box: min and max have three"));
  for (int i = 0; i < 3; ++i) region.mutable_box()->add_max(i);
  EXPECT_THAT(refusal(std::nullopt, region),
              HasSubstr("region.box.max: (0, 1, 2) m is outside [1, inf) along x, where"));
  FrameStream stream(*client, Looking(std::nullopt, WithNode(0)));
  ASSERT_TRUE(stream.Open().ok());
  EXPECT_GE(stream.outside_tolerance(), 2 * stream.tolerance());
}

}  // namespace
}  // namespace cleave
