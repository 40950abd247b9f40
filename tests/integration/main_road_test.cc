// The whole way of a scene, stage by stage, through the real programs: the test to read first.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "client/cpp/client.h"
#include "client/cpp/frame_stream.h"
#include "client/cpp/mesh_transfer.h"
#include "client/io/export/export_series.h"
#include "client/io/mesh/mesh_file.h"
#include "client/io/record/recorder.h"
#include "client/io/record/recording.h"
#include "client/io/scene/scene_file.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/scene/validate.h"
#include "proto/convert/mesh.h"
#include "proto/convert/scene.h"
#include "tests/integration/test_server.h"

namespace cleave {
namespace {

using ::testing::Gt;
using ::testing::HasSubstr;

TEST(MainRoadTest, AMeshFileBecomesAStreamOfItsBreakAndAFilmOfIt) {
  TestServer server;
  TemporaryDirectory out;

  // Submit: the scene and the mesh are read from files; the mesh goes first, so that the scene can
  // name it.
  absl::StatusOr<SceneFile> file =
      ReadSceneFile(CLEAVE_SOURCE_DIR "/tests/scenes/tensile_bar.scene.json");
  ASSERT_TRUE(file.ok()) << file.status();
  absl::StatusOr<TetMesh> mesh = ReadMeshFile(MeshPath(*file));
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  const std::unique_ptr<Client> client = server.Connect();
  ASSERT_NE(client, nullptr);
  const absl::StatusOr<UploadedMesh> uploaded = UploadMesh(*client, *mesh, {});
  ASSERT_TRUE(uploaded.ok()) << uploaded.status();
  EXPECT_GT(uploaded->bytes_sent, 0);
  v1::Scene& scene = file->scene;
  scene.mutable_mesh()->set_asset(uploaded->asset);
  Faults faults;
  const Scene checked = SceneFromMessage(scene, faults);
  faults.Append("", ValidateScene(checked));
  ASSERT_TRUE(faults.ok()) << faults.ToStatus();

  // Receive, validate, bake: the server holds the scene to its rules, with the mesh.
  v1::CreateSessionRequest request;
  request.set_session_id("bar");
  *request.mutable_scene() = scene;
  request.set_validate_only(true);
  const absl::StatusOr<v1::CreateSessionResponse> planned = client->CreateSession(request);
  ASSERT_TRUE(planned.ok()) << planned.status();
  EXPECT_EQ(planned->plan().tet_count(), mesh->tet_count());
  EXPECT_GT(planned->plan().total_bytes(), 0);
  EXPECT_TRUE(client->ListSessions()->empty());

  // Assemble: the worker builds the model and commits the rest state.
  const v1::Session created = Create(*client, "bar", scene);
  EXPECT_EQ(created.scene().mesh().asset(), uploaded->asset);
  EXPECT_EQ(WaitFor(*client, "bar", Rests).head_frame(), 0);

  // Step, fracture, extract, encode: the worker runs on its own; stream, decode: we look on.
  v1::RunGoal goal;
  goal.set_stop_on_fracture(true);
  ASSERT_TRUE(client->RunSession("sessions/bar", goal).ok());
  ScaleMesh(checked.mesh.unit_scale, *mesh);
  ASSERT_TRUE(CheckAndOrientMesh(*mesh).ok());
  FrameStreamOptions options;
  options.session = "sessions/bar";
  options.rest_positions = mesh->rest_positions;
  const auto edges = BuildIncidence(*mesh).edges;
  options.edges = edges;
  FrameStream stream(*client, options);
  absl::StatusOr<std::unique_ptr<Recorder>> recorder = Recorder::Open(out / "bar.clv");
  ASSERT_TRUE(recorder.ok());
  ASSERT_TRUE(stream.Open().ok());
  ASSERT_TRUE((*recorder)->Begin(stream.header_bytes()).ok());
  while (true) {
    const absl::StatusOr<std::optional<StreamedFrame>> frame = stream.Next();
    ASSERT_TRUE(frame.ok()) << frame.status() << server.log();
    if (!frame->has_value()) break;
    ASSERT_TRUE((*recorder)->Append((*frame)->bytes).ok());
  }
  EXPECT_EQ(stream.end()->reason(), v1::END_REASON_GOAL_REACHED);
  ASSERT_NE(stream.decoder(), nullptr);
  const Frame last = stream.decoder()->frame();
  EXPECT_THAT(last.broken_edges.size(), Gt(0u));
  EXPECT_EQ(last.positions.size(), mesh->rest_positions.size());
  ASSERT_TRUE((*recorder)->Finish().ok());

  // What the worker reports is beside the frames.
  const std::string reports = ReadBytes(server.session_directory("bar") + "/reports.jsonl");
  EXPECT_EQ(std::count(reports.begin(), reports.end(), '\n'), last.frame);
  EXPECT_THAT(reports, HasSubstr("\"motion_forces\":[["));
  EXPECT_THAT(reports, HasSubstr("\"in_force\":{\"precision\":\"double\""));

  // Show: a series that ParaView opens.
  const absl::StatusOr<Recording> recording =
      OpenRecording(out / "bar.clv", {mesh->rest_positions, edges});
  ASSERT_TRUE(recording.ok()) << recording.status();
  EXPECT_EQ(recording->frames.count, last.frame + 1);
  ExportOptions export_options;
  export_options.folder = out / "vtu";
  const absl::StatusOr<ExportResult> exported =
      WriteVtuSeries(*mesh, recording->frames, VtuContent::kSurface, export_options, {});
  ASSERT_TRUE(exported.ok()) << exported.status();
  EXPECT_EQ(exported->written, last.frame + 1);
  EXPECT_THAT(ReadBytes(exported->collection), HasSubstr(".vtu"));

  EXPECT_EQ(server.Stop(), 0) << server.log();
}

}  // namespace
}  // namespace cleave
