#ifndef CLEAVE_CORE_MESH_SURFACE_DISTANCE_H_
#define CLEAVE_CORE_MESH_SURFACE_DISTANCE_H_

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// How far a point is from a shape, and where from.
struct SignedDistance {
  double value = 0;        // m, negative inside
  Eigen::Vector3d normal;  // unit gradient of value; any of the steepest where there are several
};

// The point of a surface that is closest to some point.
struct SurfacePoint {
  int32_t triangle = 0;
  std::array<double, 3> weights = {1, 0, 0};  // of its corners; they add up to 1
  double distance = 0;                        // m, >= 0
};

// Signed distance to a closed triangle surface. Which side a point is on follows from the
// angle-weighted mean normal at the closest point, which is right on faces, edges and vertices
// alike. Source: Baerentzen and Aanaes, "Signed distance computation using the angle weighted
// pseudonormal", 2005. Immutable; any thread may ask.
class SurfaceDistance {
 public:
  // Preconditions: at least one triangle, ids of vertices within range, finite coordinates.
  SurfaceDistance(const std::vector<Vec3>& vertices,
                  const std::vector<std::array<int32_t, 3>>& triangles);

  SignedDistance At(const Eigen::Vector3d& point) const;
  // The surface need not be closed for this. Of triangles that are as near the first counts, so
  // that leaving others out changes nothing.
  SurfacePoint ClosestPoint(const Eigen::Vector3d& point) const;

  int64_t bytes() const { return BytesOf(triangles_.size()); }
  static int64_t BytesOf(size_t triangles) {
    return static_cast<int64_t>(triangles * (sizeof(Triangle) + 2 * sizeof(Node)));
  }

 private:
  // A box round triangles: of the leaf [begin, end), or of the two nodes after it and at `end`.
  struct Node {
    Eigen::Vector3d low, high;
    int32_t begin = 0;
    int32_t end = 0;
    int32_t right = -1;  // -1: a leaf
  };
  struct Triangle {
    int32_t id = 0;
    std::array<Eigen::Vector3d, 3> corners;
    // Of the face, of the edges from each corner to the next, and of the corners.
    Eigen::Vector3d face;
    std::array<Eigen::Vector3d, 3> edges;
    std::array<Eigen::Vector3d, 3> vertices;
  };
  struct Closest {
    double squared;
    Eigen::Vector3d point;
    Eigen::Vector3d normal;
    const Triangle* triangle = nullptr;
    double second = 0, third = 0;  // weights of those corners
  };

  int32_t Build(int32_t begin, int32_t end);
  void Search(int32_t node, const Eigen::Vector3d& point, Closest& best) const;
  static void Test(const Triangle& triangle, const Eigen::Vector3d& point, Closest& best);

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

// Whether any of the points is at most `reach` (m) from the surface. Preconditions as of
// SurfaceDistance.
bool SurfaceReaches(const std::vector<Vec3>& vertices,
                    const std::vector<std::array<int32_t, 3>>& triangles, double reach,
                    const std::vector<Vec3>& points);

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_SURFACE_DISTANCE_H_
