#include "client/io/impurity/picture_file.h"

#include <png.h>

#include <array>
#include <csetjmp>
#include <cstdio>
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

void AppendRow(const uint8_t* row, int width, GreyRaster& raster) {
  for (int x = 0; x < width; ++x) raster.values.push_back(static_cast<float>(row[x]) / 255);
}

absl::StatusOr<GreyRaster> ParsePng(absl::string_view bytes) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  const auto failure = [&image] {
    absl::Status status =
        absl::InvalidArgumentError(absl::StrCat("cannot be read as PNG: ", image.message));
    png_image_free(&image);
    return status;
  };
  if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) return failure();
  if (absl::Status status = CheckSize(image.width, image.height); !status.ok()) {
    png_image_free(&image);
    return status;
  }
  image.format = PNG_FORMAT_GRAY;
  const png_color white = {255, 255, 255};
  std::vector<uint8_t> pixels(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, &white, pixels.data(), 0, nullptr) == 0) return failure();
  GreyRaster raster{static_cast<int>(image.width), static_cast<int>(image.height), {}};
  raster.values.reserve(pixels.size());
  for (size_t y = 0; y < image.height; ++y)
    AppendRow(pixels.data() + y * image.width, raster.width, raster);
  return raster;
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
  GreyRaster raster;
  absl::Status status;
};

// False where libjpeg has given up.
bool DecodeJpeg(absl::string_view bytes, JpegPicture& picture) {
  jpeg_decompress_struct& info = picture.info;
  if (setjmp(picture.errors.jump) != 0) return false;
  jpeg_mem_src(&info, reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
  jpeg_read_header(&info, TRUE);
  picture.status = CheckSize(info.image_width, info.image_height);
  if (!picture.status.ok()) return true;
  info.out_color_space = JCS_GRAYSCALE;
  jpeg_start_decompress(&info);
  picture.raster.width = static_cast<int>(info.output_width);
  picture.raster.height = static_cast<int>(info.output_height);
  picture.row.resize(info.output_width);
  picture.raster.values.reserve(static_cast<size_t>(info.output_width) * info.output_height);
  while (info.output_scanline < info.output_height) {
    JSAMPROW begin = picture.row.data();
    jpeg_read_scanlines(&info, &begin, 1);
    AppendRow(picture.row.data(), picture.raster.width, picture.raster);
  }
  // A file that ends early is filled up with grey, and only warned of.
  if (picture.errors.manager.num_warnings > 0)
    picture.status = absl::InvalidArgumentError("cannot be read as JPEG: its data are damaged");
  jpeg_finish_decompress(&info);
  return true;
}

absl::StatusOr<GreyRaster> ParseJpeg(absl::string_view bytes) {
  JpegPicture picture;
  picture.info.err = jpeg_std_error(&picture.errors.manager);
  picture.errors.manager.error_exit = OnJpegError;
  picture.errors.manager.output_message = [](j_common_ptr) {};
  jpeg_create_decompress(&picture.info);
  const bool decoded = DecodeJpeg(bytes, picture);
  jpeg_destroy_decompress(&picture.info);
  if (!decoded) {
    return absl::InvalidArgumentError(
        absl::StrCat("cannot be read as JPEG: ", picture.errors.message.data()));
  }
  if (!picture.status.ok()) return picture.status;
  return std::move(picture.raster);
}

}  // namespace

absl::StatusOr<GreyRaster> ParsePicture(absl::string_view bytes) {
  if (absl::StartsWith(bytes, "\x89PNG")) return ParsePng(bytes);
  if (absl::StartsWith(bytes, "\xff\xd8\xff")) return ParseJpeg(bytes);
  return absl::InvalidArgumentError("is neither a PNG nor a JPEG file");
}

absl::StatusOr<GreyRaster> ReadPictureFile(const std::string& path) {
  CLEAVE_ASSIGN_OR_RETURN(const std::string bytes, ReadFileBytes(path));
  auto raster = ParsePicture(bytes);
  if (raster.ok()) return raster;
  return absl::InvalidArgumentError(absl::StrCat(path, ": ", raster.status().message()));
}

}  // namespace cleave
