#include "core/mesh/plane_grid.h"

#include <algorithm>
#include <cmath>

namespace cleave {
namespace {

Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double Dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 Unit(Vec3 v) {
  // Scaled first, so that squares neither overflow nor vanish.
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  for (double& x : v) x /= largest;
  const double length = std::sqrt(Dot(v, v));
  for (double& x : v) x /= length;
  return v;
}

}  // namespace

PlaneView::PlaneView(const Vec3& direction) : unit_(Unit(direction)) {
  size_t least = 0;
  for (size_t i = 1; i < 3; ++i) {
    if (std::abs(unit_[i]) < std::abs(unit_[least])) least = i;
  }
  Vec3 aside{0, 0, 0};
  aside[least] = 1;
  right_ = Unit(Cross(aside, unit_));
  up_ = Cross(unit_, right_);
}

Vec2 PlaneView::Across(const Vec3& point) const { return {Dot(right_, point), Dot(up_, point)}; }

double PlaneView::Along(const Vec3& point) const { return Dot(unit_, point); }

void PlaneBox::Add(const Vec2& point) {
  for (size_t i = 0; i < 2; ++i) {
    min[i] = std::min(min[i], point[i]);
    max[i] = std::max(max[i], point[i]);
  }
}

void PlaneBox::Grow(double margin) {
  for (size_t i = 0; i < 2; ++i) {
    min[i] -= margin;
    max[i] += margin;
  }
}

PlaneBox BoxOf(const Vec2& a, const Vec2& b) {
  PlaneBox box{a, a};
  box.Add(b);
  return box;
}

PlaneGrid::PlaneGrid(std::span<const PlaneBox> boxes) {
  if (boxes.empty()) return;
  all_ = boxes[0];
  double side = 0;
  for (const PlaneBox& box : boxes) {
    all_.Add(box.min);
    all_.Add(box.max);
    side += std::max(box.max[0] - box.min[0], box.max[1] - box.min[1]);
  }
  // About a box a cell, and at most four cells a box.
  const Vec2 size = {all_.max[0] - all_.min[0], all_.max[1] - all_.min[1]};
  const double count = static_cast<double>(boxes.size());
  cell_ = std::max({side / count, std::sqrt(size[0] * size[1] / (4 * count)),
                    std::max(size[0], size[1]) / (4 * count)});
  for (size_t i = 0; i < 2; ++i)
    counts_[i] = cell_ > 0 ? static_cast<int64_t>(size[i] / cell_) + 1 : 1;
  const auto for_each_cell = [&](const PlaneBox& box, const auto& file) {
    const auto [left, right] = Cells(0, box);
    const auto [bottom, top] = Cells(1, box);
    for (int64_t y = bottom; y <= top; ++y) {
      for (int64_t x = left; x <= right; ++x) file(static_cast<size_t>(y * counts_[0] + x));
    }
  };
  offsets_.assign(static_cast<size_t>(counts_[0] * counts_[1]) + 1, 0);
  for (const PlaneBox& box : boxes) for_each_cell(box, [&](size_t cell) { ++offsets_[cell + 1]; });
  for (size_t cell = 1; cell < offsets_.size(); ++cell) offsets_[cell] += offsets_[cell - 1];
  items_.resize(static_cast<size_t>(offsets_.back()));
  std::vector<int64_t> next(offsets_.begin(), offsets_.end() - 1);
  for (size_t id = 0; id < boxes.size(); ++id) {
    for_each_cell(boxes[id], [&](size_t cell) {
      items_[static_cast<size_t>(next[cell]++)] = static_cast<int32_t>(id);
    });
  }
}

std::array<int64_t, 2> PlaneGrid::Cells(size_t axis, const PlaneBox& box) const {
  if (box.max[axis] < all_.min[axis] || box.min[axis] > all_.max[axis]) return {0, -1};
  const auto last = static_cast<double>(counts_[axis] - 1);
  const auto cell = [&](double at) {
    if (cell_ <= 0) return int64_t{0};
    return static_cast<int64_t>(std::clamp(std::floor((at - all_.min[axis]) / cell_), 0.0, last));
  };
  return {cell(box.min[axis]), cell(box.max[axis])};
}

}  // namespace cleave
