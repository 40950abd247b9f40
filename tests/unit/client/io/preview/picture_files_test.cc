#include <gtest/gtest.h>
#include <png.h>
#include <webp/demux.h>

#include "client/io/preview/webp_animation.h"
#include "core/picture/image.h"

namespace cleave {
namespace {

Image Gradient(int width, int height, int shift) {
  Image image(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      image.at(x, y)[0] = static_cast<uint8_t>(x * 3 + shift);
      image.at(x, y)[1] = static_cast<uint8_t>(y * 5);
      image.at(x, y)[2] = static_cast<uint8_t>(shift);
    }
  }
  return image;
}

TEST(Png, DecodesToTheSamePixels) {
  const Image image = Gradient(37, 21, 9);
  const auto bytes = EncodePng(image);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&header, bytes->data(), bytes->size()), 0);
  EXPECT_EQ(header.width, 37u);
  EXPECT_EQ(header.height, 21u);
  header.format = PNG_FORMAT_RGB;
  std::vector<uint8_t> pixels(PNG_IMAGE_SIZE(header));
  ASSERT_NE(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr), 0);
  EXPECT_EQ(pixels, image.rgb);
  EXPECT_FALSE(EncodePng(Image()).ok());
}

TEST(WebpAnimation, DecodesToTheSameSizeCountAndTimes) {
  auto animation = WebpAnimation::Create(64, 48, 80);
  ASSERT_TRUE(animation.ok()) << animation.status();
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(animation->Add(Gradient(64, 48, 40 * i), 0.05).ok());
  const auto bytes = animation->Finish();
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const WebPData data{reinterpret_cast<const uint8_t*>(bytes->data()), bytes->size()};
  WebPAnimDecoder* decoder = WebPAnimDecoderNew(&data, nullptr);
  ASSERT_NE(decoder, nullptr);
  WebPAnimInfo info;
  ASSERT_NE(WebPAnimDecoderGetInfo(decoder, &info), 0);
  EXPECT_EQ(info.canvas_width, 64u);
  EXPECT_EQ(info.canvas_height, 48u);
  EXPECT_EQ(info.frame_count, 5u);
  EXPECT_EQ(info.loop_count, 0u);
  int time = 0;
  uint8_t* pixels = nullptr;
  for (int i = 0; i < 5; ++i) {
    ASSERT_NE(WebPAnimDecoderGetNext(decoder, &pixels, &time), 0);
    EXPECT_EQ(time, 50 * (i + 1));
  }
  WebPAnimDecoderDelete(decoder);
}

TEST(WebpAnimation, BadInputIsRefused) {
  EXPECT_FALSE(WebpAnimation::Create(0, 48, 80).ok());
  EXPECT_FALSE(WebpAnimation::Create(64, 48, 101).ok());
  auto animation = WebpAnimation::Create(64, 48, 80);
  ASSERT_TRUE(animation.ok());
  EXPECT_FALSE(animation->Add(Gradient(48, 64, 0), 0.05).ok());
  EXPECT_FALSE(animation->Add(Gradient(64, 48, 0), 0).ok());
  EXPECT_FALSE(animation->Finish().ok());
}

}  // namespace
}  // namespace cleave
