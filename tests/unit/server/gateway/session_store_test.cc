#include "server/gateway/session_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <future>

#include "proto/convert/mesh.h"
#include "server/session/config.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

v1::CreateSessionRequest BoxRequest(const std::string& id) {
  v1::CreateSessionRequest request;
  request.set_session_id(id);
  v1::BoxMesh& box = *request.mutable_scene()->mutable_mesh()->mutable_box();
  for (int i = 0; i < 3; ++i) box.add_size(1);
  box.mutable_resolution()->set_layout(v1::MESH_LAYOUT_JITTERED_LATTICE);
  box.mutable_resolution()->set_cell_size(0.5);
  v1::Material& material = *request.mutable_scene()->add_materials();
  material.set_name("gel");
  material.set_youngs_modulus(1e5);
  material.set_poisson_ratio(0.3);
  material.set_density(1000);
  return request;
}

class SessionStoreTest : public testing::Test {
 protected:
  void SetUp() override { Open(); }
  void Open() {
    store_.reset();
    assets_ = *AssetStore::Open(directory_.path(), {});
    auto store = SessionStore::Open(directory_.path(), *assets_, WorkerOptions{"/bin/false", 1});
    ASSERT_TRUE(store.ok()) << store.status();
    store_ = *std::move(store);
  }
  std::vector<std::string> Ids() {
    bool more = false;
    std::vector<std::string> ids;
    for (const auto& session : store_->List("", 100, more)) {
      ids.push_back(session->config().session_id());
    }
    return ids;
  }

  TemporaryDirectory directory_;
  std::unique_ptr<AssetStore> assets_;
  std::unique_ptr<SessionStore> store_;
};

TEST_F(SessionStoreTest, ACreatedSessionIsThereAfterARestartWithItsMesh) {
  const auto created = store_->Create(BoxRequest("box"));
  ASSERT_TRUE(created.ok()) << created.status();
  const std::string asset = created->session().scene().mesh().asset();
  EXPECT_TRUE(assets_->Has(asset));
  Open();
  EXPECT_THAT(Ids(), testing::ElementsAre("box"));
  EXPECT_EQ((*store_->Find("sessions/box"))->View(true).scene().mesh().asset(), asset);
}

TEST_F(SessionStoreTest, ValidatingCreatesNothing) {
  v1::CreateSessionRequest request = BoxRequest("box");
  request.set_validate_only(true);
  const auto validated = store_->Create(request);
  ASSERT_TRUE(validated.ok()) << validated.status();
  EXPECT_FALSE(validated->has_session());
  EXPECT_EQ(validated->plan().tet_count(), 48);
  EXPECT_GT(validated->plan().parts_size(), 0);
  EXPECT_TRUE(Ids().empty());
  EXPECT_TRUE(std::filesystem::is_empty(directory_ / "assets"));
}

TEST_F(SessionStoreTest, ARenderMeshIsHeldToTheBodyAndStaysWithTheSession) {
  RenderMesh mesh;
  mesh.points = {{0, 0, 0}, {0, 1000, 0}, {1000, 0, 0}, {0, 0, 1000}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  v1::CreateSessionRequest request = BoxRequest("box");
  v1::RenderMeshSource& source = *request.mutable_scene()->mutable_render_mesh();
  source.set_asset(std::string(64, 'a'));
  const absl::Status missing = store_->Create(request).status();
  EXPECT_TRUE(absl::IsFailedPrecondition(missing));
  EXPECT_THAT(std::string(missing.message()), testing::HasSubstr("the server has no asset aaa"));

  source.set_asset(*assets_->Add(*SerializeRenderMesh(mesh)));
  const absl::Status large = store_->Create(request).status();
  EXPECT_THAT(std::string(large.message()),
              testing::HasSubstr("scene.render_mesh.points: spans 1732.05 m, the body 1.73205 m"));
  source.set_unit_scale(0.001);
  const auto created = store_->Create(request);
  ASSERT_TRUE(created.ok()) << created.status();
  EXPECT_EQ(created->session().scene().render_mesh().asset(), source.asset());

  // Nothing is planned for it.
  v1::CreateSessionRequest without = BoxRequest("bare");
  EXPECT_EQ(store_->Create(without)->plan().SerializeAsString(),
            created->plan().SerializeAsString());
  // The mesh of a body is none, nor is it a body's.
  request.set_session_id("other");
  source.set_asset(created->session().scene().mesh().asset());
  EXPECT_THAT(std::string(store_->Create(request).status().message()),
              testing::HasSubstr("scene.render_mesh.triangles: is empty"));
  without.set_session_id("wrong");
  without.mutable_scene()->mutable_mesh()->set_asset(
      created->session().scene().render_mesh().asset());
  EXPECT_TRUE(absl::IsInvalidArgument(store_->Create(without).status()));
}

TEST_F(SessionStoreTest, AMeshThatIsTooLargeIsRefusedBeforeItIsMade) {
  v1::CreateSessionRequest request = BoxRequest("box");
  request.mutable_scene()->mutable_mesh()->mutable_box()->mutable_resolution()->set_cell_size(
      0.0055);
  const absl::Status status = store_->Create(request).status();
  EXPECT_TRUE(absl::IsResourceExhausted(status)) << status;
}

TEST_F(SessionStoreTest, WhatACrashLeftHalfMadeIsRemovedAndADamagedSessionHurtsNoOther) {
  ASSERT_TRUE(store_->Create(BoxRequest("good")).ok());
  ASSERT_TRUE(store_->Create(BoxRequest("torn")).ok());
  WriteBytes(directory_ / "sessions/torn/config.pb", "torn");
  std::filesystem::create_directories(directory_ / "sessions/.half/frames");
  std::filesystem::create_directories(directory_ / "sessions/empty");
  Open();
  EXPECT_THAT(Ids(), testing::ElementsAre("good"));
  EXPECT_FALSE(std::filesystem::exists(directory_ / "sessions/.half"));
  EXPECT_TRUE(std::filesystem::exists(directory_ / "sessions/torn"));
}

TEST_F(SessionStoreTest, PagesFollowEachOther) {
  for (const char* id : {"ccc", "aaa", "bbb"}) {
    ASSERT_TRUE(store_->Create(BoxRequest(id)).ok());
  }
  bool more = false;
  EXPECT_EQ(store_->List("", 2, more).size(), 2u);
  EXPECT_TRUE(more);
  const auto rest = store_->List("bbb", 2, more);
  ASSERT_EQ(rest.size(), 1u);
  EXPECT_EQ(rest[0]->config().session_id(), "ccc");
  EXPECT_FALSE(more);
}

TEST_F(SessionStoreTest, ADeletedSessionLeavesNothingBehind) {
  ASSERT_TRUE(store_->Create(BoxRequest("box")).ok());
  std::promise<absl::Status> deleted;
  store_->Delete("sessions/box", [&](const absl::Status& status) { deleted.set_value(status); });
  EXPECT_TRUE(deleted.get_future().get().ok());
  EXPECT_FALSE(std::filesystem::exists(directory_ / "sessions/box"));
  EXPECT_TRUE(absl::IsNotFound(store_->Find("sessions/box").status()));
}

}  // namespace
}  // namespace cleave
