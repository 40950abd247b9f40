#ifndef CLEAVE_CORE_MESH_PLANE_GRID_H_
#define CLEAVE_CORE_MESH_PLANE_GRID_H_

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace cleave {

// Coordinates in a plane, m.
using Vec2 = std::array<double, 2>;

// What one sees looking along a direction: drops points into the plane across it.
class PlaneView {
 public:
  // Precondition: `direction` is finite and not 0; any length.
  explicit PlaneView(const Vec3& direction);
  Vec2 Across(const Vec3& point) const;
  double Along(const Vec3& point) const;  // m, by the unit direction

 private:
  Vec3 right_, up_, unit_;
};

struct PlaneBox {
  Vec2 min, max;
  void Add(const Vec2& point);
  void Grow(double margin);
};
PlaneBox BoxOf(const Vec2& a, const Vec2& b);

// Finds boxes in a plane by place: a uniform grid. Immutable; any thread may ask.
class PlaneGrid {
 public:
  explicit PlaneGrid(std::span<const PlaneBox> boxes);

  // Calls visit(id) for every box that meets `box`, and may for others and more than once.
  template <typename Visit>
  void Near(const PlaneBox& box, const Visit& visit) const {
    if (offsets_.size() < 2) return;
    const auto [left, right] = Cells(0, box);
    const auto [bottom, top] = Cells(1, box);
    for (int64_t y = bottom; y <= top; ++y) {
      for (int64_t x = left; x <= right; ++x) {
        const auto cell = static_cast<size_t>(y * counts_[0] + x);
        for (int64_t k = offsets_[cell]; k < offsets_[cell + 1]; ++k)
          visit(items_[static_cast<size_t>(k)]);
      }
    }
  }

 private:
  std::array<int64_t, 2> Cells(size_t axis, const PlaneBox& box) const;

  PlaneBox all_{};
  double cell_ = 0;
  std::array<int64_t, 2> counts_{0, 0};
  std::vector<int64_t> offsets_;
  std::vector<int32_t> items_;
};

}  // namespace cleave

#endif  // CLEAVE_CORE_MESH_PLANE_GRID_H_
