#ifndef CLEAVE_TESTS_UNIT_CLIENT_IO_IMPURITY_JPEG_PICTURE_H_
#define CLEAVE_TESTS_UNIT_CLIENT_IO_IMPURITY_JPEG_PICTURE_H_

#include <cstdio>
#include <cstdlib>
#include <string>

// It needs size_t and FILE declared before it.
#include <jpeglib.h>

#include "core/picture/image.h"

namespace cleave {

// The bytes of a JPEG file.
inline std::string Jpeg(Image image, bool progressive = false) {
  jpeg_compress_struct info;
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = static_cast<JDIMENSION>(image.width);
  info.image_height = static_cast<JDIMENSION>(image.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, 95, TRUE);
  if (progressive) jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  for (int y = 0; y < image.height; ++y) {
    JSAMPROW row = image.at(0, y);
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  const std::string result(reinterpret_cast<char*>(bytes), size);
  jpeg_destroy_compress(&info);
  std::free(bytes);
  return result;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CLIENT_IO_IMPURITY_JPEG_PICTURE_H_
