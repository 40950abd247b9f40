#include "core/stream/stencil_weights.h"

#include <cstddef>

namespace cleave {

// Minimises the sum of w^2 (u^2 + 0.02) plus 10^4 |sum of w d|^2 / h for weights that add up to
// one, d being the offsets of the neighbours, h the largest |d|^2 and u = |d|^2 / h. Every
// operation is rounded by itself and in the order written, because decoders must get the same bits;
// neighbours that are not there add zeros.
std::array<Int32x4, kStencilNodes> StencilWeights(const StencilBatch& batch) {
  using Row = std::array<Double4, kStencilNodes>;
  const auto is_there = [&](size_t k) {
    return __builtin_convertvector(batch.counts > static_cast<int32_t>(k), Int64x4);
  };
  Row squares;
  Double4 h{};
  for (size_t k = 0; k < kStencilNodes; ++k) {
    const auto& [dx, dy, dz] = batch.offsets[k];
    squares[k] = dx * dx + dy * dy + dz * dz;
    h = Max(squares[k], h);
  }
  Row g;
  Double4 xx = Splat(1e-4), yy = xx, zz = xx, xy{}, xz{}, yz{};
  Double4 bx{}, by{}, bz{};
  for (size_t k = 0; k < kStencilNodes; ++k) {
    const auto& [dx, dy, dz] = batch.offsets[k];
    const Double4 u = squares[k] / h;
    g[k] = 1.0 / (u * u + 0.02);
    const Double4 f = is_there(k) ? g[k] / h : Double4{};
    const Double4 fx = f * dx;
    const Double4 fy = f * dy;
    const Double4 fz = f * dz;
    xx = xx + fx * dx;
    xy = xy + fx * dy;
    xz = xz + fx * dz;
    yy = yy + fy * dy;
    yz = yz + fy * dz;
    zz = zz + fz * dz;
    bx = bx + fx;
    by = by + fy;
    bz = bz + fz;
  }
  // M v = b by elimination.
  const Double4 lxy = xy / xx;
  const Double4 lxz = xz / xx;
  const Double4 myy = yy - lxy * xy;
  const Double4 myz = yz - lxy * xz;
  const Double4 lyz = myz / myy;
  const Double4 mzz = (zz - lxz * xz) - lyz * myz;
  const Double4 cy = by - lxy * bx;
  const Double4 cz = (bz - lxz * bx) - lyz * cy;
  const Double4 vz = cz / mzz;
  const Double4 vy = cy / myy - lyz * vz;
  const Double4 vx = (bx / xx - lxy * vy) - lxz * vz;

  Row w;
  Double4 sum{};
  for (size_t k = 0; k < kStencilNodes; ++k) {
    const auto& [dx, dy, dz] = batch.offsets[k];
    w[k] = is_there(k) ? g[k] * (1.0 - (dx * vx + dy * vy + dz * vz)) : Double4{};
    sum = sum + w[k];
  }
  std::array<Int32x4, kStencilNodes> weights;
  Int32x4 left = Int32x4{} + kStencilOne;
  Int64x4 all_fit = ~Int64x4{};
  for (size_t k = 0; k < kStencilNodes; ++k) {
    const Double4 share = Floor(w[k] / sum * 32768.0 + 0.5);
    // Neighbours at the centre itself, or too near for the arithmetic, share alike. So a blend's
    // sum stays below 2^52.
    const Int64x4 fits = Abs(share) <= 0x1p18;
    all_fit &= fits | ~is_there(k);
    weights[k] = ToInts(fits ? share : Double4{});
    left -= weights[k];
  }
  if (Any(~all_fit)) {
    for (int lane = 0; lane < 4; ++lane) {
      if (all_fit[lane] != 0 || batch.counts[lane] == 0) continue;
      left[lane] = kStencilOne % batch.counts[lane];
      for (int k = 0; k < batch.counts[lane]; ++k) {
        weights[static_cast<size_t>(k)][lane] = kStencilOne / batch.counts[lane];
      }
    }
  }
  weights[0] += left;
  return weights;
}

}  // namespace cleave
