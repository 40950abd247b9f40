#ifndef CLEAVE_CLIENT_IO_PREVIEW_WEBP_ANIMATION_H_
#define CLEAVE_CLIENT_IO_PREVIEW_WEBP_ANIMATION_H_

#include <memory>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/picture/image.h"

struct WebPAnimEncoder;

namespace cleave {

// Builds an endlessly looping WebP, an image at a time. Not thread-safe.
class WebpAnimation {
 public:
  // Every image must be `width` x `height`. `quality` in [0, 100]: larger is better and bigger.
  static absl::StatusOr<WebpAnimation> Create(int width, int height, double quality);

  // Shows `image` for `seconds`. Errors: InvalidArgument for an image of another size.
  absl::Status Add(const Image& image, double seconds);

  // The bytes of the file. Call once, after at least one Add.
  absl::StatusOr<std::string> Finish();

 private:
  struct Free {
    void operator()(WebPAnimEncoder* encoder) const;
  };
  WebpAnimation(WebPAnimEncoder* encoder, int width, int height, double quality)
      : encoder_(encoder), width_(width), height_(height), quality_(quality) {}

  std::unique_ptr<WebPAnimEncoder, Free> encoder_;
  int width_;
  int height_;
  double quality_;
  double end_ = 0;  // s, where the next image starts
  int images_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_PREVIEW_WEBP_ANIMATION_H_
