#ifndef CLEAVE_CLIENT_IO_BAKE_BAKE_CODEC_H_
#define CLEAVE_CLIENT_IO_BAKE_BAKE_CODEC_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "client/io/bake/baked_surface.h"
#include "client/io/export/surface_materials.h"
#include "core/base/vec3.h"

namespace cleave {

// When frames come, and when they are shown.
struct BakeTiming {
  int64_t count = 0;
  int64_t first_frame = 0;
  int64_t last_frame = 0;
  double first_time = 0;                // s
  double last_time = 0;                 // s
  std::optional<double> playback_rate;  // frame numbers a second; absent: as fast as simulated

  // Frame numbers from one frame to the next, and frame numbers a second of simulated time; 1 and
  // 24 for a single frame.
  double stride() const {
    return count > 1
               ? static_cast<double>(last_frame - first_frame) / static_cast<double>(count - 1)
               : 1;
  }
  double simulated_rate() const {
    const double seconds = last_time - first_time;
    return seconds > 0 ? static_cast<double>(last_frame - first_frame) / seconds : 24;
  }
  double rate() const { return playback_rate.value_or(simulated_rate()); }
};

// What a codec knows from the start.
struct BakeContext {
  const BakedSurface& surface;
  const SurfaceMaterials& materials;
  BakeTiming timing;
  std::string name;     // of the object
  std::string comment;  // names the data
  Vec3 up{0, 0, 1};     // of the scene, any length but 0
  bool velocities = false;
};

// One frame, as a codec takes it.
struct BakeFrame {
  int64_t index = 0;  // from 0
  int64_t frame = 0;
  double time = 0;                      // s
  const std::vector<Vec3>& points;      // m
  const std::vector<Vec3>& velocities;  // m/s
};

// A format that holds a whole run in one file: its bytes in order, a frame at a time. Every frame
// is noted, also one whose bytes stand already; those of the first bytes that depend on later ones
// are written last. Not thread-safe.
class BakeCodec {
 public:
  virtual ~BakeCodec() = default;

  // How often the frames are gone through.
  virtual int64_t passes() const { return 1; }
  // Everything before the first frame, of the length that Head has, if any.
  virtual std::string Begin() const = 0;
  // Called for every frame in order, before its Encode. Errors: InvalidArgument for frames that the
  // format cannot hold.
  virtual absl::Status Note(int64_t pass, const BakeFrame& frame) = 0;
  virtual void Encode(int64_t pass, const BakeFrame& frame, std::string& out) const = 0;
  // What comes after the last frame.
  virtual std::string End() const { return ""; }
  // What replaces as many bytes at the beginning, once all frames are noted.
  virtual std::string Head() const { return ""; }
};

// Point caches hold positions alone, as float triples in the order of the surface's points.
enum class PointCacheKind { kPc2, kMdd };

// Autodesk's PC2: 32 bytes of header, little-endian. Its start is the first frame's number, its
// sampling rate the frames from one sample to the next. With `velocities`, m/s stand in place of m.
// Errors: InvalidArgument above 2^31 - 1 points or frames, which cannot be counted in it.
absl::StatusOr<std::unique_ptr<BakeCodec>> MakePointCache(const BakeContext& context,
                                                          PointCacheKind kind, bool velocities);

// A binary glTF 2.0 file: one mesh, a primitive a material, a morph target a frame, one animation
// of weights that go linearly from frame to frame. Errors: InvalidArgument above 4 GiB - 1 bytes,
// what a GLB can hold, and for an up of no direction.
absl::StatusOr<std::unique_ptr<BakeCodec>> MakeGlb(const BakeContext& context);

// OpenUSD as text, a time sample a frame. Errors: InvalidArgument for an up of no direction.
absl::StatusOr<std::unique_ptr<BakeCodec>> MakeUsda(const BakeContext& context);

}  // namespace cleave

#endif  // CLEAVE_CLIENT_IO_BAKE_BAKE_CODEC_H_
