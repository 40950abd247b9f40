#include "client/io/impurity/layer_files.h"

#include <gmock/gmock.h>
#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "client/io/export/vtu.h"
#include "client/io/impurity/picture_file.h"
#include "client/io/impurity/ply_points.h"
#include "client/io/mesh/vtu.h"
#include "core/picture/image.h"
#include "tests/unit/client/io/impurity/jpeg_picture.h"
#include "tests/unit/temporary_directory.h"

namespace cleave {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

// A black line across a white picture of 40 x 20 pixels, from (10, 8) to (29, 11).
Image Bar() {
  Image image(40, 20);
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 40; ++x) {
      const bool ink = x >= 10 && x < 30 && y >= 8 && y < 12;
      for (int k = 0; k < 3; ++k) image.at(x, y)[k] = ink ? 10 : 250;
    }
  }
  return image;
}

TEST(ParsePicture, ReadsPngAndJpegAlike) {
  for (const std::string& bytes : {*EncodePng(Bar()), Jpeg(Bar())}) {
    const auto raster = ParsePicture(bytes);
    ASSERT_TRUE(raster.ok()) << raster.status();
    ASSERT_EQ(raster->width, 40);
    ASSERT_EQ(raster->height, 20);
    for (int y = 0; y < 20; ++y) {
      for (int x = 0; x < 40; ++x) {
        const bool ink = x >= 10 && x < 30 && y >= 8 && y < 12;
        EXPECT_EQ(raster->at(x, y) < 0.5, ink) << x << " " << y;
      }
    }
  }
}

TEST(ParsePicture, RefusesWhatIsDamaged) {
  const std::string png = *EncodePng(Bar()), jpeg = Jpeg(Bar());
  EXPECT_THAT(ParsePicture("GIF89a").status().message(), HasSubstr("neither a PNG nor a JPEG"));
  EXPECT_THAT(ParsePicture("").status().message(), HasSubstr("neither"));
  // The last chunk of a PNG, 12 bytes, says only that it is over.
  for (size_t size = 8; size + 12 < png.size(); size += 7)
    EXPECT_FALSE(ParsePicture(absl::string_view(png).substr(0, size)).ok()) << size;
  for (size_t size = 4; size + 2 < jpeg.size(); size += 13)
    EXPECT_FALSE(ParsePicture(absl::string_view(jpeg).substr(0, size)).ok()) << size;
}

TEST(ParseChannel, GivesOneChannelAsItStandsThere) {
  Image image(3, 2);
  for (int y = 0; y < 2; ++y) {
    for (int x = 0; x < 3; ++x) {
      image.at(x, y)[0] = static_cast<uint8_t>(10 * x);
      image.at(x, y)[1] = static_cast<uint8_t>(100 * y);
      image.at(x, y)[2] = 200;
    }
  }
  const std::string png = *EncodePng(image);
  const auto values = [&png](TextureChannel channel) {
    const auto picture = ParseChannel(png, channel);
    EXPECT_TRUE(picture.ok()) << picture.status();
    return picture->values;
  };
  EXPECT_THAT(values(TextureChannel::kRed), ElementsAre(0, 10, 20, 0, 10, 20));
  EXPECT_THAT(values(TextureChannel::kGreen), ElementsAre(0, 0, 0, 100, 100, 100));
  EXPECT_THAT(values(TextureChannel::kBlue), Each(200));
  EXPECT_THAT(values(TextureChannel::kLuminance), ElementsAre(14, 17, 19, 86, 88, 90));
  const std::string jpeg = Jpeg(Bar());
  for (const std::string& bytes : {png, jpeg}) {
    EXPECT_THAT(ParseChannel(bytes, TextureChannel::kAlpha).status().message(),
                HasSubstr("has no alpha channel"));
  }
  const auto red = ParseChannel(jpeg, TextureChannel::kRed);
  ASSERT_TRUE(red.ok()) << red.status();
  EXPECT_EQ(red->values.size(), 800u);
  EXPECT_LT(red->values[40 * 10 + 20], 30);
  EXPECT_GT(red->values[0], 230);
  EXPECT_FALSE(ParseChannel("GIF89a", TextureChannel::kRed).ok());
}

// A PNG of two pixels, 8-bit RGBA: (1, 2, 3, 0) and (9, 8, 7, 128).
constexpr unsigned char kSeeThrough[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00, 0x00, 0xf4,
    0x22, 0x7f, 0x8a, 0x00, 0x00, 0x00, 0x11, 0x49, 0x44, 0x41, 0x54, 0x78, 0x9c, 0x63, 0x60,
    0x64, 0x62, 0x66, 0xe0, 0xe4, 0x60, 0x6f, 0x00, 0x00, 0x00, 0xfb, 0x00, 0x9f, 0xa7, 0x38,
    0xb2, 0xce, 0x00, 0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

TEST(ParseChannel, LeavesColoursAloneWhereTheyAreTransparent) {
  const absl::string_view png(reinterpret_cast<const char*>(kSeeThrough), sizeof kSeeThrough);
  EXPECT_THAT(ParseChannel(png, TextureChannel::kAlpha)->values, ElementsAre(0, 128));
  EXPECT_THAT(ParseChannel(png, TextureChannel::kRed)->values, ElementsAre(1, 9));
}

TEST(Reduced, PicturesAreMeansOfWhatTheyWere) {
  const PictureBytes picture = {4, 3, {0, 10, 20, 30, 0, 10, 20, 30, 40, 60, 80, 100}};
  EXPECT_EQ(Reduced(picture, 4).values, picture.values);
  const PictureBytes small = Reduced(picture, 2);
  EXPECT_EQ(small.width, 2);
  EXPECT_EQ(small.height, 2);
  EXPECT_THAT(small.values, ElementsAre(5, 25, 28, 58));
  EXPECT_THAT(Reduced(picture, 1).values, ElementsAre(33));
}

constexpr char kPly[] =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty double z\nproperty uchar red\nproperty float wear\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0 255 0.25\n1 0 0 0 0.5\n1 1 0 51 0.75\n0 1 0.5 102 1\n4 0 1 2 3\n";

TEST(ParsePlyPoints, ReadsPropertiesAndFaces) {
  const auto worn = ParsePlyPoints(kPly, "");
  ASSERT_TRUE(worn.ok()) << worn.status();
  EXPECT_THAT(worn->values, ElementsAre(0.25, 0.5, 0.75, 1));
  EXPECT_EQ(worn->vertices[3], (Vec3{0, 1, 0.5}));
  EXPECT_THAT(worn->triangles,
              ElementsAre(std::array<int32_t, 3>{0, 1, 2}, std::array<int32_t, 3>{0, 2, 3}));
  EXPECT_THAT(ParsePlyPoints(kPly, "red")->values, ElementsAre(1, 0, 0.2, 0.4));
  EXPECT_THAT(ParsePlyPoints(kPly, "tear").status().message(),
              HasSubstr("no property \"tear\"; they have x, y, z, red, wear"));
}

TEST(ParsePlyPoints, ReadsBothByteOrders) {
  for (const bool big : {false, true}) {
    std::string bytes = "ply\nformat binary_";
    bytes += big ? "big" : "little";
    bytes +=
        "_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
        "property short wear\nend_header\n";
    const std::string one = {'\x00', '\x00', '\x80', '\x3f'};  // 1.0f
    const std::string word = {'\xfe', '\xff'};                 // -2
    for (int k = 0; k < 3; ++k) bytes += big ? std::string(one.rbegin(), one.rend()) : one;
    bytes += big ? std::string(word.rbegin(), word.rend()) : word;
    const auto points = ParsePlyPoints(bytes, "wear");
    ASSERT_TRUE(points.ok()) << points.status();
    EXPECT_EQ(points->vertices[0], (Vec3{1, 1, 1}));
    EXPECT_THAT(points->values, ElementsAre(-2));
    EXPECT_FALSE(ParsePlyPoints(absl::string_view(bytes).substr(0, bytes.size() - 1), "").ok());
  }
}

TEST(ParsePlyPoints, RefusesWhatIsNoPly) {
  const std::string text = kPly;
  EXPECT_FALSE(ParsePlyPoints("", "").ok());
  for (size_t size = 0; size + 8 < text.size(); size += 5)
    EXPECT_FALSE(ParsePlyPoints(absl::string_view(text).substr(0, size), "wear").ok()) << size;
  EXPECT_FALSE(
      ParsePlyPoints("ply\nformat ascii 1.0\nelement vertex 999999999\nend_header\n", "").ok());
  std::string outside = text;
  outside.replace(outside.rfind("3\n"), 1, "4");
  EXPECT_THAT(ParsePlyPoints(outside, "wear").status().message(), HasSubstr("names vertex 4 of 4"));
}

TEST(ParseVtuPointArray, ReadsOneArray) {
  VtuGrid grid;
  grid.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  grid.connectivity = {0, 1, 2, 3};
  grid.offsets = {4};
  grid.types = {kVtuTetrahedron};
  const std::vector<double> wear = {0, 0.25, 0.5, 1}, other = {1, 1, 1, 1};
  grid.point_data = {MakeVtuArray<double>("wear", wear), MakeVtuArray<double>("other", other)};
  const std::string bytes = *EncodeVtu(grid, "test");
  EXPECT_EQ(*ParseVtuPointArray(bytes, "wear"), wear);
  EXPECT_THAT(ParseVtuPointArray(bytes, "").status().message(), HasSubstr("wear, other"));
  EXPECT_THAT(ParseVtuPointArray(bytes, "tear").status().message(), HasSubstr("\"tear\""));
  EXPECT_FALSE(ParseVtuPointArray("<VTKFile/>", "wear").ok());
}

constexpr char kQuad[] =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 2 0\nvt 2 1\nvt 0 1\n"
    "f 1/1 2/2 3/3\nf 1/1 3/3 4/4\n";

class LayerFiles : public ::testing::Test {
 protected:
  LayerFiles() {
    Write("bar.png", *EncodePng(Bar()));
    Write("blank.png", *EncodePng(Image(8, 8)));
    Write("worn.ply", kPly);
    Write("quad.obj", kQuad);
    Write("bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
  }
  void Write(const char* name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  std::vector<Fault> Read(const std::string& layers) {
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(layers, &impurities_));
    return ReadLayerFiles(folder_.string(), impurities_);
  }

  const TemporaryDirectory directory_;
  const std::filesystem::path folder_ = directory_.path();
  v1::Impurities impurities_;
};

TEST_F(LayerFiles, PutTheirContentInTheirPlace) {
  const auto faults = Read(R"pb(
    layers {
      pattern {
        image { file: "bar.png" }
        scale: 2
      }
    }
    layers { node_values { file: "worn.ply" array: "wear" } }
    layers { paint { file: "worn.ply" array: "red" depth: 0.1 } }
    layers { noise {} })pb");
  EXPECT_TRUE(faults.empty()) << faults[0].description;
  const v1::SegmentPattern& pattern = impurities_.layers(0).pattern();
  EXPECT_FALSE(pattern.has_image());
  EXPECT_EQ(pattern.scale(), 2);
  ASSERT_EQ(pattern.curves_size(), 1);
  const auto& points = pattern.curves(0).points();
  // The bar lies along x through the middle of the picture.
  EXPECT_NEAR(points[1], 0, 0.03);
  EXPECT_GT(std::abs(points[0] - points[points.size() - 2]), 0.35);
  const v1::NodeValues& values = impurities_.layers(1).node_values();
  EXPECT_THAT(values.shares(), ElementsAre(0.25, 0.5, 0.75, 1));
  EXPECT_EQ(values.file() + values.array(), "");
  const v1::SurfacePaint& paint = impurities_.layers(2).paint();
  EXPECT_THAT(paint.shares(), ElementsAre(1, 0, 0.2, 0.4));
  EXPECT_EQ(paint.vertices_size(), 12);
  EXPECT_THAT(paint.triangles(), ElementsAre(0, 1, 2, 0, 2, 3));
}

TEST_F(LayerFiles, TexturesAreSentWithTheirCoordinates) {
  const auto faults = Read(R"pb(
    layers {
      paint {
        file: "quad.obj"
        depth: 0.1
        unit_scale: 0.01
        texture {
          file: "bar.png"
          wrap: TEXTURE_WRAP_CLAMP
          invert: true
          channel: TEXTURE_CHANNEL_GREEN
        }
      }
    })pb");
  ASSERT_TRUE(faults.empty()) << faults[0].description;
  const v1::SurfacePaint& paint = impurities_.layers(0).paint();
  EXPECT_EQ(paint.file(), "");
  EXPECT_EQ(paint.unit_scale(), 0.01);
  EXPECT_EQ(paint.vertices_size(), 12);
  EXPECT_EQ(paint.triangles_size(), 6);
  const v1::SurfaceTexture& texture = paint.texture();
  EXPECT_THAT(texture.uvs(), ElementsAre(0, 0, 2, 0, 2, 1, 0, 0, 2, 1, 0, 1));
  EXPECT_EQ(texture.file(), "");
  EXPECT_EQ(texture.channel(), v1::TEXTURE_CHANNEL_UNSPECIFIED);
  EXPECT_TRUE(texture.invert());
  EXPECT_EQ(texture.wrap(), v1::TEXTURE_WRAP_CLAMP);
  ASSERT_EQ(texture.values().size(), 800u);
  EXPECT_EQ(texture.width(), 40);
  EXPECT_EQ(static_cast<uint8_t>(texture.values()[40 * 10 + 20]), 10);
}

TEST_F(LayerFiles, NameTheFileOfATextureThatCannotBeUsed) {
  const auto faults = Read(R"pb(
    layers {
      paint {
        file: "bare.obj"
        texture { file: "bar.png" }
      }
    }
    layers {
      paint {
        file: "quad.obj"
        texture { file: "none.png" }
      }
    }
    layers {
      paint {
        file: "quad.obj"
        texture { file: "bar.png" channel: TEXTURE_CHANNEL_ALPHA }
      }
    }
    layers {
      paint {
        file: "quad.obj"
        texture { file: "worn.ply" }
      }
    }
    layers { paint { file: "quad.obj" } }
    layers {
      paint {
        file: "quad.obj"
        texture { width: 1 file: "bar.png" }
      }
    }
    layers {
      paint {
        file: "quad.obj"
        array: "red"
        texture { file: "bar.png" }
      }
    })pb");
  const std::vector<std::array<const char*, 2>> expected = {
      {"[0].paint.file", "bare.obj: has no texture coordinates"},
      {"[1].paint.texture.file", "none.png"},
      {"[2].paint.texture.file", "bar.png: has no alpha channel"},
      {"[3].paint.texture.file", "neither a PNG nor a JPEG"},
      {"[4].paint.file", "need a texture"},
      {"[5].paint.texture.file", "stands beside"},
      {"[6].paint.file", "array: has no meaning"}};
  ASSERT_EQ(faults.size(), expected.size());
  for (size_t k = 0; k < expected.size(); ++k) {
    EXPECT_EQ(faults[k].field, std::string("impurities.layers") + expected[k][0]);
    EXPECT_THAT(faults[k].description, HasSubstr(expected[k][1]));
  }
}

TEST_F(LayerFiles, NameTheLayerOfEveryFault) {
  const auto faults = Read(R"pb(
    layers { pattern { image { file: "none.png" } } }
    layers { pattern { image { file: "blank.png" } } }
    layers { pattern { image { file: "bar.png" threshold: 2 } } }
    layers { node_values { file: "worn.txt" } }
    layers { node_values { file: "worn.ply" shares: 1 } }
    layers { paint { file: "worn.ply" array: "tear" } })pb");
  ASSERT_EQ(faults.size(), 6u);
  EXPECT_EQ(faults[0].field, "impurities.layers[0].pattern.image.file");
  EXPECT_THAT(faults[0].description, HasSubstr("none.png"));
  // A black picture: everything is drawn.
  EXPECT_THAT(faults[1].description, HasSubstr("blank.png: every pixel is darker"));
  EXPECT_THAT(faults[2].description, StartsWith("threshold: 2 is outside (0, 1)"));
  EXPECT_THAT(faults[3].description, HasSubstr(".vtu or a .ply"));
  EXPECT_THAT(faults[4].description, HasSubstr("stands beside"));
  EXPECT_EQ(faults[5].field, "impurities.layers[5].paint.file");
  EXPECT_THAT(faults[5].description, HasSubstr("no property \"tear\""));
}

}  // namespace
}  // namespace cleave
