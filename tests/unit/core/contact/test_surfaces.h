#ifndef CLEAVE_TESTS_UNIT_CORE_CONTACT_TEST_SURFACES_H_
#define CLEAVE_TESTS_UNIT_CORE_CONTACT_TEST_SURFACES_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <utility>

#include "core/scene/scene.h"

namespace cleave {

// An octahedron, each of whose triangles was cut in four `times` times, on a sphere.
inline SurfaceShape SphereSurface(const Vec3& center, double radius, int times) {
  SurfaceShape surface;
  surface.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  surface.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int k = 0; k < times; ++k) {
    std::map<std::pair<int32_t, int32_t>, int32_t> middles;
    const auto middle = [&](int32_t a, int32_t b) {
      const auto [found, fresh] =
          middles.try_emplace(std::minmax(a, b), static_cast<int32_t>(surface.vertices.size()));
      if (fresh) {
        Vec3 sum{};
        for (size_t i = 0; i < 3; ++i) {
          sum[i] = surface.vertices[static_cast<size_t>(a)][i] +
                   surface.vertices[static_cast<size_t>(b)][i];
        }
        const double length = std::hypot(sum[0], sum[1], sum[2]);
        for (double& x : sum) x /= length;
        surface.vertices.push_back(sum);
      }
      return found->second;
    };
    std::vector<std::array<int32_t, 3>> finer;
    for (const auto& [a, b, c] : surface.triangles) {
      const int32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    surface.triangles = finer;
  }
  for (Vec3& vertex : surface.vertices) {
    for (size_t i = 0; i < 3; ++i) vertex[i] = center[i] + radius * vertex[i];
  }
  return surface;
}

// An axis-aligned box of twelve triangles.
inline SurfaceShape BoxSurface(const Vec3& center, const Vec3& size) {
  SurfaceShape surface;
  for (int k = 0; k < 8; ++k) {
    Vec3 vertex = center;
    for (size_t i = 0; i < 3; ++i) vertex[i] += ((k >> i & 1) - 0.5) * size[i];
    surface.vertices.push_back(vertex);
  }
  surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                       {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return surface;
}

}  // namespace cleave

#endif  // CLEAVE_TESTS_UNIT_CORE_CONTACT_TEST_SURFACES_H_
