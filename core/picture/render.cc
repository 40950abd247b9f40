#include "core/picture/render.h"

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "absl/strings/str_cat.h"
#include "core/base/faults.h"
#include "core/base/parallel.h"
#include "core/base/status.h"
#include "core/picture/light_filter.h"
#include "core/picture/lit_scene.h"

namespace cleave {
namespace {

using Eigen::Vector3f;

// sRGB code of a linear value, highlights rolled off above 0.8.
uint8_t ToByte(float linear) {
  float x = std::max(linear, 0.0f);
  if (x > 0.8f) x = 1 - 0.2f * std::exp((0.8f - x) / 0.2f);
  const float coded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return static_cast<uint8_t>(std::lround(255 * std::min(coded, 1.0f)));
}

// Casts the rays of one pixel. Every pixel of a 4 x 4 tile takes its own part of one sequence, so
// that the light filter, which looks that far around, meets them all.
LitPixel CastPixel(const LitScene& scene, int x, int y, int width, int height, int samples) {
  LitPixel pixel;
  const int rays = samples * samples;
  const auto tile = static_cast<uint32_t>((y & 3) * 4 + (x & 3));
  Hit first;
  for (int ray = 0; ray < rays; ++ray) {
    const float dx = (static_cast<float>(ray % samples) + 0.5f) / static_cast<float>(samples);
    const float dy = (static_cast<float>(ray / samples) + 0.5f) / static_cast<float>(samples);
    const float u = 2 * (static_cast<float>(x) + dx) / static_cast<float>(width) - 1;
    const float v = 1 - 2 * (static_cast<float>(y) + dy) / static_cast<float>(height);
    const Hit hit = scene.Trace(u, v);
    const uint32_t sample = tile * static_cast<uint32_t>(rays) + static_cast<uint32_t>(ray);
    float shine = 0;
    Vector3f light = Vector3f::Zero();
    if (hit.lit > 0) light = hit.lit * scene.Irradiance(hit, sample, shine);
    pixel.light += light;
    pixel.albedo += hit.albedo;
    pixel.extra += hit.glow + Vector3f::Constant(shine);
    pixel.color += hit.albedo.cwiseProduct(light);
    pixel.normal += hit.normal;
    pixel.position += hit.position;
    pixel.distance += hit.distance;
    if (ray == 0) first = hit;
    const bool alike = hit.normal.dot(first.normal) > 0.9f &&
                       std::abs(hit.distance - first.distance) < 0.02f * first.distance &&
                       (hit.albedo - first.albedo).squaredNorm() < 1e-3f;
    if (!alike) pixel.mixed = true;
  }
  pixel.Divide(static_cast<float>(rays));
  return pixel;
}

void CheckPicture(int samples, int width, int height, Faults& faults) {
  for (const auto& [name, side] : {std::pair{"width", width}, std::pair{"height", height}}) {
    if (side < 1 || side > kMaxImageSide) {
      faults.Error(name, absl::StrCat(side, " is outside [1, ", kMaxImageSide, "]"));
    }
  }
  if (samples < 1 || samples > 8) {
    faults.Error("samples", absl::StrCat(samples, " is outside [1, 8]"));
  }
}

void CheckLook(const ShownSurface& surface, const RenderStyle& style, Faults& faults) {
  if (style.color_by == ColorBy::kStrain) {
    if (!(style.strain_limit > 0 && std::isfinite(style.strain_limit))) {
      faults.Error("strain_limit", absl::StrCat(style.strain_limit, " is not above 0"));
    }
    if (surface.strains.size() != surface.points.size()) {
      faults.Error("color_by", "the surface carries no strains");
    }
  }
  if (style.color_by == ColorBy::kDamage && surface.damages.size() != surface.points.size())
    faults.Error("color_by", "the surface carries no damages");
  if (style.color_by == ColorBy::kImpurity && surface.impurities.size() != surface.points.size())
    faults.Error("color_by", "the surface carries no impurities");
}

}  // namespace

void Renderer::Release::operator()(RTCDeviceTy* device) const { rtcReleaseDevice(device); }

absl::StatusOr<Renderer> Renderer::Create() {
  RTCDevice device = rtcNewDevice(nullptr);
  if (device == nullptr) {
    return absl::UnavailableError(absl::StrCat("Embree finds no device: error ",
                                               static_cast<int>(rtcGetDeviceError(nullptr))));
  }
  return Renderer(device);
}

absl::StatusOr<Image> Renderer::Render(const ShownSurface& surface, const Camera& camera,
                                       const RenderStyle& style, int width, int height,
                                       const ShownSurface& props) {
  Faults faults;
  CheckPicture(style.samples, width, height, faults);
  CheckLook(surface, style, faults);
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
  CLEAVE_ASSIGN_OR_RETURN(const auto solids, Prepare(surface, props, camera.scene_center, style));
  return Draw(*solids, camera, style.samples, width, height);
}

absl::StatusOr<std::shared_ptr<const LitSolids>> Renderer::Prepare(const ShownSurface& surface,
                                                                   const ShownSurface& props,
                                                                   const Vec3& center,
                                                                   const RenderStyle& style) {
  Faults faults;
  CheckLook(surface, style, faults);
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
  CLEAVE_RETURN_IF_ERROR(CheckShownSurface(surface));
  CLEAVE_RETURN_IF_ERROR(CheckShownSurface(props));
  auto solids = std::make_shared<const LitSolids>(device_.get(), surface, props, center, style);
  if (const RTCError error = rtcGetDeviceError(device_.get());
      error != RTC_ERROR_NONE || !solids->ready()) {
    return absl::ResourceExhaustedError(
        absl::StrCat("Embree cannot take the surface: error ", static_cast<int>(error)));
  }
  return solids;
}

absl::StatusOr<Image> Renderer::Draw(const LitSolids& solids, const Camera& camera, int samples,
                                     int width, int height) {
  Faults faults;
  CheckPicture(samples, width, height, faults);
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
  const LitScene scene(solids, camera);
  LitPixels pixels(width, height);
  ParallelFor(height, 1, [&](int64_t begin, int64_t end) {
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < width; ++x) {
        pixels.at(x, y) = CastPixel(scene, x, y, width, height, samples);
      }
    }
  });
  Image image(width, height);
  ParallelFor(height, 1, [&](int64_t begin, int64_t end) {
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < width; ++x) {
        const Vector3f color = FilteredColor(pixels, x, y, static_cast<float>(camera.scene_radius));
        for (int k = 0; k < 3; ++k) image.at(x, y)[k] = ToByte(color[k]);
      }
    }
  });
  return image;
}

}  // namespace cleave
