#include "client/io/export/export_series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>

#include "client/io/series/write_aside.h"
#include "core/base/status.h"
#include "core/mesh/incidence.h"
#include "tests/unit/client/io/export/vtu_reader.h"
#include "tests/unit/client/io/two_tets.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using ::cleave::testing::ReadVtu;
using ::cleave::testing::ReadVtuFile;
using ::cleave::testing::XmlReader;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;

// Five frames; from the third on the tip, node 4, is broken off and flies up at 10 m/s.
FrameSource FlyingTip(const TetMesh& mesh) {
  FrameSource source;
  source.count = 5;
  source.read = [&mesh](int64_t position) -> absl::StatusOr<Frame> {
    Frame frame;
    frame.frame = position;
    frame.time = 0.1 * static_cast<double>(position);
    frame.positions = mesh.rest_positions;
    if (position >= 2) {
      frame.positions[4][2] += static_cast<double>(position) - 2;
      const Incidence incidence = BuildIncidence(mesh);
      const auto edges = incidence.node_edges[4];
      frame.broken_edges.assign(edges.begin(), edges.end());
    }
    return frame;
  };
  return source;
}

class ExportSeriesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    options_.folder = directory_.path();
    options_.name = "run";
  }

  std::string ReadWhole(const std::string& name) const {
    std::ifstream file(options_.folder + "/" + name, std::ios::binary);
    std::stringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
  }
  ReadVtu Vtu(const std::string& name) const {
    auto vtu = ReadVtuFile(ReadWhole(name));
    EXPECT_TRUE(vtu.ok()) << vtu.status();
    return vtu.ok() ? *std::move(vtu) : ReadVtu{};
  }

  const TetMesh mesh_ = TwoTets();
  const TemporaryDirectory directory_;
  ExportOptions options_;
};

TEST_F(ExportSeriesTest, SurfaceSeriesShowsPiecesInsideFacesAndVelocities) {
  int64_t calls = 0;
  const auto result = WriteVtuSeries(mesh_, FlyingTip(mesh_), VtuContent::kSurface, options_,
                                     [&](int64_t done, int64_t total) {
                                       EXPECT_EQ(done, ++calls);
                                       EXPECT_EQ(total, 5);
                                       return true;
                                     });
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->written, 5);
  EXPECT_EQ(calls, 5);

  const auto collection = XmlReader::Read(ReadWhole("run.pvd"));
  ASSERT_TRUE(collection.ok()) << collection.status();
  const auto entries = collection->All("DataSet");
  ASSERT_EQ(entries.size(), 5u);
  EXPECT_EQ(entries[3]->attributes.at("file"), "run_000003.vtu");
  EXPECT_DOUBLE_EQ(std::stod(entries[3]->attributes.at("timestep")), 0.3);

  const ReadVtu whole = Vtu("run_000001.vtu");
  EXPECT_EQ(whole.cells, 6);
  EXPECT_THAT(whole.Values<int32_t>("CellData.piece"), Each(0));
  EXPECT_THAT(whole.Values<uint8_t>("CellData.inside"), Each(0));
  const ReadVtu broken = Vtu("run_000004.vtu");
  EXPECT_EQ(broken.time, 0.4);
  EXPECT_THAT(broken.Values<uint8_t>("CellData.inside"), Contains(1));
  const auto regions = broken.Values<int32_t>("CellData.region");
  EXPECT_EQ(std::set<int32_t>(regions.begin(), regions.end()), (std::set<int32_t>{5, 6}));
  const auto pieces = broken.Values<int32_t>("PointData.piece");
  const auto velocities = broken.Values<float>("PointData.velocity");
  const auto displacements = broken.Values<float>("PointData.displacement");
  ASSERT_EQ(velocities.size(), 3 * pieces.size());
  EXPECT_THAT(pieces, Contains(1));
  for (size_t i = 0; i < pieces.size(); ++i) {
    if (pieces[i] != 1) continue;
    EXPECT_NEAR(velocities[3 * i + 2], 10, 1e-4);
    EXPECT_NEAR(displacements[3 * i + 2], 2, 1e-5);
  }
  const auto rest = broken.Values<float>("PointData.rest");
  const auto damages = broken.Values<float>("PointData.damage");
  ASSERT_EQ(rest.size(), displacements.size());
  ASSERT_EQ(damages.size(), pieces.size());
  for (size_t i = 0; i < pieces.size(); ++i) {
    // All tets at the tip have lost half of their edges; the tet below none.
    if (pieces[i] == 1) {
      EXPECT_FLOAT_EQ(damages[i], 0.5f);
    }
    EXPECT_LE(rest[3 * i + 2], 1.0f);
  }
  EXPECT_THAT(damages, Contains(0));
  const auto ids = broken.Values<uint64_t>("PointData.id");
  EXPECT_EQ(std::set<uint64_t>(ids.begin(), ids.end()).size(), pieces.size());
  EXPECT_EQ(broken.Values<uint64_t>("CellData.id").size(), regions.size());
  EXPECT_THAT(broken.Values<float>("PointData.potency"), ::testing::IsEmpty());
  for (const int64_t point : broken.Values<int64_t>("Cells.connectivity")) {
    EXPECT_LT(point, broken.points);
  }
}

TEST_F(ExportSeriesTest, VolumeSeriesSplitsSeparatedTets) {
  const auto result =
      WriteVtuSeries(mesh_, FlyingTip(mesh_), VtuContent::kVolume, options_, nullptr);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_THAT(Vtu("run_000001.vtu").Values<uint8_t>("Cells.types"), ::testing::ElementsAre(10, 10));
  const ReadVtu broken = Vtu("run_000004.vtu");
  EXPECT_THAT(broken.Values<uint8_t>("Cells.types"), ::testing::ElementsAre(10, 12, 12, 12, 12));
  EXPECT_THAT(broken.Values<uint8_t>("CellData.separated"), ::testing::ElementsAre(0, 1, 1, 1, 1));
  EXPECT_THAT(broken.Values<uint8_t>("CellData.broken_edges"),
              ::testing::ElementsAre(0, 3, 3, 3, 3));
  EXPECT_THAT(broken.Values<int32_t>("CellData.piece"), ::testing::ElementsAre(0, 0, 0, 0, 1));
  EXPECT_THAT(broken.Values<int32_t>("CellData.region"), ::testing::ElementsAre(5, 6, 6, 6, 6));
}

TEST_F(ExportSeriesTest, PotencyIsInterpolatedWhereItIsGiven) {
  options_.node_potencies = {0, 0, 0, 0, 4};
  for (const VtuContent content : {VtuContent::kSurface, VtuContent::kVolume}) {
    const auto result = WriteVtuSeries(mesh_, FlyingTip(mesh_), content, options_, nullptr);
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(result->kept, 0);
    const ReadVtu broken = Vtu("run_000004.vtu");
    const auto potencies = broken.Values<float>("PointData.potency");
    const auto rest = broken.Values<float>("PointData.rest");
    ASSERT_EQ(potencies.size(), static_cast<size_t>(broken.points));
    // It is 4 at the tip and 0 at the base, so 4 z in between.
    for (size_t i = 0; i < potencies.size(); ++i) {
      EXPECT_NEAR(potencies[i], 4 * std::max(rest[3 * i + 2], 0.0f), 1e-6);
    }
  }
  EXPECT_THAT(Vtu("run_000004.vtu").Values<float>("CellData.damage"),
              ::testing::ElementsAre(0, 0.5f, 0.5f, 0.5f, 0.5f));
  options_.node_potencies.pop_back();
  EXPECT_THAT(
      std::string(WritePlySeries(mesh_, FlyingTip(mesh_), options_, nullptr).status().message()),
      HasSubstr("node_potencies: has 4 items; the mesh has 5 nodes"));
}

TEST_F(ExportSeriesTest, AStoppedExportGoesOnWithTheSameFiles) {
  const auto stopped = WriteVtuSeries(mesh_, FlyingTip(mesh_), VtuContent::kSurface, options_,
                                      [](int64_t done, int64_t) { return done < 3; });
  EXPECT_EQ(stopped.status().code(), absl::StatusCode::kCancelled);
  EXPECT_THAT(ReadWhole("run.pvd"), HasSubstr("run_000002.vtu"));
  const auto result =
      WriteVtuSeries(mesh_, FlyingTip(mesh_), VtuContent::kSurface, options_, nullptr);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->kept, 3);
  EXPECT_EQ(result->written, 2);
  const std::string resumed = ReadWhole("run_000004.vtu");
  std::filesystem::remove_all(options_.folder);
  ASSERT_TRUE(
      WriteVtuSeries(mesh_, FlyingTip(mesh_), VtuContent::kSurface, options_, nullptr).ok());
  EXPECT_EQ(ReadWhole("run_000004.vtu"), resumed);
}

// Three frames of a body that turns by a quarter each, in the second of which the tip loses the
// only tet that it had.
Frame Turned(const TetMesh& mesh, int64_t number) {
  Frame frame;
  frame.frame = number;
  frame.time = 0.1 * static_cast<double>(number);
  frame.positions = mesh.rest_positions;
  for (int64_t turn = 0; turn < number; ++turn) {
    for (Vec3& position : frame.positions) position = {position[0], -position[2], position[1]};
  }
  if (number > 0) {
    const Incidence incidence = BuildIncidence(mesh);
    const auto edges = incidence.node_edges[4];
    frame.broken_edges.assign(edges.begin(), edges.end());
  }
  return frame;
}

TEST_F(ExportSeriesTest, AFramesFileIsTheSameWhicheverFramesAreLeftOut) {
  FrameSource all;
  all.count = 3;
  all.read = [this](int64_t position) { return Turned(mesh_, position); };
  FrameSource last;  // of the same run
  last.count = 1;
  last.read = [this](int64_t) { return Turned(mesh_, 2); };
  last.pass_by = [this](int64_t, const FrameSource::Visit& visit) -> absl::Status {
    for (const int64_t number : {0, 1}) CLEAVE_RETURN_IF_ERROR(visit(Turned(mesh_, number)));
    return absl::OkStatus();
  };
  for (const std::string kind : {"vtu", "vtu-volume", "ply", "obj"}) {
    SCOPED_TRACE(kind);
    const std::string folder = directory_.path() + "/" + kind;
    const auto write = [&](const FrameSource& frames, const std::string& to) {
      options_.folder = folder + "/" + to;
      return kind == "ply" ? WritePlySeries(mesh_, frames, options_, nullptr)
             : kind == "obj"
                 ? WriteObjSeries(mesh_, frames, options_, nullptr)
                 : WriteVtuSeries(mesh_, frames,
                                  kind == "vtu" ? VtuContent::kSurface : VtuContent::kVolume,
                                  options_, nullptr);
    };
    const std::string file = "run_000002." + kind.substr(0, 3);
    ASSERT_TRUE(write(all, "all").ok());
    const std::string whole = ReadWhole(file);
    ASSERT_TRUE(write(last, "last").ok());
    EXPECT_TRUE(ReadWhole(file) == whole);  // not EXPECT_EQ, which would print them
    // Which is why it may stay where the others are asked for.
    const auto rest = write(all, "last");
    ASSERT_TRUE(rest.ok());
    EXPECT_EQ(rest->kept, 1);
    EXPECT_TRUE(ReadWhole(file) == whole);
  }
}

TEST_F(ExportSeriesTest, FilesOfOtherDataAreNotKept) {
  ASSERT_TRUE(
      WriteVtuSeries(mesh_, FlyingTip(mesh_), VtuContent::kSurface, options_, nullptr).ok());
  const auto volume =
      WriteVtuSeries(mesh_, FlyingTip(mesh_), VtuContent::kVolume, options_, nullptr);
  ASSERT_TRUE(volume.ok());
  EXPECT_EQ(volume->kept, 0);
  TetMesh other = mesh_;
  other.tet_regions = {1, 1};
  const auto changed =
      WriteVtuSeries(other, FlyingTip(other), VtuContent::kVolume, options_, nullptr);
  ASSERT_TRUE(changed.ok());
  EXPECT_EQ(changed->kept, 0);
}

TEST_F(ExportSeriesTest, PlySeriesWritesAFileAFrame) {
  const auto result = WritePlySeries(mesh_, FlyingTip(mesh_), options_, nullptr);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->written, 5);
  EXPECT_EQ(result->collection, "");
  EXPECT_THAT(ReadWhole("run_000000.ply"), HasSubstr("element face 6\n"));
  EXPECT_EQ(WritePlySeries(mesh_, FlyingTip(mesh_), options_, nullptr)->kept, 5);
}

TEST_F(ExportSeriesTest, ObjSeriesWritesAFileAFrameAndTheirMaterials) {
  const auto result = WriteObjSeries(mesh_, FlyingTip(mesh_), options_, nullptr);
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->written, 5);
  EXPECT_THAT(ReadWhole("run_000000.obj"), HasSubstr("mtllib run.mtl\no run\n"));
  EXPECT_THAT(ReadWhole("run_000000.obj"), ::testing::Not(HasSubstr("usemtl inside_")));
  EXPECT_THAT(ReadWhole("run_000004.obj"), HasSubstr("usemtl inside_6\n"));
  EXPECT_THAT(ReadWhole("run_000004.obj"), HasSubstr("g piece_1\n"));
  EXPECT_THAT(ReadWhole("run.mtl"), HasSubstr("newmtl inside_6\n"));
  EXPECT_EQ(WriteObjSeries(mesh_, FlyingTip(mesh_), options_, nullptr)->kept, 5);
}

TEST_F(ExportSeriesTest, ARenderMeshIsWrittenWithItsTextureCoordinatesAndInsideFaces) {
  const TetMesh mesh = TwoTets();
  RenderMesh render;
  render.points = mesh.rest_positions;
  render.triangles = {{3, 2, 0}, {1, 3, 0}, {2, 1, 0}, {2, 3, 4}, {3, 1, 4}, {1, 2, 4}};
  render.uvs.assign(6, CornerUvs{{{0.125f, 0.25f}, {0.125f, 0.25f}, {0.125f, 0.25f}}});
  options_.render_mesh = &render;
  const auto result = WriteObjSeries(mesh, FlyingTip(mesh), options_, {});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->written, 5);
  EXPECT_EQ(result->gaps, 0);
  const std::string whole = ReadWhole("run_000000.obj");
  EXPECT_THAT(whole, HasSubstr("vt 0.125 0.25\n"));
  EXPECT_EQ(whole.find("vt ", whole.find("vt ") + 1), std::string::npos);  // one for all corners
  EXPECT_EQ(whole.find("usemtl inside"), std::string::npos);
  const std::string apart = ReadWhole("run_000004.obj");
  EXPECT_THAT(apart, HasSubstr("g piece_1"));
  EXPECT_THAT(apart, HasSubstr("usemtl inside"));
  // Another render mesh is another export; none too.
  EXPECT_EQ(WriteObjSeries(mesh, FlyingTip(mesh), options_, {})->kept, 5);
  render.points[0][2] -= 0.01;
  EXPECT_EQ(WriteObjSeries(mesh, FlyingTip(mesh), options_, {})->written, 5);
  const auto vtu = WriteVtuSeries(mesh, FlyingTip(mesh), VtuContent::kSurface, options_, {});
  ASSERT_TRUE(vtu.ok()) << vtu.status();
  EXPECT_EQ(vtu->written, 5);
  EXPECT_THAT(ReadWhole("run_000004.vtu"), HasSubstr("Name=\"id\""));
  EXPECT_THAT(ReadWhole("run_000004.vtu"), HasSubstr("Name=\"source\""));
  ASSERT_TRUE(WritePlySeries(mesh, FlyingTip(mesh), options_, {}).ok());
  EXPECT_THAT(ReadWhole("run_000004.ply"), HasSubstr("property list uchar float texcoord\n"));
}

TEST_F(ExportSeriesTest, VtuPointsAreDoubledWhereTextureCoordinatesMeet) {
  RenderMesh render;
  render.points = mesh_.rest_positions;
  render.triangles = {{3, 2, 0}, {1, 3, 0}, {2, 1, 0}, {2, 3, 4}, {3, 1, 4}, {1, 2, 4}};
  // A chart of its own for the first triangle, one for all others.
  render.uvs.assign(6, CornerUvs{{{0.125f, 0.25f}, {0.125f, 0.25f}, {0.125f, 0.25f}}});
  render.uvs[0] = CornerUvs{{{0.5f, 0.5f}, {1, 0.5f}, {0.5f, 1}}};
  options_.render_mesh = &render;
  ASSERT_TRUE(WriteVtuSeries(mesh_, FlyingTip(mesh_), VtuContent::kSurface, options_, {}).ok());
  const std::string bytes = ReadWhole("run_000004.vtu");
  EXPECT_THAT(bytes, HasSubstr("<PointData TCoords=\"uv\">"));
  const ReadVtu vtu = Vtu("run_000004.vtu");
  const auto uvs = vtu.Values<float>("PointData.uv");
  const auto sources = vtu.Values<int64_t>("CellData.source");
  const auto corners = vtu.Values<int64_t>("Cells.connectivity");
  ASSERT_EQ(uvs.size(), 2u * static_cast<size_t>(vtu.points));
  for (size_t triangle = 0; triangle < sources.size(); ++triangle) {
    if (sources[triangle] < 0) continue;
    for (size_t k = 0; k < 3; ++k) {
      const auto point = static_cast<size_t>(corners[3 * triangle + k]);
      if (sources[triangle] == 0) {
        EXPECT_GE(uvs[2 * point], 0.5f);
        EXPECT_GE(uvs[2 * point + 1], 0.5f);
      } else {
        EXPECT_EQ(uvs[2 * point], 0.125f);
        EXPECT_EQ(uvs[2 * point + 1], 0.25f);
      }
    }
  }
  // Copies have the id of what they are copies of, and its place.
  const auto ids = vtu.Values<uint64_t>("PointData.id");
  const auto places = vtu.Values<float>("Points.Points");
  std::map<uint64_t, std::array<float, 3>> place_of;
  for (size_t point = 0; point < ids.size(); ++point) {
    const std::array<float, 3> place = {places[3 * point], places[3 * point + 1],
                                        places[3 * point + 2]};
    EXPECT_EQ(place_of.try_emplace(ids[point], place).first->second, place);
  }
  EXPECT_GT(ids.size(), place_of.size());
  // Without texture coordinates there is nothing to double.
  render.uvs.clear();
  ASSERT_TRUE(WriteVtuSeries(mesh_, FlyingTip(mesh_), VtuContent::kSurface, options_, {}).ok());
  EXPECT_EQ(Vtu("run_000004.vtu").points, static_cast<int64_t>(place_of.size()));
  EXPECT_THAT(ReadWhole("run_000004.vtu"), ::testing::Not(HasSubstr("TCoords")));
}

TEST_F(ExportSeriesTest, BadFramesAreAStatusAndWhatWasWrittenStays) {
  FrameSource none;
  EXPECT_EQ(WriteVtuSeries(mesh_, none, VtuContent::kSurface, options_, nullptr).status().code(),
            absl::StatusCode::kInvalidArgument);
  FrameSource source = FlyingTip(mesh_);
  const auto good = source.read;
  source.read = [good](int64_t position) -> absl::StatusOr<Frame> {
    auto frame = good(position);
    if (position == 2) frame->positions[1][0] = std::numeric_limits<double>::quiet_NaN();
    return frame;
  };
  const auto bad = WriteVtuSeries(mesh_, source, VtuContent::kSurface, options_, nullptr);
  EXPECT_EQ(bad.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(bad.status().message()), HasSubstr("positions[1]"));
  EXPECT_THAT(ReadWhole("run.pvd"), HasSubstr("run_000001.vtu"));
  source.read = [good](int64_t position) -> absl::StatusOr<Frame> {
    if (position == 1) return absl::DataLossError("torn");
    return good(position);
  };
  EXPECT_EQ(WritePlySeries(mesh_, source, options_, nullptr).status().code(),
            absl::StatusCode::kDataLoss);
}

}  // namespace
}  // namespace cleave
