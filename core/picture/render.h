#ifndef CLEAVE_CORE_PICTURE_RENDER_H_
#define CLEAVE_CORE_PICTURE_RENDER_H_

#include <cstdint>
#include <map>
#include <memory>

#include "absl/status/statusor.h"
#include "core/picture/camera.h"
#include "core/picture/image.h"
#include "core/picture/shown_surface.h"

struct RTCDeviceTy;

namespace cleave {

class LitSolids;

enum class ColorBy {
  kRegion,  // the region's colour outside, a light one inside cracks
  kPiece,   // a colour a piece, lighter inside cracks
  kStrain,  // largest principal strain
  kDamage,  // share of broken edges
  kImpurity,
};

struct RenderStyle {
  ColorBy color_by = ColorBy::kRegion;
  // Palette slots of regions; a region that is not named takes its own id as slot.
  std::map<int32_t, int32_t> region_slots;
  double strain_limit = 0.2;  // strain that takes the last colour of the map, > 0
  int samples = 2;            // rays a pixel along each side, 1 to 8: edges and light get smoother
};

// Draws surfaces by ray casting on the processor: a soft sun, a sky that corners shut out, a plain
// ground that takes shadows. No display or GPU is asked for. The same surface, camera and style
// give the same bytes for any thread count. Not thread-safe; rows are drawn in parallel on the
// caller's TBB arena.
class Renderer {
 public:
  // Errors: Unavailable where Embree finds no device.
  static absl::StatusOr<Renderer> Create();

  // A picture of `width` x `height` pixels, each 1 to kMaxImageSide. A surface without triangles
  // gives the bare ground. `props` are drawn beside it in one grey, whatever their regions. Errors:
  // InvalidArgument for a bad surface (CheckShownSurface), size or style; ColorBy::kStrain needs
  // strains of `surface`, kDamage its damages, kImpurity its impurities.
  absl::StatusOr<Image> Render(const ShownSurface& surface, const Camera& camera,
                               const RenderStyle& style, int width, int height,
                               const ShownSurface& props = {});

  // The same in two steps, for pictures of one frame from several sides: what does not depend on
  // the camera is made once. `center` is about the middle of what will be seen; the surfaces must
  // outlive what is prepared of them, and that must not outlive the renderer.
  absl::StatusOr<std::shared_ptr<const LitSolids>> Prepare(const ShownSurface& surface,
                                                           const ShownSurface& props,
                                                           const Vec3& center,
                                                           const RenderStyle& style);
  absl::StatusOr<Image> Draw(const LitSolids& solids, const Camera& camera, int samples, int width,
                             int height);

 private:
  struct Release {
    void operator()(RTCDeviceTy* device) const;
  };
  explicit Renderer(RTCDeviceTy* device) : device_(device) {}

  std::unique_ptr<RTCDeviceTy, Release> device_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_RENDER_H_
