#include "server/gateway/session_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <future>

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
