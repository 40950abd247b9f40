#ifndef CLEAVE_CLIENT_IO_BAKE_GLB_JSON_H_
#define CLEAVE_CLIENT_IO_BAKE_GLB_JSON_H_

#include <array>
#include <string>
#include <vector>

#include "client/io/bake/bake_codec.h"
#include "client/io/bake/glb_layout.h"

namespace cleave {

struct GlbBounds {
  std::array<float, 3> low{};
  std::array<float, 3> high{};
};

// What the description tells of values.
struct GlbValues {
  std::vector<GlbBounds> rest;     // m, a primitive each
  std::vector<GlbBounds> targets;  // m, a frame each, and in it a primitive
  std::vector<float> times;        // s, a frame each
};

// The description of a baked scene. With `longest`, bounds of targets and times, which may not be
// known yet, are as long as they may get. Source: Khronos, glTF 2.0 specification.
std::string EncodeGlbJson(const BakeContext& context, const GlbLayout& layout,
                          const GlbValues& values, bool longest);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_BAKE_GLB_JSON_H_
