#ifndef CLEAVE_CORE_PICTURE_LIT_SCENE_H_
#define CLEAVE_CORE_PICTURE_LIT_SCENE_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/picture/camera.h"
#include "core/picture/render.h"
#include "core/picture/shown_surface.h"

struct RTCDeviceTy;
struct RTCSceneTy;
struct RTCRayHit;

namespace cleave {

// What a camera ray meets.
struct Hit {
  Eigen::Vector3f position = Eigen::Vector3f::Zero();       // m, from the middle of the scene
  Eigen::Vector3f shadow_origin = Eigen::Vector3f::Zero();  // m, where rays to the sun start
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();         // geometric, towards the camera
  Eigen::Vector3f shading = Eigen::Vector3f::Zero();        // smoothed
  Eigen::Vector3f albedo = Eigen::Vector3f::Zero();         // linear
  Eigen::Vector3f glow = Eigen::Vector3f::Zero();           // seen whatever the light: backdrop
  float distance = 0;                                       // m
  float gloss = 0;
  float lit = 1;  // how much of the light counts; 0: all backdrop
};

// A surface and props in their colours, ready for rays from anywhere: what the pictures of one
// frame share. Const methods are thread-safe.
class LitSolids {
 public:
  // Places are kept in single precision, which is enough about `origin`, the middle of what is
  // seen. `device` and the surfaces must outlive this object. Precondition: the surfaces passed
  // CheckShownSurface, the style fits the first.
  LitSolids(RTCDeviceTy* device, const ShownSurface& surface, const ShownSurface& props,
            const Vec3& origin, const RenderStyle& style);
  ~LitSolids();
  LitSolids(const LitSolids&) = delete;
  LitSolids& operator=(const LitSolids&) = delete;

  // Whether there was memory for the surfaces.
  bool ready() const { return ready_; }

  const Vec3& origin() const { return origin_; }  // m
  Eigen::Vector3f Local(const Vec3& point) const;

  // The first that a ray from `eye` meets, if anything.
  bool Meets(const Eigen::Vector3f& eye, const Eigen::Vector3f& direction, Hit& hit) const;
  // Whether a ray meets anything.
  bool Blocks(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;

 private:
  // A surface and how it looks.
  struct Solid {
    explicit Solid(const ShownSurface& of);

    const ShownSurface& surface;
    std::vector<std::array<Eigen::Vector3f, 3>> normals;  // of corners, a triangle each
    std::vector<Eigen::Vector3f> colors;                  // a triangle each
    std::vector<Eigen::Vector3f> point_colors;            // a point each; strain and impurity only
  };

  void BuildColors(const RenderStyle& style);
  void BuildGeometry(RTCDeviceTy* device, const Solid& solid, uint32_t id);
  Hit SurfaceHit(const Eigen::Vector3f& eye, const Eigen::Vector3f& direction,
                 const RTCRayHit& ray) const;

  Solid body_, props_;  // geometries 0 and 1
  RTCSceneTy* scene_ = nullptr;
  bool ready_ = true;
  const Vec3 origin_;  // all that is single counts from it
};

// Solids on a plain ground under a soft sun and a sky, seen by a camera. Const methods are
// thread-safe. Colours and light are linear; open level ground receives a light of 1.
class LitScene {
 public:
  // `solids` must outlive this object.
  LitScene(const LitSolids& solids, const Camera& camera);

  // What the camera sees at a place of its picture, x and y in [-1, 1], to the right and up.
  Hit Trace(float x, float y) const;

  // Light that reaches `hit`, by rays of place `sample` in their sequence, and the shine that the
  // sun leaves on it.
  Eigen::Vector3f Irradiance(const Hit& hit, uint32_t sample, float& shine) const;

 private:
  bool Blocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction) const;
  Eigen::Vector3f Sky(const Eigen::Vector3f& direction) const;
  Hit GroundHit(const Eigen::Vector3f& direction) const;

  const LitSolids& solids_;
  const Eigen::Vector3f eye_, right_, up_, forward_;  // right and up scaled by the view
  const float radius_;                                // m
  const Eigen::Vector3f ground_up_;
  const float ground_height_;  // m
  const float offset_;         // m, from a surface to the start of a ray that leaves it
  Eigen::Vector3f sun_;        // towards it
  float sun_strength_ = 0;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_PICTURE_LIT_SCENE_H_
