#include "server/gateway/rpc/impurity_service.h"

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/impurity/drawing.h"
#include "core/mesh/mesh_check.h"
#include "core/mesh/procedural.h"
#include "core/model/impurity_preview.h"
#include "core/picture/camera.h"
#include "core/picture/image.h"
#include "core/picture/impurity_picture.h"
#include "proto/convert/impurity_layer.h"
#include "proto/convert/scene.h"
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

// A bar that stands on its end, as gravity has it; impure from 0.4 m to 0.6 m, and cut in part.
v1::PreviewImpurityRequest StandingBar() {
  v1::PreviewImpurityRequest request;
  v1::Scene& scene = *request.mutable_scene();
  scene.set_name("bar");
  for (const double gravity : {-9.81, 0.0, 0.0}) scene.add_gravity(gravity);
  v1::BoxMesh& box = *scene.mutable_mesh()->mutable_box();
  for (const double size : {1.0, 0.3, 0.2}) box.add_size(size);
  box.mutable_resolution()->set_layout(v1::MESH_LAYOUT_JITTERED_LATTICE);
  box.mutable_resolution()->set_cell_size(0.1);
  v1::Material& material = *scene.add_materials();
  material.set_youngs_modulus(1e6);
  material.set_density(1000);
  material.set_tensile_strength(2000);
  v1::ImpurityLayer& bands = *scene.mutable_impurities()->add_layers();
  bands.set_potency(4);
  for (const double axis : {1.0, 0.0, 0.0}) bands.mutable_bands()->add_axis(axis);
  bands.mutable_bands()->set_position(0.5);
  bands.mutable_bands()->set_width(0.2);
  v1::ImpurityLayer& stroke = *scene.mutable_impurities()->add_layers();
  stroke.set_weakening(0.5);
  v1::Polyline& line = *stroke.mutable_strokes()->add_curves();
  for (const double point : {0.83, -1.0, 0.0, 0.83, 1.0, 0.0}) line.add_points(point);
  return request;
}

// The bytes of the picture that is drawn here of such a request.
std::string DrawnHere(const v1::PreviewImpurityRequest& request, ImpurityPictureOptions options) {
  Faults faults;
  const Scene scene = SceneFromMessage(request.scene(), faults);
  TetMesh mesh = *BuildMesh(std::get<BoxMesh>(scene.mesh.source));
  CheckAndOrientMesh(mesh);
  const auto preview = PreviewImpurities(scene, mesh);
  options.title = "bar";
  options.camera.up = UpAgainst(scene.gravity);
  return *EncodePng(*RenderImpurities(
      mesh, ImpurityShares(preview->potencies, preview->edges, preview->weakenings), options));
}

struct DecodedPicture {
  uint32_t width = 0, height = 0;
  int magenta = 0, yellow = 0;  // pixels that lean to it
};
DecodedPicture Decode(const std::string& png) {
  DecodedPicture picture;
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  EXPECT_NE(png_image_begin_read_from_memory(&header, png.data(), png.size()), 0);
  header.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> rgb(PNG_IMAGE_SIZE(header));
  EXPECT_NE(png_image_finish_read(&header, nullptr, rgb.data(), 0, nullptr), 0);
  picture.width = header.width;
  picture.height = header.height;
  for (size_t at = 0; at + 2 < rgb.size(); at += 3) {
    picture.magenta += rgb[at] > rgb[at + 1] + 60 && rgb[at + 2] > rgb[at + 1] + 40;
    picture.yellow += rgb[at] > rgb[at + 2] + 60 && rgb[at + 1] > rgb[at + 2] + 60;
  }
  return picture;
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

  grpc::Status Preview(const v1::PreviewImpurityRequest& request,
                       v1::PreviewImpurityResponse& response) {
    grpc::ClientContext context;
    return stub_->PreviewImpurity(&context, request, &response);
  }

  const TemporaryDirectory directory_;
  Executor executor_{1};
  const std::unique_ptr<AssetStore> assets_ =
      *AssetStore::Open(directory_.path(), AssetLimits{1 << 20, 4096, 1000});
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

TEST_F(ImpurityServiceTest, DrawsThePictureThatIsAskedForAsItIsDrawnWithoutAServer) {
  v1::PreviewImpurityRequest request = StandingBar();
  v1::PreviewImpurityResponse plain, drawn;
  ASSERT_TRUE(Preview(request, plain).ok());
  EXPECT_TRUE(plain.picture_png().empty());
  request.mutable_picture()->set_width(120);
  ASSERT_TRUE(Preview(request, drawn).ok());
  const std::string png = drawn.picture_png();
  EXPECT_THAT(png, testing::StartsWith("\x89PNG\r\n\x1a\n"));
  ImpurityPictureOptions options;
  options.width = 120;
  // No EXPECT_EQ, which would print them.
  EXPECT_TRUE(png == DrawnHere(request, options));
  const DecodedPicture picture = Decode(png);
  EXPECT_EQ(picture.width, 120u);
  EXPECT_EQ(picture.height, 160u);  // as tall as pictures get: the bar stands
  EXPECT_GT(picture.magenta, 200);
  EXPECT_GT(picture.yellow, 3 * picture.magenta / 2);
  drawn.clear_picture_png();
  EXPECT_EQ(drawn.SerializeAsString(), plain.SerializeAsString());

  request.mutable_picture()->set_azimuth(-50);
  request.mutable_picture()->set_elevation(60);
  ASSERT_TRUE(Preview(request, drawn).ok());
  options.camera.azimuth = -50;
  options.camera.elevation = 60;
  EXPECT_TRUE(drawn.picture_png() == DrawnHere(request, options));
  EXPECT_FALSE(drawn.picture_png() == png);
}

TEST_F(ImpurityServiceTest, CountsThePictureAgainstTheLargestAnswer) {
  v1::PreviewImpurityRequest request = StandingBar();
  request.mutable_picture()->set_width(60);
  v1::PreviewImpurityResponse response;
  ASSERT_TRUE(Preview(request, response).ok());
  const size_t bytes = response.ByteSizeLong();
  for (const size_t most : {bytes, bytes - 1}) {
    ImpurityService service(executor_, *assets_, most);
    const std::string address = "unix:" + (directory_ / "narrow");
    grpc::ServerBuilder builder;
    builder.AddListeningPort(address, grpc::InsecureServerCredentials());
    builder.RegisterService(&service);
    const std::unique_ptr<grpc::Server> server = builder.BuildAndStart();
    grpc::ClientContext context;
    const grpc::Status status =
        v1::ImpurityService::NewStub(
            grpc::CreateChannel(address, grpc::InsecureChannelCredentials()))
            ->PreviewImpurity(&context, request, &response);
    server->Shutdown();
    if (most == bytes) {
      EXPECT_TRUE(status.ok()) << status.error_message();
    } else {
      EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
      EXPECT_THAT(status.error_message(), HasSubstr("leave the picture out"));
    }
  }
}

TEST_F(ImpurityServiceTest, NamesBadOptionsOfAPictureWithWhatElseIsWrong) {
  v1::PreviewImpurityRequest request = StandingBar();
  request.mutable_scene()->mutable_materials(0)->set_density(-1);
  request.mutable_picture()->set_width(1921);
  request.mutable_picture()->set_azimuth(std::numeric_limits<double>::infinity());
  request.mutable_picture()->set_elevation(89);
  v1::PreviewImpurityResponse response;
  const grpc::Status status = Preview(request, response);
  EXPECT_EQ(status.error_code(), grpc::StatusCode::INVALID_ARGUMENT);
  for (const char* fault :
       {"picture.width: 1921 is outside [16, 1920] pixels",
        "picture.azimuth: inf is not a finite number",
        "picture.elevation: 89 is outside (-89, 89) degrees", "scene.materials[0].density: -1"}) {
    EXPECT_THAT(status.error_message(), HasSubstr(fault));
  }
  for (const int width : {0, 15, -5, std::numeric_limits<int>::max()}) {
    request = StandingBar();
    request.mutable_picture()->set_width(width);
    EXPECT_THAT(Preview(request, response).error_message(),
                HasSubstr("picture.width: " + std::to_string(width)));
  }
  EXPECT_EQ(response.ByteSizeLong(), 0u);
}

TEST_F(ImpurityServiceTest, DrawsNothingForAClientThatIsGone) {
  v1::PreviewImpurityRequest request = StandingBar();
  request.mutable_picture();
  grpc::ClientContext context;
  context.TryCancel();
  v1::PreviewImpurityResponse response;
  EXPECT_EQ(stub_->PreviewImpurity(&context, request, &response).error_code(),
            grpc::StatusCode::CANCELLED);
  EXPECT_TRUE(Preview(StandingBar(), response).ok());  // and goes on with the next
}

}  // namespace
}  // namespace cleave
