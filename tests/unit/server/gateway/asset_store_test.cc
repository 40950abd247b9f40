#include "server/gateway/asset_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <algorithm>
#include <filesystem>

#include "absl/strings/escaping.h"
#include "core/base/crc32c.h"
#include "core/base/sha256.h"
#include "google/rpc/error_details.pb.h"
#include "proto/convert/mesh.h"
#include "server/gateway/errors.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

constexpr char kUploadId[] = "upload-0001";

std::string ReasonOf(const absl::Status& status) {
  const auto payload = status.GetPayload(std::string(kTypeUrlPrefix) + "google.rpc.ErrorInfo");
  google::rpc::ErrorInfo info;
  if (payload.has_value()) info.ParseFromString(std::string(*payload));
  return info.reason();
}

TetMesh OneTet() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {}, {}}; }

v1::AssetSpec SpecOf(const std::string& bytes) {
  v1::AssetSpec spec;
  spec.set_kind(v1::ASSET_KIND_TET_MESH);
  spec.mutable_digest()->set_sha256(Sha256::Of(bytes));
  spec.mutable_digest()->set_size_bytes(static_cast<int64_t>(bytes.size()));
  return spec;
}

v1::UploadAssetRequest ChunkOf(const std::string& bytes, size_t offset, size_t size) {
  v1::UploadAssetRequest chunk;
  chunk.set_upload_id(kUploadId);
  chunk.set_offset(static_cast<int64_t>(offset));
  chunk.set_payload(bytes.substr(offset, size));
  chunk.set_raw_size(static_cast<uint32_t>(chunk.payload().size()));
  chunk.set_crc32c(Crc32c(chunk.payload()));
  return chunk;
}

class AssetStoreTest : public testing::Test {
 protected:
  void SetUp() override {
    absl::StatusOr<std::unique_ptr<AssetStore>> store =
        AssetStore::Open(directory_.path(), AssetLimits{1 << 20, 4096, 10});
    ASSERT_TRUE(store.ok());
    store_ = *std::move(store);
    bytes_ = *SerializeMesh(OneTet());
    name_ = absl::BytesToHexString(Sha256::Of(bytes_));
  }
  std::unique_ptr<AssetStore::Upload> Begin() {
    auto upload = store_->Begin(kUploadId, SpecOf(bytes_));
    EXPECT_TRUE(upload.ok()) << upload.status();
    return *std::move(upload);
  }

  TemporaryDirectory directory_;
  std::unique_ptr<AssetStore> store_;
  std::string bytes_;
  std::string name_;
};

TEST_F(AssetStoreTest, AnUploadIsAnAssetOnceItIsFinished) {
  auto upload = Begin();
  ASSERT_TRUE(upload->Append(ChunkOf(bytes_, 0, 10)).ok());
  ASSERT_TRUE(upload->Append(ChunkOf(bytes_, 10, 4096)).ok());
  EXPECT_FALSE(store_->Has(name_));
  const auto warnings = upload->Finish();
  ASSERT_TRUE(warnings.ok()) << warnings.status();
  EXPECT_TRUE(store_->Has(name_));
  EXPECT_EQ(ReadBytes(store_->PathOf(name_)), bytes_);
  EXPECT_EQ(store_->LoadMesh(name_)->tets, OneTet().tets);
  EXPECT_TRUE(std::filesystem::is_empty(directory_ / "uploads"));
}

TEST_F(AssetStoreTest, AnAssetThatIsThereIsNotTakenTwice) {
  ASSERT_TRUE(store_->Add(bytes_).ok());
  EXPECT_TRUE(Begin()->complete());
}

TEST_F(AssetStoreTest, AnUploadResumesWhereItWasCutAlsoByAnotherServer) {
  for (size_t cut = 0; cut <= bytes_.size(); ++cut) {
    { ASSERT_TRUE(Begin()->Append(ChunkOf(bytes_, 0, cut)).ok()); }
    SetUp();
    EXPECT_EQ(store_->Query(kUploadId)->committed_size(), static_cast<int64_t>(cut));
    auto upload = Begin();
    ASSERT_EQ(upload->received_bytes(), static_cast<int64_t>(cut));
    ASSERT_TRUE(upload->Append(ChunkOf(bytes_, cut, 4096)).ok());
    ASSERT_TRUE(upload->Finish().ok());
    EXPECT_TRUE(absl::IsNotFound(store_->Query(kUploadId).status()));
    std::filesystem::remove(store_->PathOf(name_));
  }
}

TEST_F(AssetStoreTest, ABadChunkBetweenGoodOnesIsRefusedAndTheGoodOnesStay) {
  auto upload = Begin();
  ASSERT_TRUE(upload->Append(ChunkOf(bytes_, 0, 10)).ok());

  v1::UploadAssetRequest bad = ChunkOf(bytes_, 10, 10);
  (*bad.mutable_payload())[3] ^= 1;
  EXPECT_EQ(ReasonOf(upload->Append(bad)), "CHUNK_CORRUPT");
  bad = ChunkOf(bytes_, 10, 10);
  bad.set_crc32c(bad.crc32c() + 1);
  EXPECT_EQ(ReasonOf(upload->Append(bad)), "CHUNK_CORRUPT");
  bad = ChunkOf(bytes_, 10, 10);
  bad.set_raw_size(9);
  EXPECT_EQ(ReasonOf(upload->Append(bad)), "CHUNK_CORRUPT");
  for (const size_t offset : {0u, 9u, 11u}) {
    EXPECT_EQ(ReasonOf(upload->Append(ChunkOf(bytes_, offset, 10))), "UPLOAD_OFFSET");
  }
  bad = ChunkOf(bytes_, 10, 10);
  bad.set_upload_id("another-upload");
  EXPECT_TRUE(absl::IsInvalidArgument(upload->Append(bad)));
  bad = ChunkOf(bytes_, 10, 10);
  bad.set_raw_size(4097);
  EXPECT_TRUE(absl::IsInvalidArgument(upload->Append(bad)));

  EXPECT_EQ(upload->received_bytes(), 10);
  ASSERT_TRUE(upload->Append(ChunkOf(bytes_, 10, 4096)).ok());
  EXPECT_TRUE(upload->Finish().ok());
}

TEST_F(AssetStoreTest, MoreBytesThanDeclaredAreRefused) {
  auto upload = Begin();
  EXPECT_EQ(ReasonOf(upload->Append(ChunkOf(bytes_ + "x", 0, 4096))), "UPLOAD_TOO_LONG");
  ASSERT_TRUE(upload->Append(ChunkOf(bytes_, 0, 4096)).ok());
  EXPECT_EQ(ReasonOf(upload->Append(ChunkOf(bytes_ + "x", bytes_.size(), 1))), "UPLOAD_TOO_LONG");
}

TEST_F(AssetStoreTest, FinishingTooEarlyIsRefusedAndCanBeMadeGood) {
  auto upload = Begin();
  ASSERT_TRUE(upload->Append(ChunkOf(bytes_, 0, 10)).ok());
  EXPECT_EQ(ReasonOf(upload->Finish().status()), "UPLOAD_TOO_SHORT");
  EXPECT_FALSE(store_->Has(name_));
  ASSERT_TRUE(upload->Append(ChunkOf(bytes_, 10, 4096)).ok());
  EXPECT_TRUE(upload->Finish().ok());
}

TEST_F(AssetStoreTest, AWrongDigestDiscardsWhatWasReceived) {
  v1::AssetSpec spec = SpecOf(bytes_);
  (*spec.mutable_digest()->mutable_sha256())[0] ^= 1;
  {
    auto upload = store_->Begin(kUploadId, spec);
    ASSERT_TRUE((*upload)->Append(ChunkOf(bytes_, 0, 4096)).ok());
    EXPECT_EQ(ReasonOf((*upload)->Finish().status()), "ASSET_DIGEST_MISMATCH");
  }
  EXPECT_TRUE(absl::IsNotFound(store_->Query(kUploadId).status()));
  EXPECT_TRUE(std::filesystem::is_empty(directory_ / "assets"));
}

TEST_F(AssetStoreTest, OfTwoWritersOfOneUploadTheSecondIsRefused) {
  auto first = Begin();
  EXPECT_EQ(ReasonOf(store_->Begin(kUploadId, SpecOf(bytes_)).status()), "UPLOAD_BUSY");
  first.reset();
  EXPECT_TRUE(store_->Begin(kUploadId, SpecOf(bytes_)).ok());
}

TEST_F(AssetStoreTest, TwoUploadsOfOneAssetBothEndWithIt) {
  auto first = Begin();
  auto second = *store_->Begin("upload-0002", SpecOf(bytes_));
  ASSERT_TRUE(first->Append(ChunkOf(bytes_, 0, 4096)).ok());
  v1::UploadAssetRequest chunk = ChunkOf(bytes_, 0, 4096);
  chunk.set_upload_id("upload-0002");
  ASSERT_TRUE(second->Append(chunk).ok());
  EXPECT_TRUE(first->Finish().ok());
  EXPECT_TRUE(second->Finish().ok());
  EXPECT_EQ(ReadBytes(store_->PathOf(name_)), bytes_);
}

TEST_F(AssetStoreTest, AnUploadIsNotResumedForAnotherAsset) {
  { ASSERT_TRUE(Begin()->Append(ChunkOf(bytes_, 0, 10)).ok()); }
  EXPECT_EQ(ReasonOf(store_->Begin(kUploadId, SpecOf("other")).status()), "UPLOAD_MISMATCH");
}

TEST_F(AssetStoreTest, AMeshThatCannotBeSimulatedIsRefusedWithItsFaults) {
  TetMesh flat = OneTet();
  flat.rest_positions[3] = {0.3, 0.3, 0};
  flat.tets.push_back({0, 1, 2, 9});
  bytes_ = *SerializeMesh(flat);
  auto upload = Begin();
  ASSERT_TRUE(upload->Append(ChunkOf(bytes_, 0, 4096)).ok());
  const absl::Status status = upload->Finish().status();
  EXPECT_EQ(ReasonOf(status), "MESH_INVALID");
  google::rpc::BadRequest faults;
  faults.ParseFromString(
      std::string(*status.GetPayload(std::string(kTypeUrlPrefix) + "google.rpc.BadRequest")));
  EXPECT_GE(faults.field_violations_size(), 1);
  EXPECT_THAT(faults.field_violations(0).field(), testing::StartsWith("mesh."));
}

TEST_F(AssetStoreTest, AMeshOfMoreTetsThanTheServerTakesIsRefused) {
  TetMesh many = OneTet();
  many.tets.resize(11, many.tets[0]);
  bytes_ = *SerializeMesh(many);
  auto upload = Begin();
  ASSERT_TRUE(upload->Append(ChunkOf(bytes_, 0, 4096)).ok());
  EXPECT_EQ(ReasonOf(upload->Finish().status()), "TET_QUOTA");
}

TEST_F(AssetStoreTest, BytesThatAreNoMeshAreRefused) {
  bytes_ = "this is not a protobuf message";
  auto upload = Begin();
  ASSERT_TRUE(upload->Append(ChunkOf(bytes_, 0, 4096)).ok());
  EXPECT_EQ(ReasonOf(upload->Finish().status()), "MESH_INVALID");
}

TEST_F(AssetStoreTest, ARenderMeshIsAnAssetAndABadOneIsRefusedWithItsFaults) {
  const auto upload = [&](const std::string& bytes) {
    v1::AssetSpec spec = SpecOf(bytes);
    spec.set_kind(v1::ASSET_KIND_RENDER_MESH);
    auto begun = store_->Begin(kUploadId, spec);
    EXPECT_TRUE(begun.ok()) << begun.status();
    EXPECT_TRUE((*begun)->Append(ChunkOf(bytes, 0, 4096)).ok());
    return (*begun)->Finish().status();
  };
  RenderMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const std::string good = *SerializeRenderMesh(mesh);
  EXPECT_TRUE(upload(good).ok());
  const auto loaded = store_->LoadRenderMesh(absl::BytesToHexString(Sha256::Of(good)));
  ASSERT_TRUE(loaded.ok()) << loaded.status();
  EXPECT_EQ(loaded->points, mesh.points);

  mesh.triangles.push_back({0, 1, 3});
  const absl::Status bad = upload(*SerializeRenderMesh(mesh));
  EXPECT_EQ(ReasonOf(bad), "MESH_INVALID");
  EXPECT_THAT(std::string(bad.message()),
              testing::HasSubstr("render_mesh.triangles[1]: point 3 is outside [0, 3)"));
  EXPECT_EQ(ReasonOf(upload("not a message")), "MESH_INVALID");
  // A mesh of tets has no triangles.
  EXPECT_EQ(ReasonOf(upload(bytes_)), "MESH_INVALID");
}

TEST_F(AssetStoreTest, EveryFaultOfASpecIsNamed) {
  v1::AssetSpec spec;
  spec.mutable_digest()->set_sha256("short");
  spec.mutable_digest()->set_size_bytes(int64_t{1} << 60);
  const absl::Status status = store_->Begin(kUploadId, spec).status();
  EXPECT_TRUE(absl::IsInvalidArgument(status));
  for (const char* field : {"spec.kind", "spec.digest.sha256", "spec.digest.size_bytes"}) {
    EXPECT_THAT(std::string(status.message()), testing::HasSubstr(field));
  }
}

TEST_F(AssetStoreTest, NamesThatReachOutOfTheStoreAreRefused) {
  for (const char* id : {"short", "../../../etc/passwd", "upload/0001", "upload.0001", ""}) {
    EXPECT_TRUE(absl::IsInvalidArgument(store_->Begin(id, SpecOf(bytes_)).status())) << id;
    EXPECT_TRUE(absl::IsInvalidArgument(store_->Query(id).status())) << id;
  }
  for (const char* name : {"", "..", "../uploads/x", "ABCDEF"}) {
    EXPECT_FALSE(store_->Has(name));
    EXPECT_TRUE(absl::IsInvalidArgument(store_->OpenAsset(name).status())) << name;
  }
  EXPECT_EQ(ReasonOf(store_->OpenAsset(std::string(64, 'a')).status()), "ASSET_MISSING");
}

class CompressedUploadTest : public AssetStoreTest {
 protected:
  v1::UploadAssetRequest Compressed(const std::string& raw) {
    std::string coded(ZSTD_compressBound(raw.size()), '\0');
    coded.resize(ZSTD_compress(coded.data(), coded.size(), raw.data(), raw.size(), 3));
    v1::UploadAssetRequest chunk = ChunkOf(raw, 0, raw.size());
    chunk.set_payload(coded);
    return chunk;
  }
  std::unique_ptr<AssetStore::Upload> BeginCompressed() {
    v1::AssetSpec spec = SpecOf(bytes_);
    spec.set_compression(v1::COMPRESSION_ZSTD);
    return *store_->Begin(kUploadId, spec);
  }
};

TEST_F(CompressedUploadTest, ACompressedChunkIsUnpacked) {
  auto upload = BeginCompressed();
  ASSERT_TRUE(upload->Append(Compressed(bytes_)).ok());
  EXPECT_TRUE(upload->Finish().ok());
}

TEST_F(CompressedUploadTest, AChunkThatUnpacksToMoreThanItDeclaresIsRefused) {
  v1::UploadAssetRequest bomb = Compressed(std::string(100 << 20, '\0'));
  EXPECT_LT(bomb.payload().size(), 20'000u);
  bomb.set_raw_size(static_cast<uint32_t>(bytes_.size()));
  EXPECT_EQ(ReasonOf(BeginCompressed()->Append(bomb)), "CHUNK_CORRUPT");
}

TEST_F(CompressedUploadTest, AChunkThatIsNotOneWholeFrameIsRefused) {
  const v1::UploadAssetRequest good = Compressed(bytes_);
  for (size_t size = 0; size < good.payload().size(); ++size) {
    v1::UploadAssetRequest torn = good;
    torn.set_payload(good.payload().substr(0, size));
    EXPECT_EQ(ReasonOf(BeginCompressed()->Append(torn)), "CHUNK_CORRUPT") << size;
  }
  v1::UploadAssetRequest twice = good;
  twice.set_payload(good.payload() + good.payload());
  EXPECT_EQ(ReasonOf(BeginCompressed()->Append(twice)), "CHUNK_CORRUPT");
}

}  // namespace
}  // namespace cleave
