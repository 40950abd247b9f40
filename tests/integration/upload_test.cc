// What clients are told whose uploads lie, or are cut.

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "client/cpp/client.h"
#include "client/cpp/mesh_transfer.h"
#include "client/cpp/rpc_error.h"
#include "client/cpp/stubs.h"
#include "core/base/crc32c.h"
#include "core/base/sha256.h"
#include "proto/convert/mesh.h"
#include "tests/integration/test_server.h"

namespace cleave {
namespace {

class UploadTest : public testing::Test {
 protected:
  void SetUp() override {
    client_ = server_.Connect();
    ASSERT_NE(client_, nullptr);
    bytes_ = *SerializeMesh(mesh_);
  }

  v1::UploadAssetRequest Chunk(size_t offset, size_t size, bool finish) const {
    v1::UploadAssetRequest chunk;
    chunk.set_upload_id("upload-0001");
    chunk.mutable_spec()->set_kind(v1::ASSET_KIND_TET_MESH);
    chunk.mutable_spec()->mutable_digest()->set_sha256(Sha256::Of(bytes_));
    chunk.mutable_spec()->mutable_digest()->set_size_bytes(static_cast<int64_t>(bytes_.size()));
    chunk.set_offset(static_cast<int64_t>(offset));
    chunk.set_payload(bytes_.substr(offset, size));
    chunk.set_raw_size(static_cast<uint32_t>(chunk.payload().size()));
    chunk.set_crc32c(Crc32c(chunk.payload()));
    chunk.set_finish(finish);
    return chunk;
  }

  // Sends messages as bytes, so that they may be anything.
  absl::Status SendRaw(const std::vector<std::string>& messages) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(30));
    grpc::CompletionQueue queue;
    grpc::GenericStub stub(
        grpc::CreateChannel(server_.address(), grpc::InsecureChannelCredentials()));
    const auto call = stub.PrepareCall(&context, "/cleave.v1.AssetService/UploadAsset", &queue);
    void* tag = nullptr;
    bool ok = false;
    call->StartCall(nullptr);
    queue.Next(&tag, &ok);
    for (const std::string& message : messages) {
      const grpc::Slice slice(message);
      call->Write(grpc::ByteBuffer(&slice, 1), nullptr);
      queue.Next(&tag, &ok);
    }
    call->WritesDone(nullptr);
    queue.Next(&tag, &ok);
    grpc::ByteBuffer response;
    call->Read(&response, nullptr);
    queue.Next(&tag, &ok);
    grpc::Status status;
    call->Finish(&status, nullptr);
    queue.Next(&tag, &ok);
    queue.Shutdown();
    while (queue.Next(&tag, &ok)) {
    }
    return StatusFromRpc(status, "uploading");
  }

  int64_t CommittedSize() {
    grpc::ClientContext context;
    v1::QueryUploadStatusRequest request;
    request.set_upload_id("upload-0001");
    v1::UploadStatus status;
    const grpc::Status answer =
        client_->stubs().assets->QueryUploadStatus(&context, request, &status);
    EXPECT_TRUE(answer.ok()) << answer.error_message();
    return status.committed_size();
  }

  TestServer server_;
  std::unique_ptr<Client> client_;
  const TetMesh mesh_{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}, {}, {}};
  std::string bytes_;
};

TEST_F(UploadTest, AStreamThatEndsWithoutFinishIsNoUploadAndCanBeResumed) {
  const absl::Status cut = SendRaw({Chunk(0, 20, false).SerializeAsString()});
  EXPECT_TRUE(absl::IsDataLoss(cut)) << cut;
  EXPECT_EQ(ReasonOf(cut), "UPLOAD_CUT");
  EXPECT_EQ(CommittedSize(), 20);
  server_.Kill();
  server_.Start();
  client_ = server_.Connect();
  EXPECT_EQ(CommittedSize(), 20);
  EXPECT_TRUE(SendRaw({Chunk(20, 10'000, true).SerializeAsString()}).ok());
  EXPECT_EQ(DownloadMesh(*client_, ToHex(Sha256::Of(bytes_)), {})->tets, mesh_.tets);
}

TEST_F(UploadTest, AMessageThatDoesNotParseBetweenGoodOnesIsNotTakenForTheEnd) {
  const absl::Status status =
      SendRaw({Chunk(0, 20, false).SerializeAsString(), "\xff\xff\xff not a message",
               Chunk(20, 10'000, true).SerializeAsString()});
  EXPECT_FALSE(status.ok());
  EXPECT_EQ(ReasonOf(status), "UPLOAD_CUT") << status;
  EXPECT_EQ(CommittedSize(), 20);
}

TEST_F(UploadTest, AnEmptyStreamAndAFirstMessageWithoutSpecAreRefused) {
  EXPECT_EQ(ReasonOf(SendRaw({})), "UPLOAD_CUT");
  v1::UploadAssetRequest chunk = Chunk(0, 10'000, true);
  chunk.clear_spec();
  EXPECT_TRUE(absl::IsInvalidArgument(SendRaw({chunk.SerializeAsString()})));
}

TEST_F(UploadTest, ACorruptChunkIsTold) {
  v1::UploadAssetRequest chunk = Chunk(0, 10'000, true);
  chunk.set_crc32c(1);
  EXPECT_EQ(ReasonOf(SendRaw({chunk.SerializeAsString()})), "CHUNK_CORRUPT");
}

TEST_F(UploadTest, AMeshThatTheServerHasIsNotSentAgain) {
  const absl::StatusOr<UploadedMesh> first = UploadMesh(*client_, mesh_, {});
  ASSERT_TRUE(first.ok()) << first.status();
  EXPECT_GT(first->bytes_sent, 0);
  const absl::StatusOr<UploadedMesh> second = UploadMesh(*client_, mesh_, {});
  ASSERT_TRUE(second.ok()) << second.status();
  EXPECT_EQ(second->bytes_sent, 0);
  EXPECT_EQ(second->asset, first->asset);
}

TEST_F(UploadTest, AMessageBeyondTheLimitIsRefused) {
  v1::UploadAssetRequest chunk = Chunk(0, 10'000, true);
  chunk.set_payload(std::string(5 << 20, 'x'));
  EXPECT_FALSE(SendRaw({chunk.SerializeAsString()}).ok());
  EXPECT_TRUE(client_->ListSessions().ok());
}

}  // namespace
}  // namespace cleave
