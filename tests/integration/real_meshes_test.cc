// Meshes that others made, sent to the real server: each runs or is refused clearly.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "client/cpp/mesh_transfer.h"
#include "client/io/mesh/mesh_file.h"
#include "client/io/surface/surface_file.h"
#include "core/base/counter_rng.h"
#include "core/damage/named_pieces.h"
#include "core/mesh/incidence.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/quality.h"
#include "core/mesh/surface_mesh.h"
#include "core/surface/embedded_mesh.h"
#include "core/surface/fans.h"
#include "core/surface/shared_edges.h"
#include "tests/integration/test_server.h"
#include "tests/unit/core/surface/surface_checks.h"

namespace cleave {
namespace {

constexpr int64_t kMessageLimit = 4 << 20;

struct Extent {
  Vec3 low, high;
  size_t longest;  // axis
};
Extent ExtentOf(const TetMesh& mesh) {
  Vec3 low = mesh.rest_positions.front(), high = low;
  for (const Vec3& x : mesh.rest_positions) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], x[axis]);
      high[axis] = std::max(high[axis], x[axis]);
    }
  }
  size_t longest = 0;
  for (size_t axis = 1; axis < 3; ++axis) {
    if (high[axis] - low[axis] > high[longest] - low[longest]) longest = axis;
  }
  return {low, high, longest};
}

// A scene that holds the body at one end of its longest side and pulls the other by `stretch` of
// that side within the run.
v1::Scene PulledApart(const TetMesh& mesh, double stretch) {
  const auto [low, high, longest] = ExtentOf(mesh);
  const double length = high[longest] - low[longest];

  v1::Scene scene;
  v1::Material& material = *scene.add_materials();
  material.set_youngs_modulus(1e7);
  material.set_poisson_ratio(0.3);
  material.set_density(1000);
  material.set_tensile_strength(4e5);
  // Sound crosses the body several times within a frame, so that the pull is felt everywhere.
  const double frame = 10 * length / 100;
  scene.mutable_timing()->set_frames_per_second(1 / frame);
  scene.mutable_timing()->set_frame_count(4);
  scene.mutable_timing()->set_steps_per_frame(2);
  for (const bool far : {false, true}) {
    v1::NodeSet& set = *scene.add_node_sets();
    set.set_name(far ? "far" : "near");
    v1::PlaneSelector& plane = *set.add_select()->mutable_plane();
    const double edge = far ? high[longest] - 0.03 * length : low[longest] + 0.03 * length;
    for (size_t axis = 0; axis < 3; ++axis) {
      plane.add_point(axis == longest ? edge : 0);
      plane.add_normal(axis == longest ? (far ? 1 : -1) : 0);
    }
    v1::Motion& motion = *scene.add_motions();
    motion.set_node_set(set.name());
    if (!far) continue;
    motion.add_keyframes();
    v1::Keyframe& end = *motion.add_keyframes();
    end.set_time(4 * frame);
    for (size_t axis = 0; axis < 3; ++axis) {
      end.add_translation(axis == longest ? stretch * length : 0);
    }
  }
  return scene;
}

std::string PathOf(const std::string& name) { return std::string(CLEAVE_MESHES_DIR) + "/" + name; }

// Sends mesh and scene, and returns what the session is after `frames` frames.
v1::Session RunOn(Client& client, const TetMesh& mesh, const std::string& id, v1::Scene scene,
                  int64_t frames) {
  const absl::StatusOr<UploadedMesh> uploaded = UploadMesh(client, mesh, {});
  EXPECT_TRUE(uploaded.ok()) << uploaded.status();
  if (!uploaded.ok()) return {};
  scene.mutable_mesh()->set_asset(uploaded->asset);
  Create(client, id, scene);
  v1::RunGoal goal;
  goal.set_until_frame(frames);
  EXPECT_TRUE(client.RunSession(SessionName(id), goal).ok());
  const std::vector<std::string> sent = AllFrames(client, id);
  EXPECT_EQ(static_cast<int64_t>(sent.size()), frames + 1);
  const absl::StatusOr<v1::Session> session = client.GetSession(SessionName(id));
  EXPECT_TRUE(session.ok()) << session.status();
  return session.ok() ? *session : v1::Session();
}

TEST(RealMeshes, EveryFileRunsOrIsRefusedWithItsName) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  int ran = 0, refused = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(CLEAVE_MESHES_DIR)) {
    const std::string name = entry.path().filename();
    // The two large ones have tests of their own.
    if (!entry.is_regular_file() || name == "SOURCES.md" || name == "rod300x33.msh" ||
        name.starts_with("spot_276k")) {
      continue;
    }
    SCOPED_TRACE(name);
    const absl::StatusOr<TetMesh> mesh = ReadMeshFile(entry.path());
    if (!mesh.ok()) {
      ++refused;
      EXPECT_THAT(std::string(mesh.status().message()), testing::HasSubstr(name));
      continue;
    }
    const v1::Session session =
        RunOn(*client, *mesh, "mesh-" + std::to_string(ran), PulledApart(*mesh, /*stretch=*/0.001),
              /*frames=*/1);
    EXPECT_EQ(session.state(), v1::SESSION_STATE_IDLE);
    EXPECT_EQ(session.head_frame(), 1);
    ++ran;
  }
  EXPECT_GE(ran, 10);
  EXPECT_GE(refused, 5);
}

// Cut across its middle but for a strip, so that it breaks in one place and in a few passes.
TEST(RealMeshes, ASlenderRodPulledApartBreaks) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  const absl::StatusOr<TetMesh> mesh = ReadMeshFile(PathOf("tet/rod300x33.msh"));
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  const auto [low, high, along] = ExtentOf(*mesh);
  const size_t across = (along + 1) % 3;
  const double middle = 0.5 * (low[along] + high[along]);
  const double strip = low[across] + 0.15 * (high[across] - low[across]);
  int64_t cut = 0;
  for (const auto& [a, b] : BuildIncidence(*mesh).edges) {
    const Vec3 &x = mesh->rest_positions[static_cast<size_t>(a)],
               &y = mesh->rest_positions[static_cast<size_t>(b)];
    cut += (x[along] - middle) * (y[along] - middle) < 0 && std::max(x[across], y[across]) > strip;
  }

  v1::Scene scene = PulledApart(*mesh, /*stretch=*/0.03);
  v1::Weakening& weakening = *scene.add_weakenings();
  weakening.set_factor(0);
  v1::BoxSelector& plane = *weakening.mutable_box();
  for (size_t axis = 0; axis < 3; ++axis) {
    plane.add_min(axis == along ? middle - 1e-6 : axis == across ? strip : low[axis]);
    plane.add_max(axis == along ? middle + 1e-6 : high[axis]);
  }
  const v1::Session session = RunOn(*client, *mesh, "rod", scene, /*frames=*/4);
  EXPECT_EQ(session.head_frame(), 4);
  EXPECT_GE(session.progress().fragments(), 2);
  EXPECT_GT(session.progress().broken_edges(), cut + 10);
}

TEST(RealMeshes, AMeshBeyondTheMessageLimitStreamsThroughTheGateway) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  EXPECT_EQ(client->server().limits().max_message_bytes(), static_cast<uint64_t>(kMessageLimit));
  const absl::StatusOr<TetMesh> mesh = ReadMeshFile(PathOf("tet/spot_276k_v41bin.msh.zst"));
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  ASSERT_GT(mesh->tet_count() * 16, kMessageLimit);
  const v1::Session session =
      RunOn(*client, *mesh, "spot", PulledApart(*mesh, /*stretch=*/0.001), /*frames=*/3);
  EXPECT_EQ(session.head_frame(), 3);
}

// Figurines and food that artists modelled, open at places: bodies of them come apart.
TEST(RealMeshes, SurfacesBecomeBodiesThatBreak) {
  TestServer server;
  const std::unique_ptr<Client> client = server.Connect();
  for (const auto& [name, cell_size] : std::vector<std::pair<std::string, double>>{
           {"koala_low_resolution", 0.35}, {"pizza", 0.016}, {"spot_low_resolution", 0.15}}) {
    SCOPED_TRACE(name);
    const auto surface = ReadSurfaceFile(PathOf("surface/" + name + ".obj"));
    ASSERT_TRUE(surface.ok()) << surface.status();
    for (const MeshLayout layout : {MeshLayout::kJitteredLattice, MeshLayout::kUnstructured}) {
      MeshResolution resolution;
      resolution.cell_size = cell_size;
      resolution.layout = layout;
      auto body = MeshSurface(surface->vertices, surface->triangles, resolution);
      ASSERT_TRUE(body.ok()) << body.status();
      const Faults faults = CheckAndOrientMesh(body->mesh);
      EXPECT_TRUE(faults.ok()) << faults.ToStatus();
      EXPECT_EQ(faults.warning_count(), 0);
      const MeshReport report = ReportMesh(body->mesh, BuildIncidence(body->mesh));
      EXPECT_GT(report.min_dihedral, 0.1);
      EXPECT_NEAR(report.volume / body->surface_volume, 1, 0.2);
      if (name == "pizza") break;  // large enough as it is
      if (layout != MeshLayout::kUnstructured) continue;
      std::string id = name;
      std::replace(id.begin(), id.end(), '_', '-');
      const v1::Session session =
          RunOn(*client, body->mesh, id, PulledApart(body->mesh, /*stretch=*/0.3), /*frames=*/3);
      EXPECT_GT(session.progress().broken_edges(), 0);
    }
  }
}

// Tets too coarse for the legs' and ears' creases, which the figurine itself bridges: its pieces
// are closed 2-manifolds all the same.
TEST(RealMeshes, AFigurineRoundACoarseBodyBreaksIntoManifolds) {
  const auto surface = ReadSurfaceFile(PathOf("surface/koala_low_resolution.obj"));
  ASSERT_TRUE(surface.ok()) << surface.status();
  const RenderMesh render{surface->vertices, surface->triangles, surface->uvs};
  ASSERT_EQ(CountOpenEdges(render.triangles), 0);
  MeshResolution resolution;
  resolution.cell_size = 0.8;
  const auto body = MeshSurface(surface->vertices, surface->triangles, resolution);
  ASSERT_TRUE(body.ok()) << body.status();
  const Incidence incidence = BuildIncidence(body->mesh);
  const Faces faces = BuildFaces(body->mesh);
  EmbeddedMesh embedded(body->mesh, incidence, faces, render);
  EXPECT_GT(embedded.gaps(), 0);
  NamedPieces pieces(body->mesh, incidence);
  for (const double share : {0.4, 0.9}) {
    SCOPED_TRACE(share);
    std::vector<int32_t> edges;
    for (int32_t edge = 0; edge < incidence.edge_count(); ++edge) {
      const double draw = UniformDraw(2, RandomStream::kEdgeDraw, static_cast<uint64_t>(edge), 0);
      if (draw < share && draw >= share - 0.5) edges.push_back(edge);
    }
    pieces.Break(edges);
    embedded.Break(edges, pieces);
    SurfaceTopology topology = embedded.topology();
    std::vector<CornerUvs> uvs = embedded.uvs();
    std::vector<int32_t> sources = embedded.sources();
    SeparateSharedEdges(topology, uvs, sources);
    SeparateFans(topology);
    ASSERT_NO_FATAL_FAILURE(ExpectManifold(topology));
  }
  EXPECT_GT(pieces.count(), 5);
}

}  // namespace
}  // namespace cleave
