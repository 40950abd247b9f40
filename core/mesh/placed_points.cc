#include "core/mesh/placed_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/base/counter_rng.h"

namespace cleave {
namespace {

constexpr double kLeastDistance = 0.7;  // cell sizes
constexpr double kLeastDepth = 0.5;     // cell sizes, of inner points
// Darts for each cube or square of the least distance; nine tenths of what could be placed is.
constexpr double kDartsPerCell = 20;

class Placer {
 public:
  Placer(const Body& body, double cell_size, uint64_t seed)
      : body_(body), cell_(cell_size), least_(kLeastDistance * cell_size), seed_(seed) {
    const double reach = body.outer_radius;
    low_ = body.round ? Vec3{-reach, -reach, 0} : Vec3{0, 0, 0};
    extent_ = body.round ? Vec3{2 * reach, 2 * reach, body.size[2]} : body.size;
    int64_t bins = 1;
    for (size_t axis = 0; axis < 3; ++axis) {
      bins_[axis] = static_cast<int64_t>(extent_[axis] / least_) + 1;
      bins *= bins_[axis];
    }
    heads_.assign(static_cast<size_t>(bins), -1);
  }

  PlacedPoints Place() {
    body_.round ? PlaceOnRound() : PlaceOnBox();
    PlaceInside();
    return std::move(points_);
  }

 private:
  double Draw() { return UniformDraw(seed_, RandomStream::kMeshJitter, draws_++, 4); }

  std::array<int64_t, 3> BinOf(const Vec3& p) const {
    std::array<int64_t, 3> bin;
    for (size_t axis = 0; axis < 3; ++axis) {
      bin[axis] = std::clamp(static_cast<int64_t>((p[axis] - low_[axis]) / least_), int64_t{0},
                             bins_[axis] - 1);
    }
    return bin;
  }
  size_t IndexOf(const std::array<int64_t, 3>& bin) const {
    return static_cast<size_t>((bin[0] * bins_[1] + bin[1]) * bins_[2] + bin[2]);
  }

  void Keep(const Vec3& p, const Binding& binding) {
    int32_t& head = heads_[IndexOf(BinOf(p))];
    next_.push_back(head);
    head = static_cast<int32_t>(points_.positions.size());
    points_.positions.push_back(p);
    points_.bindings.push_back(binding);
  }

  bool IsFree(const Vec3& p) const {
    const std::array<int64_t, 3> bin = BinOf(p);
    std::array<int64_t, 3> at;
    for (at[0] = std::max(bin[0] - 1, int64_t{0}); at[0] <= std::min(bin[0] + 1, bins_[0] - 1);
         ++at[0]) {
      for (at[1] = std::max(bin[1] - 1, int64_t{0}); at[1] <= std::min(bin[1] + 1, bins_[1] - 1);
           ++at[1]) {
        for (at[2] = std::max(bin[2] - 1, int64_t{0}); at[2] <= std::min(bin[2] + 1, bins_[2] - 1);
             ++at[2]) {
          for (int32_t other = heads_[IndexOf(at)]; other >= 0;
               other = next_[static_cast<size_t>(other)]) {
            const Vec3& q = points_.positions[static_cast<size_t>(other)];
            const double dx = p[0] - q[0];
            const double dy = p[1] - q[1];
            const double dz = p[2] - q[2];
            if (dx * dx + dy * dy + dz * dz < least_ * least_) return false;
          }
        }
      }
    }
    return true;
  }

  // Throws darts at a side or volume that holds `measure` squares or cubes of the least distance.
  template <typename Dart>
  void Throw(double measure, const Binding& binding, const Dart& dart) {
    const auto darts = static_cast<int64_t>(kDartsPerCell * measure) + 20;
    for (int64_t i = 0; i < darts; ++i) {
      const Vec3 p = dart();
      if (IsFree(p)) Keep(p, binding);
    }
  }

  void PlaceOnBox() {
    const Vec3& size = body_.size;
    for (int corner = 0; corner < 8; ++corner) {
      Keep({corner & 1 ? size[0] : 0, corner & 2 ? size[1] : 0, corner & 4 ? size[2] : 0}, {7, 0});
    }
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t u = (axis + 1) % 3;
      const size_t v = (axis + 2) % 3;
      const int64_t steps = CellsAlong(size[axis], cell_, 1);
      for (int edge = 0; edge < 4; ++edge) {
        for (int64_t step = 1; step < steps; ++step) {
          Vec3 p;
          p[axis] = size[axis] * static_cast<double>(step) / static_cast<double>(steps);
          p[u] = edge & 1 ? size[u] : 0;
          p[v] = edge & 2 ? size[v] : 0;
          Keep(p, {static_cast<uint8_t>(7 ^ (1 << axis)), 0});
        }
      }
    }
    for (size_t axis = 0; axis < 3; ++axis) {
      const size_t u = (axis + 1) % 3;
      const size_t v = (axis + 2) % 3;
      for (const double level : {0.0, size[axis]}) {
        Throw(size[u] * size[v] / (least_ * least_), {static_cast<uint8_t>(1 << axis), 0}, [&] {
          Vec3 p;
          p[axis] = level;
          p[u] = size[u] * Draw();
          p[v] = size[v] * Draw();
          return p;
        });
      }
    }
  }

  void PlaceOnRound() {
    constexpr uint8_t kZ = 4;
    const double height = body_.size[2];
    const double inner = body_.inner_radius;
    const double outer = body_.outer_radius;
    const auto on_circle = [](double radius, double angle, double z) {
      return Vec3{radius * std::cos(angle), radius * std::sin(angle), z};
    };
    for (const double radius : {inner, outer}) {
      if (radius == 0) continue;
      const int64_t steps = CellsAlong(2 * std::numbers::pi * radius, cell_, 6);
      for (const double z : {0.0, height}) {
        const double phase = Draw();
        for (int64_t step = 0; step < steps; ++step) {
          const double turn = (static_cast<double>(step) + phase) / static_cast<double>(steps);
          Keep(on_circle(radius, 2 * std::numbers::pi * turn, z), {kZ, radius});
        }
      }
    }
    for (const double radius : {inner, outer}) {
      if (radius == 0) continue;
      Throw(2 * std::numbers::pi * radius * height / (least_ * least_), {0, radius}, [&] {
        const double angle = 2 * std::numbers::pi * Draw();
        return on_circle(radius, angle, height * Draw());
      });
    }
    for (const double z : {0.0, height}) {
      Throw(std::numbers::pi * (outer * outer - inner * inner) / (least_ * least_), {kZ, 0}, [&] {
        const double angle = 2 * std::numbers::pi * Draw();
        const double share = Draw();
        return on_circle(std::sqrt(inner * inner + share * (outer * outer - inner * inner)), angle,
                         z);
      });
    }
  }

  void PlaceInside() {
    const double depth = kLeastDepth * cell_;
    const double cube = least_ * least_ * least_;
    if (!body_.round) {
      Vec3 room;
      for (size_t axis = 0; axis < 3; ++axis) room[axis] = body_.size[axis] - 2 * depth;
      if (*std::min_element(room.begin(), room.end()) <= 0) return;
      Throw(room[0] * room[1] * room[2] / cube, {}, [&] {
        return Vec3{depth + room[0] * Draw(), depth + room[1] * Draw(), depth + room[2] * Draw()};
      });
      return;
    }
    const double inner = body_.inner_radius > 0 ? body_.inner_radius + depth : 0;
    const double outer = body_.outer_radius - depth;
    const double room = body_.size[2] - 2 * depth;
    if (outer <= inner || room <= 0) return;
    const double ring = outer * outer - inner * inner;
    Throw(std::numbers::pi * ring * room / cube, {}, [&] {
      const double angle = 2 * std::numbers::pi * Draw();
      const double radius = std::sqrt(inner * inner + ring * Draw());
      const double z = depth + room * Draw();
      return Vec3{radius * std::cos(angle), radius * std::sin(angle), z};
    });
  }

  const Body& body_;
  const double cell_;
  const double least_;
  const uint64_t seed_;
  uint64_t draws_ = 0;
  Vec3 low_;
  Vec3 extent_;
  std::array<int64_t, 3> bins_;
  std::vector<int32_t> heads_;  // the last point kept in a bin, or -1
  std::vector<int32_t> next_;   // the one kept before it
  PlacedPoints points_;
};

}  // namespace

Vec3 Bound(const Binding& binding, const Vec3& from, const Vec3& to) {
  Vec3 moved = to;
  for (size_t axis = 0; axis < 3; ++axis) {
    if (binding.fixed_axes >> axis & 1) moved[axis] = from[axis];
  }
  if (binding.radius > 0) {
    const double radius = std::hypot(moved[0], moved[1]);
    if (radius == 0) return from;
    moved[0] *= binding.radius / radius;
    moved[1] *= binding.radius / radius;
  }
  return moved;
}

PlacedPoints PlacePoints(const Body& body, double cell_size, uint64_t seed) {
  return Placer(body, cell_size, seed).Place();
}

}  // namespace cleave
