#include "server/gateway/rpc/impurity_service.h"

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "core/impurity/drawing.h"
#include "proto/convert/impurity_layer.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using ::testing::HasSubstr;

// A cross, 3 pixels wide.
v1::TraceDrawingRequest Cross() {
  v1::TraceDrawingRequest request;
  request.set_width(31);
  request.set_height(21);
  for (int y = 0; y < 21; ++y) {
    for (int x = 0; x < 31; ++x)
      request.mutable_pixels()->push_back(x / 3 == 5 || y / 3 == 3 ? '\x10' : '\xf0');
  }
  return request;
}

class ImpurityServiceTest : public ::testing::Test {
 protected:
  ImpurityServiceTest() {
    const std::string address = "unix:" + (directory_ / "socket");
    grpc::ServerBuilder builder;
    builder.AddListeningPort(address, grpc::InsecureServerCredentials());
    builder.RegisterService(&service_);
    server_ = builder.BuildAndStart();
    stub_ = v1::ImpurityService::NewStub(
        grpc::CreateChannel(address, grpc::InsecureChannelCredentials()));
  }
  ~ImpurityServiceTest() override { server_->Shutdown(); }

  grpc::Status Trace(const v1::TraceDrawingRequest& request, v1::TraceDrawingResponse& response) {
    grpc::ClientContext context;
    return stub_->TraceDrawing(&context, request, &response);
  }

  const TemporaryDirectory directory_;
  Executor executor_{1};
  const std::unique_ptr<AssetStore> assets_ =
      *AssetStore::Open(directory_.path(), AssetLimits{1 << 20, 4096, 10});
  ImpurityService service_{executor_, *assets_, 1 << 20};
  std::unique_ptr<grpc::Server> server_;
  std::unique_ptr<v1::ImpurityService::Stub> stub_;
};

TEST_F(ImpurityServiceTest, TracesAPictureAsTheCommandLineDoesItsFile) {
  for (const bool keep_width : {false, true}) {
    v1::TraceDrawingRequest request = Cross();
    request.mutable_image()->set_keep_width(keep_width);
    v1::TraceDrawingResponse response;
    const grpc::Status status = Trace(request, response);
    ASSERT_TRUE(status.ok()) << status.error_message();
    GreyRaster raster{31, 21, {}};
    for (const char pixel : request.pixels())
      raster.values.push_back(static_cast<float>(static_cast<uint8_t>(pixel)) / 255);
    const auto curves = TraceDrawing(raster, ImageFromMessage(request.image()));
    ASSERT_TRUE(curves.ok()) << curves.status();
    v1::TraceDrawingResponse expected;
    WriteCurves(*curves, *expected.mutable_curves());
    EXPECT_GE(response.curves_size(), 2);
    EXPECT_EQ(response.SerializeAsString(), expected.SerializeAsString());
  }
}

TEST_F(ImpurityServiceTest, NamesWhatIsWrongWithAPicture) {
  const auto fault = [&](const auto& spoil) {
    v1::TraceDrawingRequest request = Cross();
    spoil(request);
    v1::TraceDrawingResponse response;
    const grpc::Status status = Trace(request, response);
    EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
    return status.error_message();
  };
  EXPECT_THAT(fault([](auto& r) { r.set_width(30); }), HasSubstr("pixels: has 651 bytes"));
  EXPECT_THAT(fault([](auto& r) { r.set_height(-1); }), HasSubstr("height: -1"));
  EXPECT_THAT(fault([](auto& r) { r.Clear(); }), HasSubstr("width: 0"));
  EXPECT_THAT(fault([](auto& r) { r.mutable_image()->set_threshold(0); }),
              HasSubstr("image.threshold: 0 is outside (0, 1)"));
  EXPECT_THAT(fault([](auto& r) { r.mutable_image()->set_tolerance(101); }),
              HasSubstr("image.tolerance: 101"));
  EXPECT_THAT(fault([](auto& r) { r.mutable_image()->set_file("star.png"); }),
              HasSubstr("image.file"));
  EXPECT_THAT(fault([](auto& r) { r.mutable_image()->set_threshold(0.01); }),
              HasSubstr("pixels: no pixel is darker"));
}

}  // namespace
}  // namespace cleave
