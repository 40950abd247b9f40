#include "client/io/preview/webp_animation.h"

#include <webp/encode.h>
#include <webp/mux.h>

#include <cmath>

#include "absl/strings/str_cat.h"

namespace cleave {

void WebpAnimation::Free::operator()(WebPAnimEncoder* encoder) const {
  WebPAnimEncoderDelete(encoder);
}

absl::StatusOr<WebpAnimation> WebpAnimation::Create(int width, int height, double quality) {
  if (width <= 0 || height <= 0 || width > WEBP_MAX_DIMENSION || height > WEBP_MAX_DIMENSION) {
    return absl::InvalidArgumentError(absl::StrCat("animation of ", width, " x ", height,
                                                   " pixels; sides are 1 to ", WEBP_MAX_DIMENSION));
  }
  if (!(quality >= 0 && quality <= 100)) {
    return absl::InvalidArgumentError(absl::StrCat("quality ", quality, " is outside [0, 100]"));
  }
  WebPAnimEncoderOptions options;
  if (WebPAnimEncoderOptionsInit(&options) == 0) {
    return absl::InternalError("libwebpmux is of another version than its headers");
  }
  options.anim_params.loop_count = 0;
  options.kmax = 12;  // a whole image now and then keeps seeking and damage local
  WebPAnimEncoder* encoder = WebPAnimEncoderNew(width, height, &options);
  if (encoder == nullptr) return absl::ResourceExhaustedError("no memory for an animation");
  return WebpAnimation(encoder, width, height, quality);
}

absl::Status WebpAnimation::Add(const Image& image, double seconds) {
  if (image.width != width_ || image.height != height_) {
    return absl::InvalidArgumentError(absl::StrCat("image of ", image.width, " x ", image.height,
                                                   " in an animation of ", width_, " x ", height_));
  }
  if (!(seconds > 0 && seconds <= 3600)) {
    return absl::InvalidArgumentError(
        absl::StrCat("duration ", seconds, " s is outside (0, 3600]"));
  }
  WebPConfig config;
  WebPPicture picture;
  if (WebPConfigInit(&config) == 0 || WebPPictureInit(&picture) == 0) {
    return absl::InternalError("libwebp is of another version than its headers");
  }
  config.quality = static_cast<float>(quality_);
  config.method = 3;
  picture.width = width_;
  picture.height = height_;
  picture.use_argb = 1;
  const bool added = WebPPictureImportRGB(&picture, image.rgb.data(), 3 * width_) != 0 &&
                     WebPAnimEncoderAdd(encoder_.get(), &picture,
                                        static_cast<int>(std::lround(1000 * end_)), &config) != 0;
  WebPPictureFree(&picture);
  if (!added) {
    return absl::InternalError(
        absl::StrCat("encoding WebP: ", WebPAnimEncoderGetError(encoder_.get())));
  }
  end_ += seconds;
  ++images_;
  return absl::OkStatus();
}

absl::StatusOr<std::string> WebpAnimation::Finish() {
  if (images_ == 0) return absl::FailedPreconditionError("an animation without images");
  WebPData data;
  WebPDataInit(&data);
  if (WebPAnimEncoderAdd(encoder_.get(), nullptr, static_cast<int>(std::lround(1000 * end_)),
                         nullptr) == 0 ||
      WebPAnimEncoderAssemble(encoder_.get(), &data) == 0) {
    return absl::InternalError(
        absl::StrCat("assembling WebP: ", WebPAnimEncoderGetError(encoder_.get())));
  }
  std::string bytes(reinterpret_cast<const char*>(data.bytes), data.size);
  WebPDataClear(&data);
  return bytes;
}

}  // namespace cleave
