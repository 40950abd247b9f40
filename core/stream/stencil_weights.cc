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
  std::array<Vec3, kStencilNodes> offsets{};
  std::array<double, kStencilNodes> squares{};
  double h = 0;
  for (size_t k = 0; k < count; ++k) {
    for (size_t axis = 0; axis < 3; ++axis) offsets[k][axis] = neighbours[k][axis] - centre[axis];
    const Vec3& d = offsets[k];
    squares[k] = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    h = std::max(h, squares[k]);
  }
  std::array<double, kStencilNodes> g{};
  double xx = 1e-4, yy = 1e-4, zz = 1e-4, xy = 0, xz = 0, yz = 0;
  double bx = 0, by = 0, bz = 0;
  for (size_t k = 0; k < count; ++k) {
    const double u = squares[k] / h;
    g[k] = 1.0 / (u * u + 0.02);
    const Vec3& d = offsets[k];
    const double f = g[k] / h;
    const double fx = f * d[0];
    const double fy = f * d[1];
    const double fz = f * d[2];
    xx = xx + fx * d[0];
    xy = xy + fx * d[1];
    xz = xz + fx * d[2];
    yy = yy + fy * d[1];
    yz = yz + fy * d[2];
    zz = zz + fz * d[2];
    bx = bx + fx;
    by = by + fy;
    bz = bz + fz;
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

  std::array<double, kStencilNodes> w{};
  double sum = 0;
  for (size_t k = 0; k < count; ++k) {
    const Vec3& d = offsets[k];
    w[k] = g[k] * (1.0 - (d[0] * vx + d[1] * vy + d[2] * vz));
    sum = sum + w[k];
  }
  std::array<int32_t, kStencilNodes> weights{};
  int32_t left = kStencilOne;
  for (size_t k = 0; k < count; ++k) {
    const double share = std::floor(w[k] / sum * 32768.0 + 0.5);
    // Neighbours at the centre itself, or too near for the arithmetic, share alike.
    if (!(std::abs(share) <= 0x1p25)) {
      weights.fill(0);
      left = kStencilOne;
      for (size_t other = 0; other < count; ++other) {
        weights[other] = kStencilOne / static_cast<int32_t>(count);
        left -= weights[other];
      }
      break;
    }
    weights[k] = static_cast<int32_t>(share);
    left -= weights[k];
  }
  weights[0] += left;
  return weights;
}

}  // namespace cleave
