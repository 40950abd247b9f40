#include "core/surface/tet_locator.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace cleave {
namespace {

using Eigen::Vector3d;

constexpr int32_t kMaxCells = 128;  // along an axis
constexpr double kMargin = 1e-6;    // of a cell: more than kWeightSlack of any tet in it

Vector3d At(const Vec3& place) { return Vector3d(place.data()); }

// Source: Ericson, Real-Time Collision Detection, 5.1.5.
double SquaredDistance(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return ap.squaredNorm();
  const Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return bp.squaredNorm();
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return (ap - d1 / (d1 - d3) * ab).squaredNorm();
  const Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return cp.squaredNorm();
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return (ap - d2 / (d2 - d6) * ac).squaredNorm();
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
    return (bp - (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b)).squaredNorm();
  const double sum = va + vb + vc;
  return (ap - vb / sum * ab - vc / sum * ac).squaredNorm();
}

}  // namespace

TetLocator::TetLocator(const TetMesh& mesh, const Faces& faces) : mesh_(mesh), faces_(faces) {
  Vector3d low = At(mesh.rest_positions[static_cast<size_t>(mesh.tets[0][0])]);
  Vector3d high = low;
  for (const auto& tet : mesh.tets) {
    for (const int32_t node : tet) {
      low = low.cwiseMin(At(mesh.rest_positions[static_cast<size_t>(node)]));
      high = high.cwiseMax(At(mesh.rest_positions[static_cast<size_t>(node)]));
    }
  }
  const Vector3d extent = high - low;
  diagonal_ = extent.norm();
  const double volume = std::max(extent.prod(), 0.0);
  cell_size_ = std::cbrt(volume / static_cast<double>(mesh.tets.size())) * 1.5;
  cell_size_ = std::max(cell_size_, extent.maxCoeff() / kMaxCells);
  if (!(cell_size_ > 0)) cell_size_ = 1;
  for (size_t axis = 0; axis < 3; ++axis) {
    origin_[axis] = low[static_cast<Eigen::Index>(axis)];
    counts_[axis] =
        std::clamp(static_cast<int32_t>(extent[static_cast<Eigen::Index>(axis)] / cell_size_) + 1,
                   1, kMaxCells);
  }
  cell_tets_ =
      Fill(mesh.tet_count(), [&](int64_t tet) { return mesh.tets[static_cast<size_t>(tet)]; });
  cell_faces_ = Fill(static_cast<int64_t>(faces.boundary.size()), [&](int64_t item) {
    const TetFace& side = faces.boundary[static_cast<size_t>(item)];
    std::array<int32_t, 3> nodes{};
    for (size_t i = 0; i < 3; ++i) {
      const auto vertex = static_cast<size_t>(kTetFaces[static_cast<size_t>(side.face)][i]);
      nodes[i] = mesh.tets[static_cast<size_t>(side.tet)][vertex];
    }
    return nodes;
  });
}

std::array<int32_t, 3> TetLocator::CellOf(const Vec3& point) const {
  std::array<int32_t, 3> cell{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const double place = std::floor((point[axis] - origin_[axis]) / cell_size_);
    cell[axis] =
        static_cast<int32_t>(std::clamp(place, 0.0, static_cast<double>(counts_[axis] - 1)));
  }
  return cell;
}

template <typename Visit>
void TetLocator::ForCellsOf(const int32_t* nodes, size_t count, const Visit& visit) const {
  Vec3 least = mesh_.rest_positions[static_cast<size_t>(nodes[0])];
  Vec3 most = least;
  for (size_t i = 1; i < count; ++i) {
    const Vec3& at = mesh_.rest_positions[static_cast<size_t>(nodes[i])];
    for (size_t axis = 0; axis < 3; ++axis) {
      least[axis] = std::min(least[axis], at[axis]);
      most[axis] = std::max(most[axis], at[axis]);
    }
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    least[axis] -= kMargin * cell_size_;
    most[axis] += kMargin * cell_size_;
  }
  const std::array<int32_t, 3> low = CellOf(least);
  const std::array<int32_t, 3> high = CellOf(most);
  for (int32_t z = low[2]; z <= high[2]; ++z) {
    for (int32_t y = low[1]; y <= high[1]; ++y) {
      for (int32_t x = low[0]; x <= high[0]; ++x) visit(IndexOf({x, y, z}));
    }
  }
}

template <typename Nodes>
Csr TetLocator::Fill(int64_t items, const Nodes& nodes_of) const {
  Csr cells;
  cells.offsets.assign(static_cast<size_t>(counts_[0]) * static_cast<size_t>(counts_[1]) *
                               static_cast<size_t>(counts_[2]) +
                           1,
                       0);
  const auto for_each = [&](const auto& visit) {
    for (int64_t item = 0; item < items; ++item) {
      const auto nodes = nodes_of(item);
      ForCellsOf(nodes.data(), nodes.size(), [&](int64_t cell) {
        visit(static_cast<size_t>(cell), static_cast<int32_t>(item));
      });
    }
  };
  for_each([&](size_t cell, int32_t) { ++cells.offsets[cell + 1]; });
  for (size_t cell = 1; cell < cells.offsets.size(); ++cell)
    cells.offsets[cell] += cells.offsets[cell - 1];
  cells.items.resize(static_cast<size_t>(cells.offsets.back()));
  std::vector<int32_t> next(cells.offsets.begin(), cells.offsets.end() - 1);
  for_each(
      [&](size_t cell, int32_t item) { cells.items[static_cast<size_t>(next[cell]++)] = item; });
  return cells;
}

std::array<double, 4> TetLocator::Weights(int32_t tet, const Vec3& point) const {
  const auto& nodes = mesh_.tets[static_cast<size_t>(tet)];
  const Vector3d a = At(mesh_.rest_positions[static_cast<size_t>(nodes[0])]);
  Eigen::Matrix3d edges;
  for (size_t k = 1; k < 4; ++k)
    edges.col(static_cast<Eigen::Index>(k) - 1) =
        At(mesh_.rest_positions[static_cast<size_t>(nodes[k])]) - a;
  const Vector3d d = At(point) - a;
  const double volume = edges.col(0).cross(edges.col(1)).dot(edges.col(2));
  std::array<double, 4> weights{};
  weights[1] = d.cross(edges.col(1)).dot(edges.col(2)) / volume;
  weights[2] = edges.col(0).cross(d).dot(edges.col(2)) / volume;
  weights[3] = edges.col(0).cross(edges.col(1)).dot(d) / volume;
  weights[0] = 1 - weights[1] - weights[2] - weights[3];
  return weights;
}

PlaceInTet TetLocator::Locate(const Vec3& point) const {
  const std::array<int32_t, 3> home = CellOf(point);
  for (const int32_t tet : cell_tets_[IndexOf(home)]) {  // ascending
    const std::array<double, 4> weights = Weights(tet, point);
    if (*std::min_element(weights.begin(), weights.end()) >= -kWeightSlack) return {tet, weights};
  }
  // Cells around the home one, ring by ring, until none further off can hold a nearer face.
  const double slack = kDistanceSlack * diagonal_;
  double nearest = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, int32_t>> near;  // distances (m) and tets
  const int32_t rings = *std::max_element(counts_.begin(), counts_.end());
  for (int32_t ring = 0; ring <= rings; ++ring) {
    if (nearest + slack <= (ring - 1) * cell_size_) break;
    for (int32_t z = std::max(0, home[2] - ring); z <= std::min(counts_[2] - 1, home[2] + ring);
         ++z) {
      for (int32_t y = std::max(0, home[1] - ring); y <= std::min(counts_[1] - 1, home[1] + ring);
           ++y) {
        for (int32_t x = std::max(0, home[0] - ring); x <= std::min(counts_[0] - 1, home[0] + ring);
             ++x) {
          if (std::max({std::abs(x - home[0]), std::abs(y - home[1]), std::abs(z - home[2])}) !=
              ring)
            continue;
          for (const int32_t item : cell_faces_[IndexOf({x, y, z})]) {
            const TetFace& side = faces_.boundary[static_cast<size_t>(item)];
            std::array<Vector3d, 3> corners;
            for (size_t i = 0; i < 3; ++i) {
              const auto vertex = static_cast<size_t>(kTetFaces[static_cast<size_t>(side.face)][i]);
              const int32_t node = mesh_.tets[static_cast<size_t>(side.tet)][vertex];
              corners[i] = At(mesh_.rest_positions[static_cast<size_t>(node)]);
            }
            const double distance =
                std::sqrt(SquaredDistance(At(point), corners[0], corners[1], corners[2]));
            if (distance > nearest + slack) continue;
            nearest = std::min(nearest, distance);
            near.emplace_back(distance, side.tet);
          }
        }
      }
    }
  }
  PlaceInTet place{std::numeric_limits<int32_t>::max(), {}};
  for (const auto& [distance, tet] : near) {
    if (distance <= nearest + slack) place.tet = std::min(place.tet, tet);
  }
  place.weights = Weights(place.tet, point);
  return place;
}

}  // namespace cleave
