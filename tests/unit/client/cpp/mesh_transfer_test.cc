#include "client/cpp/mesh_transfer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <cmath>
#include <map>

#include "cleave/v1/asset.grpc.pb.h"
#include "core/base/crc32c.h"
#include "core/base/sha256.h"
#include "proto/convert/mesh.h"
#include "tests/unit/client/cpp/fake_server.h"

namespace cleave {
namespace {

// Keeps assets in memory, checks chunks as a server must, and cuts streams where told.
class FakeAssets : public v1::AssetService::Service {
 public:
  grpc::Status FindMissingAssets(grpc::ServerContext*, const v1::FindMissingAssetsRequest* request,
                                 v1::FindMissingAssetsResponse* response) override {
    for (const v1::Digest& digest : request->digests())
      if (assets.count(ToHex(digest.sha256())) == 0) *response->add_missing() = digest;
    return grpc::Status::OK;
  }
  grpc::Status QueryUploadStatus(grpc::ServerContext*, const v1::QueryUploadStatusRequest* request,
                                 v1::UploadStatus* status) override {
    const auto found = uploads.find(request->upload_id());
    if (found == uploads.end()) return grpc::Status(grpc::StatusCode::NOT_FOUND, "");
    status->set_committed_size(static_cast<int64_t>(found->second.size()));
    return grpc::Status::OK;
  }
  grpc::Status UploadAsset(grpc::ServerContext*, grpc::ServerReader<v1::UploadAssetRequest>* reader,
                           v1::UploadAssetResponse* response) override {
    ++streams;
    if (refuse_first_id && streams == 1)
      return grpc::Status(grpc::StatusCode::ABORTED, "another client sends this");
    v1::UploadAssetRequest chunk;
    std::string digest;
    while (reader->Read(&chunk)) {
      if (chunk.has_spec()) {
        digest = ToHex(chunk.spec().digest().sha256());
        kind = chunk.spec().kind();
      }
      std::string& held = uploads[chunk.upload_id()];
      std::string raw(chunk.raw_size(), '\0');
      EXPECT_EQ(
          ZSTD_decompress(raw.data(), raw.size(), chunk.payload().data(), chunk.payload().size()),
          raw.size());
      EXPECT_EQ(chunk.crc32c(), Crc32c(raw));
      EXPECT_EQ(chunk.offset(), static_cast<int64_t>(held.size()));
      held += raw;
      bytes_received += static_cast<int64_t>(raw.size());
      if (--chunks_until_cut == 0) return grpc::Status(grpc::StatusCode::UNAVAILABLE, "cut");
      if (chunk.finish()) {
        EXPECT_EQ(ToHex(Sha256::Of(held)), digest);
        assets[digest] = held;
        response->mutable_status()->set_complete(true);
        response->set_asset(digest);
        response->add_warnings("tets[3]: is a sliver");
      }
    }
    return grpc::Status::OK;
  }
  grpc::Status DownloadAsset(grpc::ServerContext*, const v1::DownloadAssetRequest* request,
                             grpc::ServerWriter<v1::DownloadAssetResponse>* writer) override {
    const auto found = assets.find(request->asset());
    if (found == assets.end()) return grpc::Status(grpc::StatusCode::NOT_FOUND, "no such asset");
    const std::string& bytes = found->second;
    for (size_t at = static_cast<size_t>(request->offset()); at < bytes.size(); at += 100'000) {
      v1::DownloadAssetResponse chunk;
      chunk.set_offset(static_cast<int64_t>(at));
      chunk.set_payload(bytes.substr(at, 100'000));
      chunk.set_crc32c(Crc32c(chunk.payload()));
      chunk.set_size_bytes(static_cast<int64_t>(bytes.size()));
      chunk.set_last(at + 100'000 >= bytes.size());
      if (damage && at == 0) {
        damage = false;
        (*chunk.mutable_payload())[5] ^= 1;
      }
      writer->Write(chunk);
      if (--chunks_until_cut == 0) return grpc::Status(grpc::StatusCode::UNAVAILABLE, "cut");
    }
    return grpc::Status::OK;
  }

  std::map<std::string, std::string> assets, uploads;
  v1::AssetKind kind = v1::ASSET_KIND_UNSPECIFIED;  // of the last upload
  int chunks_until_cut = 0;                         // 0: never
  bool refuse_first_id = false;
  bool damage = false;
  int streams = 0;
  int64_t bytes_received = 0;
};

// Large enough for several chunks, and hard to compress.
TetMesh LargeMesh() {
  TetMesh mesh;
  for (int i = 0; i < 60'000; ++i)
    mesh.rest_positions.push_back({std::sin(i), std::cos(7 * i), 1. * i});
  for (int i = 0; i + 3 < 60'000; i += 4) mesh.tets.push_back({i, i + 1, i + 2, i + 3});
  return mesh;
}

TEST(UploadMesh, WholeMeshArrivesAndComesBack) {
  FakeAssets service;
  FakeServer server(service);
  const TetMesh mesh = LargeMesh();
  const auto uploaded = UploadMesh(server.client(), mesh, nullptr);
  ASSERT_TRUE(uploaded.ok()) << uploaded.status();
  EXPECT_EQ(service.assets[uploaded->asset], SerializeMesh(mesh).value());
  EXPECT_THAT(uploaded->warnings, testing::ElementsAre("tets[3]: is a sliver"));
  const auto back = DownloadMesh(server.client(), uploaded->asset, nullptr);
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->rest_positions, mesh.rest_positions);
  EXPECT_EQ(back->tets, mesh.tets);
}

TEST(UploadMesh, WhatTheServerHasIsNotSent) {
  FakeAssets service;
  FakeServer server(service);
  ASSERT_TRUE(UploadMesh(server.client(), LargeMesh(), nullptr).ok());
  const int64_t before = service.bytes_received;
  const auto again = UploadMesh(server.client(), LargeMesh(), nullptr);
  ASSERT_TRUE(again.ok()) << again.status();
  EXPECT_EQ(again->bytes_sent, 0);
  EXPECT_EQ(service.bytes_received, before);
}

TEST(UploadMesh, CutUploadGoesOnWhereItsDurableBytesEnd) {
  FakeAssets service;
  service.chunks_until_cut = 3;
  FakeServer server(service);
  const auto uploaded = UploadMesh(server.client(), LargeMesh(), nullptr);
  ASSERT_TRUE(uploaded.ok()) << uploaded.status();
  EXPECT_EQ(service.streams, 2);
  EXPECT_EQ(service.bytes_received, static_cast<int64_t>(service.assets[uploaded->asset].size()));
}

TEST(UploadMesh, RivalUploadOfTheSameMeshIsSteppedAside) {
  FakeAssets service;
  service.refuse_first_id = true;
  FakeServer server(service);
  const auto uploaded = UploadMesh(server.client(), LargeMesh(), nullptr);
  ASSERT_TRUE(uploaded.ok()) << uploaded.status();
  EXPECT_EQ(service.assets.count(uploaded->asset), 1u);
}

TEST(UploadRenderMesh, ArrivesUnderItsKindAndComesBack) {
  FakeAssets service;
  FakeServer server(service);
  RenderMesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.uvs = {{{{0, 0}, {1, 0}, {0, 1}}}};
  const auto uploaded = UploadRenderMesh(server.client(), mesh, nullptr);
  ASSERT_TRUE(uploaded.ok()) << uploaded.status();
  EXPECT_EQ(service.kind, v1::ASSET_KIND_RENDER_MESH);
  const auto back = DownloadRenderMesh(server.client(), uploaded->asset, nullptr);
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(back->points, mesh.points);
  EXPECT_EQ(back->uvs, mesh.uvs);
}

TEST(DownloadMesh, CutAndDamagedDownloadsAreMadeWhole) {
  FakeAssets service;
  FakeServer server(service);
  const auto uploaded = UploadMesh(server.client(), LargeMesh(), nullptr);
  ASSERT_TRUE(uploaded.ok()) << uploaded.status();
  service.chunks_until_cut = 4;
  service.damage = true;
  const auto mesh = DownloadMesh(server.client(), uploaded->asset, nullptr);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->tets, LargeMesh().tets);
}

TEST(DownloadMesh, WrongContentAndUnknownNameAreRefused) {
  FakeAssets service;
  FakeServer server(service);
  const std::string name(64, 'a');
  EXPECT_TRUE(absl::IsNotFound(DownloadMesh(server.client(), name, nullptr).status()));
  service.assets[name] = SerializeMesh(LargeMesh()).value();
  EXPECT_TRUE(absl::IsDataLoss(DownloadMesh(server.client(), name, nullptr).status()));
}

}  // namespace
}  // namespace cleave
