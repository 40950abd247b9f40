#include "client/io/impurity/picture_file.h"

#include <png.h>

#include <algorithm>
#include <array>
#include <csetjmp>
#include <cstdio>
#include <optional>
#include <utility>
#include <vector>

// It needs size_t and FILE declared before it.
#include <jpeglib.h>

#include "absl/status/status.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/io/mesh/file_bytes.h"
#include "core/base/status.h"

namespace cleave {
namespace {

absl::Status CheckSize(int64_t width, int64_t height) {
  if (width > 0 && height > 0 && width <= kMaxPicturePixels / height) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrCat("has ", width, " x ", height, " pixels; 1 to ",
                                                 kMaxPicturePixels, " are allowed"));
}

// What of a picture is kept; nothing: grey over white.
using Wanted = std::optional<TextureChannel>;

// Reduces a row of decoded pixels, of so many bytes each, to a byte each.
void AppendRow(const uint8_t* row, size_t bytes, const Wanted& wanted, PictureBytes& picture) {
  const auto width = static_cast<size_t>(picture.width);
  if (!wanted) {
    picture.values.insert(picture.values.end(), row, row + width);
    return;
  }
  for (const uint8_t* pixel = row; pixel != row + width * bytes; pixel += bytes) {
    switch (*wanted) {
      case TextureChannel::kLuminance:
        picture.values.push_back(static_cast<uint8_t>(
            (2126 * pixel[0] + 7152 * pixel[1] + 722 * pixel[2] + 5000) / 10000));
        break;
      case TextureChannel::kRed:
        picture.values.push_back(pixel[0]);
        break;
      case TextureChannel::kGreen:
        picture.values.push_back(pixel[1]);
        break;
      case TextureChannel::kBlue:
        picture.values.push_back(pixel[2]);
        break;
      case TextureChannel::kAlpha:
        picture.values.push_back(pixel[3]);
        break;
    }
  }
}

constexpr char kNoAlpha[] = "has no alpha channel";

absl::StatusOr<PictureBytes> ParsePng(absl::string_view bytes, const Wanted& wanted) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const auto failure = [&image] {
    absl::Status status =
        absl::InvalidArgumentError(absl::StrCat("cannot be read as PNG: ", image.message));
    png_image_free(&image);
    return status;
  };
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) return failure();
  absl::Status status = CheckSize(image.width, image.height);
  if (status.ok() && wanted == TextureChannel::kAlpha &&
      (image.format & PNG_FORMAT_FLAG_ALPHA) == 0)
    status = absl::InvalidArgumentError(kNoAlpha);
  if (!status.ok()) {
    png_image_free(&image);
    return status;
  }
  // Colours of 16 bits are no more linear than others.
  image.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  image.format = wanted ? PNG_FORMAT_RGBA : PNG_FORMAT_GRAY;
  const size_t bytes_a_pixel = wanted ? 4 : 1;
  const png_color white = {255, 255, 255};
  std::vector<uint8_t> pixels(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, &white, pixels.data(), 0, nullptr) == 0) return failure();
  PictureBytes picture{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  picture.values.reserve(size_t{image.width} * image.height);
  for (size_t y = 0; y < image.height; ++y)
    AppendRow(pixels.data() + y * image.width * bytes_a_pixel, bytes_a_pixel, wanted, picture);
  return picture;
}

// libjpeg reports errors by a call that must not return.
struct JpegErrors {
  jpeg_error_mgr manager;
  std::jmp_buf jump;
  std::array<char, JMSG_LENGTH_MAX> message;
};

[[noreturn]] void OnJpegError(j_common_ptr info) {
  auto* errors = reinterpret_cast<JpegErrors*>(info->err);
  (*info->err->format_message)(info, errors->message.data());
  std::longjmp(errors->jump, 1);
}

// What a jump out of libjpeg leaves behind: it is of the caller's frame, which no jump unwinds.
struct JpegPicture {
  jpeg_decompress_struct info;
  JpegErrors errors;
  std::vector<uint8_t> row;
  PictureBytes picture;
  absl::Status status;
};

// False where libjpeg has given up.
bool DecodeJpeg(absl::string_view bytes, const Wanted& wanted, JpegPicture& picture) {
  jpeg_decompress_struct& info = picture.info;
  if (setjmp(picture.errors.jump) != 0) return false;
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&info, TRUE);
  picture.status = CheckSize(info.image_width, info.image_height);
  if (!picture.status.ok()) return true;
  info.out_color_space = wanted ? JCS_RGB : JCS_GRAYSCALE;
  jpeg_start_decompress(&info);
  picture.picture.width = static_cast<int>(info.output_width);
  picture.picture.height = static_cast<int>(info.output_height);
  const size_t bytes_a_pixel = wanted ? 3 : 1;
  picture.row.resize(info.output_width * bytes_a_pixel);
  picture.picture.values.reserve(static_cast<size_t>(info.output_width) * info.output_height);
  while (info.output_scanline < info.output_height) {
    JSAMPROW begin = picture.row.data();
    jpeg_read_scanlines(&info, &begin, 1);
    AppendRow(picture.row.data(), bytes_a_pixel, wanted, picture.picture);
  }
  // A file that ends early is filled up with grey, and only warned of.
  if (picture.errors.manager.num_warnings > 0)
    picture.status = absl::InvalidArgumentError("cannot be read as JPEG: its data are damaged");
  jpeg_finish_decompress(&info);
  return true;
}

absl::StatusOr<PictureBytes> ParseJpeg(absl::string_view bytes, const Wanted& wanted) {
  if (wanted == TextureChannel::kAlpha) return absl::InvalidArgumentError(kNoAlpha);
  JpegPicture picture;
  picture.info.err = jpeg_std_error(&picture.errors.manager);
  picture.errors.manager.error_exit = OnJpegError;
  picture.errors.manager.output_message = [](j_common_ptr) {};
  jpeg_create_decompress(&picture.info);
  const bool decoded = DecodeJpeg(bytes, wanted, picture);
  jpeg_destroy_decompress(&picture.info);
  if (!decoded) {
    return absl::InvalidArgumentError(
        absl::StrCat("cannot be read as JPEG: ", picture.errors.message.data()));
  }
  if (!picture.status.ok()) return picture.status;
  return std::move(picture.picture);
}

absl::StatusOr<PictureBytes> Parse(absl::string_view bytes, const Wanted& wanted) {
  if (absl::StartsWith(bytes, "\x89PNG")) return ParsePng(bytes, wanted);
  if (absl::StartsWith(bytes, "\xff\xd8\xff")) return ParseJpeg(bytes, wanted);
  return absl::InvalidArgumentError("is neither a PNG nor a JPEG file");
}

// A status with the path before it.
template <typename Picture>
absl::StatusOr<Picture> At(const std::string& path, absl::StatusOr<Picture> picture) {
  if (picture.ok()) return picture;
  return absl::InvalidArgumentError(absl::StrCat(path, ": ", picture.status().message()));
}

}  // namespace

absl::StatusOr<GreyRaster> ParsePicture(absl::string_view bytes) {
  CLEAVE_ASSIGN_OR_RETURN(const PictureBytes picture, Parse(bytes, std::nullopt));
  GreyRaster raster{picture.width, picture.height, {}};
  raster.values.reserve(picture.values.size());
  for (const uint8_t value : picture.values)
    raster.values.push_back(static_cast<float>(value) / 255);
  return raster;
}

absl::StatusOr<PictureBytes> ParseChannel(absl::string_view bytes, TextureChannel channel) {
  return Parse(bytes, channel);
}

absl::StatusOr<GreyRaster> ReadPictureFile(const std::string& path) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
  return At(path, ParsePicture(bytes));
}

absl::StatusOr<PictureBytes> ReadChannelFile(const std::string& path, TextureChannel channel) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
  return At(path, ParseChannel(bytes, channel));
}

PictureBytes Reduced(const PictureBytes& picture, int most) {
  PictureBytes small{std::min(picture.width, most), std::min(picture.height, most), {}};
  if (small.width == picture.width && small.height == picture.height) return picture;
  small.values.reserve(static_cast<size_t>(small.width) * static_cast<size_t>(small.height));
  const auto begin = [](int k, int of, int from) {
    return static_cast<int>(int64_t{k} * from / of);
  };
  for (int y = 0; y < small.height; ++y) {
    const int top = begin(y, small.height, picture.height);
    const int bottom = begin(y + 1, small.height, picture.height);
    for (int x = 0; x < small.width; ++x) {
      const int left = begin(x, small.width, picture.width);
      const int right = begin(x + 1, small.width, picture.width);
      int64_t sum = 0;
      for (int j = top; j < bottom; ++j) {
        for (int i = left; i < right; ++i)
          sum += picture.values[static_cast<size_t>(int64_t{j} * picture.width + i)];
      }
      const int64_t count = int64_t{bottom - top} * (right - left);
      small.values.push_back(static_cast<uint8_t>((sum + count / 2) / count));
    }
  }
  return small;
}

}  // namespace cleave
