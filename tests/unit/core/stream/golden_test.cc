#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/base/sha256.h"
#include "core/stream/frame_decoder.h"
#include "core/stream/stream_file.h"
#include "gtest/gtest.h"
#include "tests/unit/core/stream/golden_scene.h"
#include "tests/unit/core/stream/stream_fixture.h"

namespace cleave {
namespace {

using namespace stream_test;

std::string Load(const std::string& name) {
  std::ifstream file(kGoldenDirectory + name, std::ios::binary);
  EXPECT_TRUE(file.good()) << name;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

std::vector<Vec3> Positions(const std::string& raw) {
  std::vector<Vec3> positions(raw.size() / sizeof(Vec3));
  std::memcpy(positions.data(), raw.data(), raw.size());
  return positions;
}

std::vector<std::array<int32_t, 2>> Edges(const std::string& raw) {
  std::vector<std::array<int32_t, 2>> edges(raw.size() / 8);
  std::memcpy(edges.data(), raw.data(), raw.size());
  return edges;
}

std::vector<std::array<int32_t, 4>> Tets(const std::string& raw) {
  std::vector<std::array<int32_t, 4>> tets(raw.size() / 16);
  std::memcpy(tets.data(), raw.data(), raw.size());
  return tets;
}

TEST(GoldenStreams, DecodeAsTheyDidWhenTheyWereWritten) {
  for (const GoldenStream& golden : kGoldenStreams) {
    SCOPED_TRACE(golden.name);
    const std::string name = golden.name;
    const std::string bytes = Load(name + ".clv");
    const std::string expected = Load(name + ".expected");
    const std::vector<Vec3> rest = Positions(Load(name + ".rest"));
    std::vector<std::array<int32_t, 2>> edges;
    if (golden.interpolates()) edges = Edges(Load(name + ".edges"));
    std::vector<std::array<int32_t, 4>> tets;
    if (golden.surface) tets = Tets(Load(name + ".tets"));
    const BufferAccess file(bytes);
    const auto reader = StreamFileReader::Open(file);
    ASSERT_TRUE(reader.ok()) << reader.status();
    EXPECT_TRUE(reader->has_footer());
    ASSERT_EQ(reader->rows().size(), static_cast<size_t>(kGoldenFrames));
    FrameDecoder decoder = MakeDecoder(reader->header_bytes(), {rest, edges, tets});
    EXPECT_EQ(decoder.header().predictor_id, golden.predictor_id);
    EXPECT_EQ(decoder.header().coder_id, golden.coder_id);

    std::string kinds;
    int coarse = 0;
    std::string decoded;
    const size_t frame_bytes = rest.size() * sizeof(Vec3);
    for (size_t at = 0; at < reader->rows().size(); ++at) {
      const auto frame_data = reader->ReadFrame(at);
      ASSERT_TRUE(frame_data.ok()) << frame_data.status();
      const absl::Status applied = decoder.Apply(*frame_data);
      ASSERT_TRUE(applied.ok()) << applied;
      kinds += "?KDH"[static_cast<int>(reader->rows()[at].kind)];
      Frame original;
      original.positions = Positions(expected.substr(at * frame_bytes, frame_bytes));
      if (golden.exact()) {
        EXPECT_EQ(original.positions, decoder.frame().positions) << at;
      } else if (golden.regions || golden.surface) {
        const std::vector<double> tolerances = decoder.Tolerances();
        for (size_t node = 0; node < rest.size(); ++node) {
          if (golden.surface && decoder.frame().visible[node] == 0) continue;
          coarse += tolerances[node] > 2 * kGoldenTolerance ? 1 : 0;
          for (size_t axis = 0; axis < 3; ++axis) {
            EXPECT_NEAR(original.positions[node][axis], decoder.frame().positions[node][axis],
                        tolerances[node])
                << at;
          }
        }
      } else {
        const double tolerance = at == 12 ? kGoldenFinerTolerance : kGoldenTolerance;
        EXPECT_LE(WorstErrors(original, decoder.frame()).as_double, tolerance) << at;
        EXPECT_LE(WorstErrors(original, decoder.frame()).as_float, tolerance) << at;
      }
      decoded.append(reinterpret_cast<const char*>(decoder.frame().positions.data()), frame_bytes);
    }
    EXPECT_EQ(coarse > 500, golden.regions);
    EXPECT_EQ(kinds, golden.exact() ? "KDDHDKDDDDKDD" : "KDDHDKDDDDKDK");
    EXPECT_EQ(decoder.epoch(), 1u);
    EXPECT_EQ(decoder.frame().broken_edges.size(), golden.broken_edges);
    EXPECT_EQ(Sha256::Of(decoded), Load(name + ".decoded_sha256"));
  }
}

}  // namespace
}  // namespace cleave
