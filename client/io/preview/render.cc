#include "client/io/preview/render.h"

#include <embree3/rtcore.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/io/preview/light_filter.h"
#include "client/io/preview/surface_normals.h"
#include "client/io/series/palette.h"
#include "core/base/faults.h"
#include "core/base/parallel.h"
#include "core/base/status.h"

namespace cleave {
namespace {

using Eigen::Vector3f;

constexpr float kPi = std::numbers::pi_v<float>;

// Unshadowed level ground receives 1: this much from the sun, the rest from the sky.
constexpr float kSunShare = 0.66f;
constexpr float kSunSpread = 0.10f;  // radius of the sun's disc at distance 1: how soft shadows are
constexpr int kSkyRays = 2;          // a camera ray
const Vector3f kSkyTint(0.93f, 0.97f, 1.06f);
const Vector3f kSunTint(1.04f, 1.0f, 0.94f);
const Vector3f kGroundAlbedo(0.80f, 0.805f, 0.81f);
const Vector3f kBackdrop(0.88f, 0.89f, 0.90f);  // what the ground fades into far away

Vector3f ToFloat(const Vec3& v) {
  return Vector3f(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
}

float ToLinear(float s) {
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}
Vector3f ToLinear(const Color& c) { return {ToLinear(c[0]), ToLinear(c[1]), ToLinear(c[2])}; }

// sRGB code of a linear value, highlights rolled off above 0.8.
uint8_t ToByte(float linear) {
  float x = std::max(linear, 0.0f);
  if (x > 0.8f) x = 1 - 0.2f * std::exp((0.8f - x) / 0.2f);
  const float coded = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
  return static_cast<uint8_t>(std::lround(255 * std::min(coded, 1.0f)));
}

// Point `index` of a sequence that fills the unit square evenly from its first points on: the
// lattice of the plastic number (Roberts 2018), shifted by `shift` so that uses do not agree.
std::array<float, 2> Spread(uint32_t index, uint32_t shift) {
  const double i = static_cast<double>(index);
  const double u = 0.5 + 0.7548776662466927 * i + 0.3819660112501051 * shift;
  const double v = 0.5 + 0.5698402909980532 * i + 0.2360679774997897 * shift;
  return {static_cast<float>(u - std::floor(u)), static_cast<float>(v - std::floor(v))};
}

// Two directions square to `normal` and to each other.
std::array<Vector3f, 2> Tangents(const Vector3f& normal) {
  const float sign = std::copysign(1.0f, normal.z());
  const float a = -1 / (sign + normal.z());
  const float b = normal.x() * normal.y() * a;
  return {Vector3f(1 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x()),
          Vector3f(b, sign + normal.y() * normal.y() * a, -normal.y())};
}

Vector3f CosineDirection(const Vector3f& normal, const std::array<float, 2>& place) {
  const auto [t, s] = Tangents(normal);
  const float r = std::sqrt(place[0]);
  const float angle = 2 * kPi * place[1];
  return r * std::cos(angle) * t + r * std::sin(angle) * s + std::sqrt(1 - place[0]) * normal;
}

// What a camera ray meets.
struct Hit {
  Vector3f position;
  Vector3f shadow_origin;
  Vector3f normal;   // geometric, towards the camera
  Vector3f shading;  // smoothed
  Vector3f albedo;
  float distance = 0;
  float gloss = 0;
  float fade = 0;  // 1: the far ground, which is all backdrop
};

class Scene {
 public:
  Scene(RTCDevice device, const ShownSurface& surface, const Camera& camera,
        const RenderStyle& style)
      : surface_(surface),
        style_(style),
        eye_(ToFloat(camera.position)),
        right_(ToFloat(camera.right) * static_cast<float>(camera.half_width)),
        up_(ToFloat(camera.up) * static_cast<float>(camera.half_height)),
        forward_(ToFloat(camera.forward)),
        center_(ToFloat(camera.scene_center)),
        radius_(static_cast<float>(camera.scene_radius)),
        ground_up_(ToFloat(camera.ground_normal)),
        offset_(2e-4f * radius_),
        // A hair below what stands on it, so that soles do not fight with it.
        ground_height_(static_cast<float>(camera.ground_height) - 1e-3f * radius_) {
    // Over the camera's right shoulder: FrameCamera stands to the right of the square view, so that
    // the faces which it sees besides the front are lit, and shadows fall to the left and away.
    const Vector3f level = (forward_ - ground_up_ * ground_up_.dot(forward_)).normalized();
    const Vector3f side = ToFloat(camera.right);
    sun_ = (ground_up_ + 0.60f * side - 0.62f * level).normalized();
    sun_strength_ = kSunShare / std::max(sun_.dot(ground_up_), 0.1f);
    normals_ = CornerNormals(surface);
    BuildColors();
    scene_ = rtcNewScene(device);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    if (!surface.triangles.empty()) {
      RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
      auto* points = static_cast<float*>(
          rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                  3 * sizeof(float), surface.points.size()));
      auto* ids = static_cast<uint32_t*>(
          rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                  3 * sizeof(uint32_t), surface.triangles.size()));
      ready_ = points != nullptr && ids != nullptr;
      if (ready_) {
        for (const Vec3& point : surface.points) {
          for (const double value : point) *points++ = static_cast<float>(value);
        }
        for (const auto& triangle : surface.triangles) {
          for (const int32_t point : triangle) *ids++ = static_cast<uint32_t>(point);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
      }
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene_);
  }
  ~Scene() { rtcReleaseScene(scene_); }
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  bool ready() const { return ready_; }

  // Light that reaches `hit`, and the shine that the sun leaves on it.
  Vector3f Irradiance(const Hit& hit, uint32_t sample, float& shine) const {
    const auto place = Spread(sample, 1);
    const auto [t, s] = Tangents(sun_);
    const float r = kSunSpread * std::sqrt(place[0]);
    const float angle = 2 * kPi * place[1];
    const Vector3f to_sun = (sun_ + r * std::cos(angle) * t + r * std::sin(angle) * s).normalized();
    const float facing = hit.shading.dot(to_sun);
    Vector3f light = Vector3f::Zero();
    shine = 0;
    if (facing > 0 && hit.normal.dot(to_sun) > 0 &&
        !Blocked(hit.shadow_origin + offset_ * hit.normal, to_sun)) {
      light += sun_strength_ * facing * kSunTint;
      const Vector3f half = (to_sun + (eye_ - hit.position).normalized()).normalized();
      shine = hit.gloss * std::pow(std::max(half.dot(hit.shading), 0.0f), 48.0f);
    }
    for (uint32_t ray = 0; ray < kSkyRays; ++ray) {
      const Vector3f direction = CosineDirection(hit.shading, Spread(sample, 2 + ray));
      if (direction.dot(hit.normal) <= 0) continue;
      const Vector3f origin = hit.position + offset_ * hit.normal;
      if (Blocked(origin, direction)) {
        light += Vector3f::Constant(0.10f / kSkyRays);  // light thrown back by what blocks
      } else {
        light += Sky(direction) / kSkyRays;
      }
    }
    return light;
  }

  Hit Trace(float x, float y) const {
    const Vector3f direction = (forward_ + x * right_ + y * up_).normalized();
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    SetRay(eye_, direction, ray.ray);
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    if (ray.hit.geomID != RTC_INVALID_GEOMETRY_ID) return SurfaceHit(direction, ray);
    return GroundHit(direction);
  }

 private:
  static void SetRay(const Vector3f& origin, const Vector3f& direction, RTCRay& ray) {
    ray.org_x = origin.x();
    ray.org_y = origin.y();
    ray.org_z = origin.z();
    ray.dir_x = direction.x();
    ray.dir_y = direction.y();
    ray.dir_z = direction.z();
    ray.tnear = 0;
    ray.tfar = std::numeric_limits<float>::infinity();
    ray.mask = ~0u;
  }

  bool Blocked(const Vector3f& origin, const Vector3f& direction) const {
    // A ray that starts outside the scene's ball and leads away from it meets nothing.
    const Vector3f to_center = center_ - origin;
    const float along = to_center.dot(direction);
    const float limit = 1.02f * radius_;
    const float apart = to_center.squaredNorm();
    if (apart > limit * limit && (along < 0 || apart - along * along > limit * limit)) return false;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay ray{};
    SetRay(origin, direction, ray);
    rtcOccluded1(scene_, &context, &ray);
    return ray.tfar < 0;
  }

  // Radiance times pi, so that an open level ground sums to 1 - kSunShare.
  Vector3f Sky(const Vector3f& direction) const {
    const float height = direction.dot(ground_up_);
    if (height < 0) return Vector3f::Constant(0.30f);  // the lit ground
    return (1 - kSunShare) * (0.82f + 0.27f * height) * kSkyTint;
  }

  void BuildColors() {
    if (style_.color_by == ColorBy::kStrain) {
      point_colors_.reserve(surface_.points.size());
      for (const float strain : surface_.strains) {
        point_colors_.push_back(ToLinear(SequentialColor(strain / style_.strain_limit)));
      }
      return;
    }
    colors_.reserve(surface_.triangles.size());
    for (size_t i = 0; i < surface_.triangles.size(); ++i) {
      const bool inside = surface_.inside[i] != 0;
      if (style_.color_by == ColorBy::kPiece) {
        const Vector3f color = ToLinear(PieceColor(surface_.pieces[i]));
        colors_.push_back(inside ? Vector3f(0.45f * color + Vector3f::Constant(0.42f)) : color);
      } else {
        const auto slot = style_.region_slots.find(surface_.regions[i]);
        const int32_t color =
            slot == style_.region_slots.end() ? surface_.regions[i] : slot->second;
        colors_.push_back(ToLinear(inside ? InsideColor(color) : RegionColor(color)));
      }
    }
  }

  Hit SurfaceHit(const Vector3f& direction, const RTCRayHit& ray) const {
    const size_t triangle = ray.hit.primID;
    const auto& ids = surface_.triangles[triangle];
    const std::array<float, 3> weights = {1 - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v};
    Hit hit;
    hit.distance = ray.ray.tfar;
    hit.position = eye_ + hit.distance * direction;
    hit.normal = Vector3f(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z).normalized();
    const float turn = hit.normal.dot(direction) > 0 ? -1.0f : 1.0f;
    hit.normal *= turn;
    Vector3f shading = Vector3f::Zero();
    // On coarse meshes the plain point would lie in the shadow of its own facets: it is moved out
    // to the tangent planes of the smoothed corners (Hanika 2021).
    hit.shadow_origin = hit.position;
    Vector3f color = Vector3f::Zero();
    for (size_t k = 0; k < 3; ++k) {
      const Vector3f normal = turn * normals_[triangle][k];
      shading += weights[k] * normal;
      const Vector3f corner = ToFloat(surface_.points[static_cast<size_t>(ids[k])]);
      const float below = std::min(0.0f, (hit.position - corner).dot(normal));
      hit.shadow_origin -= weights[k] * below * normal;
      if (!point_colors_.empty()) {
        color += weights[k] * point_colors_[static_cast<size_t>(ids[k])];
      }
    }
    const bool inside = surface_.inside[triangle] != 0;
    hit.shading = shading.squaredNorm() > 1e-8f ? shading.normalized() : hit.normal;
    if (hit.shading.dot(direction) > 0) hit.shading = hit.normal;
    hit.albedo = point_colors_.empty() ? colors_[triangle] : color;
    hit.gloss = inside ? 0.02f : 0.10f;
    return hit;
  }

  Hit GroundHit(const Vector3f& direction) const {
    Hit hit;
    hit.albedo = kBackdrop;
    hit.fade = 1;
    hit.distance = 1e6f * radius_;
    hit.normal = hit.shading = ground_up_;
    const float fall = direction.dot(ground_up_);
    if (fall >= -1e-6f) return hit;
    hit.distance = (ground_height_ - ground_up_.dot(eye_)) / fall;
    if (hit.distance <= 0) {
      hit.distance = 1e6f * radius_;
      return hit;
    }
    hit.position = hit.shadow_origin = eye_ + hit.distance * direction;
    const float away = (hit.position - center_).norm() / radius_;
    const float t = std::clamp((away - 1.2f) / 4.5f, 0.0f, 1.0f);
    hit.fade = t * t * (3 - 2 * t);
    hit.albedo = kGroundAlbedo;
    return hit;
  }

  const ShownSurface& surface_;
  const RenderStyle& style_;
  RTCScene scene_ = nullptr;
  bool ready_ = true;
  Vector3f eye_, right_, up_, forward_, center_;
  float radius_;
  Vector3f ground_up_;
  float offset_;
  float ground_height_;
  Vector3f sun_;
  float sun_strength_ = 0;
  std::vector<std::array<Vector3f, 3>> normals_;
  std::vector<Vector3f> colors_;        // linear, a triangle each
  std::vector<Vector3f> point_colors_;  // linear, a point each; strain only
};

// Casts the rays of one pixel. Every pixel of a 4 x 4 tile takes its own part of one sequence, so
// that the light filter, which looks that far around, meets them all.
LitPixel CastPixel(const Scene& scene, int x, int y, int width, int height, int samples) {
  LitPixel pixel;
  const int rays = samples * samples;
  const auto tile = static_cast<uint32_t>((y & 3) * 4 + (x & 3));
  std::array<Hit, 2> ends;
  for (int ray = 0; ray < rays; ++ray) {
    const float dx = (static_cast<float>(ray % samples) + 0.5f) / static_cast<float>(samples);
    const float dy = (static_cast<float>(ray / samples) + 0.5f) / static_cast<float>(samples);
    const float u = 2 * (static_cast<float>(x) + dx) / static_cast<float>(width) - 1;
    const float v = 1 - 2 * (static_cast<float>(y) + dy) / static_cast<float>(height);
    const Hit hit = scene.Trace(u, v);
    const uint32_t sample = tile * static_cast<uint32_t>(rays) + static_cast<uint32_t>(ray);
    float shine = 0;
    Vector3f light = Vector3f::Ones();
    if (hit.fade < 1) light = (1 - hit.fade) * scene.Irradiance(hit, sample, shine);
    const Vector3f backdrop = hit.fade * kBackdrop;
    pixel.light += hit.fade < 1 ? light : Vector3f::Zero();
    pixel.albedo += hit.albedo;
    pixel.extra += hit.fade < 1 ? Vector3f(backdrop + Vector3f::Constant(shine)) : backdrop;
    pixel.color += hit.fade < 1 ? Vector3f(hit.albedo.cwiseProduct(light)) : Vector3f::Zero();
    pixel.normal += hit.normal;
    pixel.position += hit.position;
    pixel.distance += hit.distance;
    if (ray == 0) ends[0] = ends[1] = hit;
    const bool alike = hit.normal.dot(ends[0].normal) > 0.9f &&
                       std::abs(hit.distance - ends[0].distance) < 0.02f * ends[0].distance &&
                       (hit.albedo - ends[0].albedo).squaredNorm() < 1e-3f;
    if (!alike) pixel.mixed = true;
  }
  pixel.Divide(static_cast<float>(rays));
  return pixel;
}

absl::Status CheckRender(const ShownSurface& surface, const RenderStyle& style, int width,
                         int height) {
  Faults faults;
  for (const auto& [name, side] : {std::pair{"width", width}, std::pair{"height", height}}) {
    if (side < 1 || side > kMaxImageSide) {
      faults.Error(name, absl::StrCat(side, " is outside [1, ", kMaxImageSide, "]"));
    }
  }
  if (style.samples < 1 || style.samples > 8) {
    faults.Error("samples", absl::StrCat(style.samples, " is outside [1, 8]"));
  }
  if (style.color_by == ColorBy::kStrain) {
    if (!(style.strain_limit > 0 && std::isfinite(style.strain_limit))) {
      faults.Error("strain_limit", absl::StrCat(style.strain_limit, " is not above 0"));
    }
    if (surface.strains.size() != surface.points.size()) {
      faults.Error("color_by", "the surface carries no strains");
    }
  }
  CLEAVE_RETURN_IF_ERROR(faults.ToStatus());
  return CheckShownSurface(surface);
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
                                       const RenderStyle& style, int width, int height) {
  CLEAVE_RETURN_IF_ERROR(CheckRender(surface, style, width, height));
  const Scene scene(device_.get(), surface, camera, style);
  if (const RTCError error = rtcGetDeviceError(device_.get());
      error != RTC_ERROR_NONE || !scene.ready()) {
    return absl::ResourceExhaustedError(
        absl::StrCat("Embree cannot take the surface: error ", static_cast<int>(error)));
  }
  LitPixels pixels(width, height);
  ParallelFor(height, 1, [&](int64_t begin, int64_t end) {
    for (auto y = static_cast<int>(begin); y < static_cast<int>(end); ++y) {
      for (int x = 0; x < width; ++x) {
        pixels.at(x, y) = CastPixel(scene, x, y, width, height, style.samples);
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
