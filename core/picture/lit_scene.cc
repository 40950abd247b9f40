#include "core/picture/lit_scene.h"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "core/picture/palette.h"
#include "core/picture/sampling.h"
#include "core/picture/surface_normals.h"

namespace cleave {
namespace {

using Eigen::Vector3f;

// Unshadowed level ground receives 1: this much from the sun, the rest from the sky.
constexpr float kSunShare = 0.66f;
constexpr float kSunSpread = 0.10f;  // radius of the sun's disc at distance 1: how soft shadows are
constexpr int kSkyRays = 2;          // a camera ray
const Vector3f kSkyTint(0.93f, 0.97f, 1.06f);
const Vector3f kSunTint(1.04f, 1.0f, 0.94f);
const Vector3f kGroundAlbedo(0.80f, 0.805f, 0.81f);
const Vector3f kPropAlbedo(0.21f, 0.23f, 0.26f);  // steel
const Vector3f kBackdrop(0.88f, 0.89f, 0.90f);    // what the ground fades into far away

Vector3f ToFloat(const Vec3& v) {
  return Vector3f(static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2]));
}

double Dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

float ToLinear(float s) {
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}
Vector3f ToLinear(const Color& c) { return {ToLinear(c[0]), ToLinear(c[1]), ToLinear(c[2])}; }

void SetRay(const Vector3f& origin, const Vector3f& direction, RTCRay& ray) {
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

}  // namespace

LitSolids::Solid::Solid(const ShownSurface& of) : surface(of), normals(CornerNormals(of)) {}

LitSolids::LitSolids(RTCDeviceTy* device, const ShownSurface& surface, const ShownSurface& props,
                     const Vec3& origin, const RenderStyle& style)
    : body_(surface), props_(props), origin_(origin) {
  BuildColors(style);
  scene_ = rtcNewScene(device);
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  BuildGeometry(device, body_, 0);
  BuildGeometry(device, props_, 1);
  rtcCommitScene(scene_);
}

LitSolids::~LitSolids() { rtcReleaseScene(scene_); }

LitScene::LitScene(const LitSolids& solids, const Camera& camera)
    : solids_(solids),
      eye_(solids.Local(camera.position)),
      right_(ToFloat(camera.right) * static_cast<float>(camera.half_width)),
      up_(ToFloat(camera.up) * static_cast<float>(camera.half_height)),
      forward_(ToFloat(camera.forward)),
      radius_(static_cast<float>(camera.scene_radius)),
      ground_up_(ToFloat(camera.ground_normal)),
      // A hair below what stands on it, so that soles do not fight with it.
      ground_height_(
          static_cast<float>(camera.ground_height - Dot(camera.ground_normal, solids.origin())) -
          1e-3f * radius_),
      offset_(2e-4f * radius_) {
  // Over the camera's right shoulder: FrameCamera stands to the right of the square view, so that
  // the faces which it sees besides the front are lit, and shadows fall to the left and away.
  const Vector3f level = (forward_ - ground_up_ * ground_up_.dot(forward_)).normalized();
  const Vector3f side = ToFloat(camera.right);
  sun_ = (ground_up_ + 0.60f * side - 0.62f * level).normalized();
  sun_strength_ = kSunShare / std::max(sun_.dot(ground_up_), 0.1f);
}

Vector3f LitSolids::Local(const Vec3& point) const {
  return ToFloat({point[0] - origin_[0], point[1] - origin_[1], point[2] - origin_[2]});
}

void LitSolids::BuildGeometry(RTCDeviceTy* device, const Solid& solid, uint32_t id) {
  const ShownSurface& surface = solid.surface;
  if (surface.triangles.empty()) return;
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                             RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                                             surface.points.size()));
  auto* ids = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0,
                                                             RTC_FORMAT_UINT3, 3 * sizeof(uint32_t),
                                                             surface.triangles.size()));
  if (points == nullptr || ids == nullptr) {
    ready_ = false;
  } else {
    for (const Vec3& point : surface.points) {
      const Vector3f local = Local(point);
      points = std::copy_n(local.data(), 3, points);
    }
    for (const auto& triangle : surface.triangles) {
      for (const int32_t point : triangle) *ids++ = static_cast<uint32_t>(point);
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene_, geometry, id);
  }
  rtcReleaseGeometry(geometry);
}

Vector3f LitScene::Irradiance(const Hit& hit, uint32_t sample, float& shine) const {
  const auto place = Spread(sample, 1);
  const auto [t, s] = Tangents(sun_);
  const float r = kSunSpread * std::sqrt(place[0]);
  const float angle = 2 * std::numbers::pi_v<float> * place[1];
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
      light += Vector3f::Constant(0.13f / kSkyRays);  // light thrown back by what blocks
    } else {
      light += Sky(direction) / kSkyRays;
    }
  }
  return light;
}

Hit LitScene::Trace(float x, float y) const {
  const Vector3f direction = (forward_ + x * right_ + y * up_).normalized();
  Hit hit;
  if (solids_.Meets(eye_, direction, hit)) return hit;
  return GroundHit(direction);
}

bool LitScene::Blocked(const Vector3f& origin, const Vector3f& direction) const {
  // A ray that starts outside the scene's ball and leads away from it meets nothing.
  const Vector3f to_center = -origin;
  const float along = to_center.dot(direction);
  const float limit = 1.02f * radius_;
  const float apart = to_center.squaredNorm();
  if (apart > limit * limit && (along < 0 || apart - along * along > limit * limit)) return false;
  return solids_.Blocks(origin, direction);
}

bool LitSolids::Meets(const Vector3f& eye, const Vector3f& direction, Hit& hit) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRayHit ray{};
  SetRay(eye, direction, ray.ray);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(scene_, &context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
  hit = SurfaceHit(eye, direction, ray);
  return true;
}

bool LitSolids::Blocks(const Vector3f& origin, const Vector3f& direction) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray{};
  SetRay(origin, direction, ray);
  rtcOccluded1(scene_, &context, &ray);
  return ray.tfar < 0;
}

// Radiance times pi, so that an open level ground sums to 1 - kSunShare.
Vector3f LitScene::Sky(const Vector3f& direction) const {
  const float height = direction.dot(ground_up_);
  if (height < 0) return Vector3f::Constant(0.30f);  // the lit ground
  return (1 - kSunShare) * (0.82f + 0.27f * height) * kSkyTint;
}

void LitSolids::BuildColors(const RenderStyle& style) {
  const ShownSurface& surface = body_.surface;
  props_.colors.assign(props_.surface.triangles.size(), kPropAlbedo);
  if (style.color_by == ColorBy::kStrain) {
    body_.point_colors.reserve(surface.points.size());
    for (const float strain : surface.strains) {
      body_.point_colors.push_back(ToLinear(SequentialColor(strain / style.strain_limit)));
    }
    return;
  }
  if (style.color_by == ColorBy::kDamage) {
    body_.point_colors.reserve(surface.points.size());
    for (const float damage : surface.damages)
      body_.point_colors.push_back(ToLinear(SequentialColor(damage)));
    return;
  }
  if (style.color_by == ColorBy::kImpurity) {
    body_.point_colors.reserve(surface.points.size());
    for (const float impurity : surface.impurities)
      body_.point_colors.push_back(ToLinear(ImpurityColor(impurity)));
    return;
  }
  body_.colors.reserve(surface.triangles.size());
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    const bool inside = surface.inside[i] != 0;
    if (style.color_by == ColorBy::kPiece) {
      const Vector3f color = ToLinear(PieceColor(surface.pieces[i]));
      body_.colors.push_back(inside ? Vector3f(0.45f * color + Vector3f::Constant(0.42f)) : color);
    } else {
      const auto slot = style.region_slots.find(surface.regions[i]);
      const int32_t color = slot == style.region_slots.end() ? surface.regions[i] : slot->second;
      body_.colors.push_back(ToLinear(inside ? InsideColor(color) : RegionColor(color)));
    }
  }
}

Hit LitSolids::SurfaceHit(const Vector3f& eye, const Vector3f& direction,
                          const RTCRayHit& ray) const {
  const Solid& solid = ray.hit.geomID == 0 ? body_ : props_;
  const ShownSurface& surface = solid.surface;
  const size_t triangle = ray.hit.primID;
  const auto& ids = surface.triangles[triangle];
  const std::array<float, 3> weights = {1 - ray.hit.u - ray.hit.v, ray.hit.u, ray.hit.v};
  Hit hit;
  hit.distance = ray.ray.tfar;
  hit.position = eye + hit.distance * direction;
  hit.normal = Vector3f(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z).normalized();
  const float turn = hit.normal.dot(direction) > 0 ? -1.0f : 1.0f;
  hit.normal *= turn;
  Vector3f shading = Vector3f::Zero();
  // On coarse meshes the plain point would lie in the shadow of its own facets: it is moved out
  // to the tangent planes of the smoothed corners (Hanika 2021).
  hit.shadow_origin = hit.position;
  Vector3f color = Vector3f::Zero();
  for (size_t k = 0; k < 3; ++k) {
    const Vector3f normal = turn * solid.normals[triangle][k];
    shading += weights[k] * normal;
    const Vector3f corner = Local(surface.points[static_cast<size_t>(ids[k])]);
    const float below = std::min(0.0f, (hit.position - corner).dot(normal));
    hit.shadow_origin -= weights[k] * below * normal;
    if (!solid.point_colors.empty()) {
      color += weights[k] * solid.point_colors[static_cast<size_t>(ids[k])];
    }
  }
  const bool inside = surface.inside[triangle] != 0;
  hit.shading = shading.squaredNorm() > 1e-8f ? shading.normalized() : hit.normal;
  if (hit.shading.dot(direction) > 0) hit.shading = hit.normal;
  hit.albedo = solid.point_colors.empty() ? solid.colors[triangle] : color;
  hit.gloss = inside ? 0.02f : 0.10f;
  return hit;
}

Hit LitScene::GroundHit(const Vector3f& direction) const {
  Hit hit;
  hit.albedo = kGroundAlbedo;
  hit.glow = kBackdrop;
  hit.lit = 0;
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
  const float away = hit.position.norm() / radius_;
  const float t = std::clamp((away - 1.2f) / 4.5f, 0.0f, 1.0f);
  const float fade = t * t * (3 - 2 * t);
  hit.glow = fade * kBackdrop;
  hit.lit = 1 - fade;
  return hit;
}

}  // namespace cleave
