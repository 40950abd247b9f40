#include <algorithm>
#include <cmath>
#include <cstddef>

#include "core/stream/stencils.h"

namespace cleave {

// Minimises the sum of w^2 (u^2 + 0.02) plus 10^4 |sum of w d|^2 / h for weights that add up to
// one, d being the offsets of the neighbours, h the largest |d|^2 and u = |d|^2 / h. Every
// operation is rounded by itself and in the order written, because decoders must get the same bits.
std::array<int32_t, kStencilNodes> StencilWeights(const Vec3& centre,
                                                  std::span<const Vec3> neighbours) {
  const size_t count = neighbours.size();
  // By coordinate, so that loops over neighbours are of vectors; those that are not there lie at
  // the centre and add nothing.
  using Row = std::array<double, kStencilNodes>;
  Row dx{}, dy{}, dz{}, squares, g, fx, fy, fz;
  for (size_t k = 0; k < count; ++k) {
    dx[k] = neighbours[k][0] - centre[0];
    dy[k] = neighbours[k][1] - centre[1];
    dz[k] = neighbours[k][2] - centre[2];
  }
  for (size_t k = 0; k < kStencilNodes; ++k) {
    squares[k] = dx[k] * dx[k] + dy[k] * dy[k] + dz[k] * dz[k];
  }
  double h = 0;
  for (size_t k = 0; k < count; ++k) h = std::max(h, squares[k]);
  for (size_t k = 0; k < kStencilNodes; ++k) {
    const double u = squares[k] / h;
    g[k] = 1.0 / (u * u + 0.02);
    const double f = g[k] / h;
    fx[k] = f * dx[k];
    fy[k] = f * dy[k];
    fz[k] = f * dz[k];
  }
  double xx = 1e-4, yy = 1e-4, zz = 1e-4, xy = 0, xz = 0, yz = 0;
  double bx = 0, by = 0, bz = 0;
  for (size_t k = 0; k < count; ++k) {
    xx = xx + fx[k] * dx[k];
    xy = xy + fx[k] * dy[k];
    xz = xz + fx[k] * dz[k];
    yy = yy + fy[k] * dy[k];
    yz = yz + fy[k] * dz[k];
    zz = zz + fz[k] * dz[k];
    bx = bx + fx[k];
    by = by + fy[k];
    bz = bz + fz[k];
  }
  // M v = b by elimination.
  const double lxy = xy / xx;
  const double lxz = xz / xx;
  const double myy = yy - lxy * xy;
  const double myz = yz - lxy * xz;
  const double lyz = myz / myy;
  const double mzz = (zz - lxz * xz) - lyz * myz;
  const double cy = by - lxy * bx;
  const double cz = (bz - lxz * bx) - lyz * cy;
  const double vz = cz / mzz;
  const double vy = cy / myy - lyz * vz;
  const double vx = (bx / xx - lxy * vy) - lxz * vz;

  Row w, shares;
  for (size_t k = 0; k < kStencilNodes; ++k) {
    w[k] = g[k] * (1.0 - (dx[k] * vx + dy[k] * vy + dz[k] * vz));
  }
  double sum = 0;
  for (size_t k = 0; k < count; ++k) sum = sum + w[k];
  for (size_t k = 0; k < kStencilNodes; ++k) shares[k] = std::floor(w[k] / sum * 32768.0 + 0.5);
  std::array<int32_t, kStencilNodes> weights{};
  int32_t left = kStencilOne;
  for (size_t k = 0; k < count; ++k) {
    // Neighbours at the centre itself, or too near for the arithmetic, share alike. So a blend's
    // sum stays below 2^52.
    if (!(std::abs(shares[k]) <= 0x1p18)) {
      weights.fill(0);
      left = kStencilOne;
      for (size_t other = 0; other < count; ++other) {
        weights[other] = kStencilOne / static_cast<int32_t>(count);
        left -= weights[other];
      }
      break;
    }
    weights[k] = static_cast<int32_t>(shares[k]);
    left -= weights[k];
  }
  weights[0] += left;
  return weights;
}

}  // namespace cleave
