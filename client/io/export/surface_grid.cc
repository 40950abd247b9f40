#include "client/io/export/surface_grid.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/picture/shown_surface.h"

namespace cleave {
namespace {

// Points of a surface that has texture coordinates, as a grid holds them.
class TexturedPoints {
 public:
  explicit TexturedPoints(const ShownSurface& surface)
      : uvs_(surface.points.size(), {0, 0}), taken_(surface.points.size(), false) {
    corners_.reserve(3 * surface.triangles.size());
    for (size_t point = 0; point < surface.points.size(); ++point)
      points_.push_back(static_cast<int32_t>(point));
    for (size_t i = 0; i < surface.triangles.size(); ++i) {
      for (size_t k = 0; k < 3; ++k) {
        const int32_t point = surface.triangles[i][k];
        corners_.push_back(surface.inside[i] != 0 ? point : Of(point, surface.uvs[i][k]));
      }
    }
  }

  // Point ids of the grid, of all triangles end to end.
  std::vector<int64_t> TakeCorners() { return std::move(corners_); }

  VtuArray Uvs() const {
    std::vector<float> flat;
    flat.reserve(2 * uvs_.size());
    for (const auto& uv : uvs_) flat.insert(flat.end(), uv.begin(), uv.end());
    VtuArray array = MakeVtuArray<float>("uv", flat);
    array.components = 2;
    return array;
  }

  // What the surface knows of its points, of the grid's.
  template <typename T>
  std::vector<T> Spread(const std::vector<T>& values) const {
    std::vector<T> spread;
    spread.reserve(points_.size());
    for (const int32_t point : points_) spread.push_back(values[static_cast<size_t>(point)]);
    return spread;
  }

 private:
  // The first texture coordinates of a point are its own; others get a copy each.
  int64_t Of(int32_t point, const std::array<float, 2>& uv) {
    const auto p = static_cast<size_t>(point);
    if (!taken_[p]) {
      taken_[p] = true;
      uvs_[p] = uv;
    }
    if (uvs_[p] == uv) return point;
    const auto [copy, is_new] =
        copies_.try_emplace({point, uv[0], uv[1]}, static_cast<int64_t>(points_.size()));
    if (is_new) {
      points_.push_back(point);
      uvs_.push_back(uv);
    }
    return copy->second;
  }

  std::vector<int32_t> points_;  // the surface's point, a point of the grid each
  std::vector<std::array<float, 2>> uvs_;
  std::vector<bool> taken_;
  std::map<std::tuple<int32_t, float, float>, int64_t> copies_;
  std::vector<int64_t> corners_;
};

std::vector<int32_t> PointPieces(const ShownSurface& surface) {
  std::vector<int32_t> pieces(surface.points.size(), -1);
  for (size_t i = 0; i < surface.triangles.size(); ++i) {
    for (const int32_t point : surface.triangles[i]) {
      pieces[static_cast<size_t>(point)] = surface.pieces[i];
    }
  }
  return pieces;
}

}  // namespace

VtuGrid SurfaceGrid(const SurfaceSequence& sequence) {
  const ShownSurface& surface = sequence.surface();
  std::optional<TexturedPoints> textured;
  if (!surface.uvs.empty()) textured.emplace(surface);
  const auto of_points = [&](const auto& values) {
    return textured ? textured->Spread(values) : values;
  };
  VtuGrid grid;
  grid.time = surface.time;
  grid.points = of_points(surface.points);
  for (const auto& triangle : surface.triangles) {
    grid.connectivity.insert(grid.connectivity.end(), triangle.begin(), triangle.end());
    grid.offsets.push_back(static_cast<int64_t>(grid.connectivity.size()));
  }
  grid.types.assign(surface.triangles.size(), kVtuTriangle);
  grid.point_data.push_back(MakeVtuArray<int32_t>("piece", of_points(PointPieces(surface))));
  grid.point_data.push_back(MakeVtuArray<uint64_t>("id", of_points(sequence.topology().point_ids)));
  grid.point_data.push_back(MakeVtuVectors("rest", of_points(surface.rest_points)));
  grid.point_data.push_back(MakeVtuVectors("displacement", of_points(surface.displacements)));
  if (!surface.velocities.empty()) {
    grid.point_data.push_back(MakeVtuVectors("velocity", of_points(surface.velocities)));
  }
  if (!surface.strains.empty()) {
    grid.point_data.push_back(MakeVtuArray<float>("strain", of_points(surface.strains)));
  }
  grid.point_data.push_back(MakeVtuArray<float>("damage", of_points(surface.damages)));
  if (!surface.potencies.empty()) {
    grid.point_data.push_back(MakeVtuArray<float>("potency", of_points(surface.potencies)));
  }
  if (textured) {
    grid.connectivity = textured->TakeCorners();
    grid.point_data.push_back(textured->Uvs());
    grid.texture_coordinates = "uv";
  }
  grid.cell_data.push_back(MakeVtuArray<uint64_t>("id", sequence.topology().triangle_ids));
  grid.cell_data.push_back(MakeVtuArray<int32_t>("piece", surface.pieces));
  grid.cell_data.push_back(MakeVtuArray<int32_t>("region", surface.regions));
  grid.cell_data.push_back(MakeVtuArray<uint8_t>("inside", surface.inside));
  grid.cell_data.push_back(MakeVtuArray<int32_t>("tet", sequence.topology().tets));
  grid.cell_data.push_back(MakeVtuArray<int64_t>("source", surface.sources));
  return grid;
}

}  // namespace cleave
